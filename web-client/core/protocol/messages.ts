// The messages and the binary frame of proto/STREAM.md. Every count that is read is checked.

import {QtetError} from './errors';

export const kSubprotocol = 'qtet.v1';
export const kFrameHeaderBytes = 16;
/** Where a stream may stop. */
export interface Target {
  /** How many leading chunks. */
  chunks: number;
  /** The first level that contains all of them: the target of qtet.v1. */
  level: number;
}

export interface OpenRequest {
  mesh: string;
  fields: string[];
  /** How many leading chunks are here: of the mesh, and of each field. */
  have: {chunks: number; fields: Record<string, number>};
  credit: number;
  digest?: string;
  /** Where the stream may stop; null means at its end. */
  target?: Target | null;
}

export type ServerMessage =
  | {
      type: 'opened';
      stream: number;
      mesh: string;
      digest: string;
      bytes: number;
      planned: number;
    }
  | {type: 'done'; stream: number}
  | {type: 'stopped'; stream: number}
  | {type: 'error'; code: string; detail: string};

export interface Frame {
  stream: number;
  chunk: number;
  firstPart: number;
  /** 0: some bytes of the block `firstPart`, but not its last; or the head. */
  parts: number;
  payload: Uint8Array;
}

export function openMessage({mesh, fields, credit, have, digest, target}: OpenRequest): string {
  return JSON.stringify({
    type: 'open',
    mesh,
    fields,
    credit,
    have,
    digest,
    ...(target ? {target: wireTarget(target)} : {}),
  });
}

export function targetMessage(target: Target | null): string {
  return JSON.stringify({type: 'target', target: target && wireTarget(target)});
}

function wireTarget({level}: Target): {level: number} {
  return {level};
}

export function pauseMessage(): string {
  return JSON.stringify({type: 'pause'});
}

/**
 * Continues the paused stream. It need not say what is here: everything sent is here or under way.
 */
export function resumeMessage(): string {
  return JSON.stringify({type: 'resume'});
}

export function creditMessage(bytes: number): string {
  return JSON.stringify({type: 'credit', bytes});
}

export function stopMessage(): string {
  return JSON.stringify({type: 'stop'});
}

/** Reads a binary message. Throws `bad-message` if it is not exactly one frame. */
export function parseFrame(buffer: ArrayBuffer): Frame {
  if (buffer.byteLength < kFrameHeaderBytes) {
    throw badMessage(
      `a binary message of ${buffer.byteLength} bytes is shorter than its ` +
        `${kFrameHeaderBytes}-byte header`,
    );
  }
  const view = new DataView(buffer);
  const size = view.getUint32(12, true);
  if (size !== buffer.byteLength - kFrameHeaderBytes) {
    throw badMessage(
      `a frame says ${size} payload bytes and holds ${buffer.byteLength - kFrameHeaderBytes}`,
    );
  }
  return {
    stream: view.getUint32(0, true),
    chunk: view.getUint32(4, true),
    firstPart: view.getUint16(8, true),
    parts: view.getUint16(10, true),
    payload: new Uint8Array(buffer, kFrameHeaderBytes, size),
  };
}

/** Reads a text message. Unknown types give null, so that later servers may add some. */
export function parseServerMessage(text: string): ServerMessage | null {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch {
    throw badMessage('a text message is not JSON');
  }
  if (typeof json !== 'object' || json === null)
    throw badMessage('a text message is not a JSON object');
  const message = json as Record<string, unknown>;
  switch (message.type) {
    case 'opened':
      return {
        type: 'opened',
        stream: numberOf(message, 'stream'),
        mesh: textOf(message, 'mesh'),
        digest: textOf(message, 'digest'),
        bytes: numberOf(message, 'bytes'),
        planned: numberOf(message, 'planned'),
      };
    case 'done':
    case 'stopped':
      return {type: message.type, stream: numberOf(message, 'stream')};
    case 'error':
      return {type: 'error', code: textOf(message, 'code'), detail: textOf(message, 'detail')};
    default:
      return null;
  }
}

function numberOf(message: Record<string, unknown>, key: string): number {
  const value = message[key];
  if (typeof value !== 'number' || !Number.isSafeInteger(value) || value < 0)
    throw badMessage(`"${key}" is not a count`);
  return value;
}

function textOf(message: Record<string, unknown>, key: string): string {
  const value = message[key];
  if (typeof value !== 'string') throw badMessage(`"${key}" is not a text`);
  return value;
}

function badMessage(what: string): QtetError {
  return new QtetError('bad-message', `The server sent something that is not qtet.v1: ${what}.`);
}
