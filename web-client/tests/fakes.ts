// Fakes of the network and the codec. They are small, and strict about order, so that a wrong call
// fails a test.

import {kFirstFieldPart, kHeadPart} from '../core/protocol/parts';
import type {Codec} from '../core/decode/codec';
import type {ValueDecoder} from '../core/decode/draco';
import {QtetError} from '../core/protocol/errors';
import {kFrameHeaderBytes} from '../core/protocol/messages';
import type {Socket} from '../core/transport/reconnecting_socket';
import type {Transport} from '../core/transport/transport';
import type {FromWorker} from '../core/session/worker_messages';

const kRealSetTimeout = globalThis.setTimeout;
/**
 * Waits until it holds, also under fake timers, for as long as a test may take: so no machine is
 * too slow.
 */
export async function until(holds: () => boolean): Promise<void> {
  while (!holds()) await new Promise<void>((resolve) => void kRealSetTimeout(resolve));
}

/** The states that a session has reported. */
export const statesOf = (received: FromWorker[]): string[] =>
  received.flatMap((message) => (message.type === 'state' ? [message.state] : []));
export const errorsOf = (received: FromWorker[]): string[] =>
  received.flatMap((message) => (message.type === 'error' ? [message.code] : []));

export class FakeSocket implements Socket {
  binaryType = '';
  onopen: ((event: never) => void) | null = null;
  onmessage: ((event: {data: unknown}) => void) | null = null;
  onclose: ((event: {code: number; reason: string}) => void) | null = null;
  sent: Record<string, unknown>[] = [];
  closed = false;

  send(data: string): void {
    this.sent.push(JSON.parse(data) as Record<string, unknown>);
  }
  close(): void {
    this.closed = true;
  }

  accept(): void {
    this.onopen?.(undefined as never);
  }
  deliver(data: unknown): void {
    this.onmessage?.({data});
  }
  lose(code: number): void {
    this.onclose?.({code, reason: ''});
  }
  sentOf(type: string): Record<string, unknown>[] {
    return this.sent.filter((message) => message.type === type);
  }
}

/** A transport that is always connected. `what` replaces its methods. */
export function carrier(what: Partial<Transport>): Transport {
  return {
    isConnected: true,
    connect: () => undefined,
    open: () => undefined,
    stop: () => undefined,
    pause: () => undefined,
    resume: () => true,
    aim: () => undefined,
    applied: () => undefined,
    disconnect: () => undefined,
    ...what,
  };
}

export function frame(options: {
  stream: number;
  chunk?: number;
  firstPart?: number;
  parts?: number;
  payload?: Uint8Array;
}): ArrayBuffer {
  const payload = options.payload ?? new Uint8Array(0);
  const bytes = new Uint8Array(kFrameHeaderBytes + payload.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, options.stream, true);
  view.setUint32(4, options.chunk ?? 0, true);
  view.setUint16(8, options.firstPart ?? 0, true);
  view.setUint16(10, options.parts ?? (options.firstPart === kHeadPart ? 0 : 1), true);
  view.setUint32(12, payload.length, true);
  bytes.set(payload, kFrameHeaderBytes);
  return bytes.buffer;
}

export interface FakeLog {
  fields: string[];
  /** They come after the point fields. */
  cellFields?: string[];
  chunks: number;
  /** The bytes of every block; without it, kFakeBlockBytes. Few chunks need little time. */
  blockBytes?: number;
}

/** Every block of a fake log has so many bytes, unless the log says otherwise. */
export const kFakeBlockBytes = 10;

const doubles = (...values: number[]): Uint8Array =>
  new Uint8Array(new Float64Array(values).buffer);
const text = (value: string): number[] => {
  const bytes = new TextEncoder().encode(value);
  return [bytes.length, ...bytes];
};

export function fakeHead({fields, cellFields = []}: FakeLog): Uint8Array {
  const names = [...fields, ...cellFields];
  const kFloat32 = 0,
    kBits = 8;
  const manifest = [
    ...text('fake'),
    ...text('fake.vtu'),
    ...doubles(1, 0, 0, 0),
    ...names.flatMap((name) => [...text(name), kFloat32, kBits, ...doubles(1, 0, 0, 255)]),
    0, // no known errors
  ];
  const kNoLaterFields = 0;
  const table = [kNoLaterFields, ...names.flatMap((_, f) => [1, f < fields.length ? 0 : 1])];
  const head = new Uint8Array(64 + manifest.length + table.length);
  const view = new DataView(head.buffer);
  head.set([0x89, 0x51, 0x54, 0x45, 0x54, 0x0d, 0x0a, 0x1a]);
  head[13] = 16;
  view.setUint32(24, manifest.length, true);
  view.setUint32(28, table.length, true);
  view.setUint32(44, names.length, true);
  head.set(manifest, 64);
  head.set(table, 64 + manifest.length);
  return head;
}

export function headFrame(stream: number, log: FakeLog): ArrayBuffer {
  return frame({stream, firstPart: kHeadPart, payload: fakeHead(log)});
}

export function meshFrame(stream: number, chunk: number): ArrayBuffer {
  return frame({
    stream,
    chunk,
    firstPart: 0,
    parts: 2,
    payload: new Uint8Array(2 * kFakeBlockBytes),
  });
}

export function fieldFrame(stream: number, chunk: number, field: number): ArrayBuffer {
  return frame({
    stream,
    chunk,
    firstPart: kFirstFieldPart + field,
    parts: 1,
    payload: new Uint8Array(kFakeBlockBytes),
  });
}

/** Counts what is applied, in order. Chunk n makes a mesh of n + 1 tetrahedra. */
export class FakeCodec implements Codec {
  isWhole = true;
  across = (): number => 0xffffffff;
  chunksApplied = 0;
  corrupt = -1;
  corruptField = Infinity;
  private fieldChunks: number[] = [];
  private readonly headBytes: number;
  private readonly blockBytes: number;

  constructor(private readonly log: FakeLog) {
    this.headBytes = fakeHead(log).length;
    this.blockBytes = log.blockBytes ?? kFakeBlockBytes;
  }

  /** How many chunks fit into memory. */
  room = Infinity;
  /** How many blocks of fields do. */
  fieldRoom = Infinity;
  restarts = 0;
  restart(): void {
    ++this.restarts;
    this.chunksApplied = 0;
  }
  open(): void {
    this.chunksApplied = 0;
    this.fieldChunks = this.log.fields.map(() => 0);
  }
  readonly laterBytes = 0;
  readLater(): void {
    throw new Error('a fake log has no later instants');
  }
  get chunkCount(): number {
    return this.log.chunks;
  }
  levelColumns(): Uint32Array {
    const levels = Array.from({length: this.log.chunks}, (_, level) => level);
    return Uint32Array.from([
      ...levels.map((level) => level + 1),
      ...levels.map((level) => level + 4),
      ...levels.map(() => 4),
    ]);
  }
  blockOffset(chunk: number, part: number): number {
    const parts = 2 + this.log.fields.length + (this.log.cellFields?.length ?? 0);
    return this.headBytes + this.blockBytes * (chunk * parts + part);
  }
  blockSize(): number {
    return this.blockBytes;
  }
  blockValues(): number {
    return 1;
  }
  blockCodec(): number {
    return 2;
  }
  checkBlock(chunk: number, part: number): void {
    if (chunk === this.corrupt || part === kFirstFieldPart + this.corruptField)
      throw new QtetError('bad-checksum', `chunk ${chunk} is damaged`);
  }
  apply(chunk: number): void {
    if (chunk >= this.room) throw new QtetError('out-of-memory', 'no room');
    if (chunk !== this.chunksApplied)
      throw new QtetError('bad-order', `chunk ${chunk} after ${this.chunksApplied} chunks`);
    ++this.chunksApplied;
  }
  applyField(field: number, chunk: number): void {
    if (this.fieldChunks.reduce((sum, chunks) => sum + chunks, 0) >= this.fieldRoom)
      throw new QtetError('out-of-memory', 'no room');
    if (chunk !== this.fieldChunks[field] || chunk >= this.chunksApplied)
      throw new QtetError('bad-order', `field chunk ${chunk}`);
    ++this.fieldChunks[field];
  }
  fieldChunksApplied(field: number): number {
    return this.fieldChunks[field]!;
  }
  /** By field; none of those that are not there. */
  parentsOf: number[][] = [];
  parents(field: number): number[] {
    return this.parentsOf[field] ?? [];
  }
  brings(): {tetrahedra: number; vertices: number; boundaryTriangles: number} {
    return {tetrahedra: 1, vertices: 0, boundaryTriangles: 0};
  }
  get level(): number {
    return Math.max(0, this.chunksApplied - 1);
  }
  get vertexCount(): number {
    return 0;
  }
  get tetrahedronCount(): number {
    return this.chunksApplied;
  }
  get boundaryCount(): number {
    return 0;
  }
  points(): Int32Array {
    return new Int32Array(0);
  }
  tetrahedra(): Uint32Array {
    return new Uint32Array(0);
  }
  boundary(): Uint32Array {
    return new Uint32Array(0);
  }
  field(field: number): Int32Array | null {
    return this.fieldChunks[field]! > 0 ? new Int32Array(0) : null;
  }
  digest(): string {
    return 'fake';
  }
}

export const kFakeValues: ValueDecoder = {decode: () => new Int32Array(0)};
