// A session's connection, and the stream that was opened on it last.

import type {Target} from '../protocol/messages';
import type {Transport} from '../transport/transport';
import type {RequestedPart} from './requested_part';
import {kNoSource, type Source} from './worker_messages';

/**
 * How many payload bytes may be under way. It is enough for 80 Mbit/s at 100 ms; a click waits for
 * the decoding of some ten chunks at most.
 */
const kWindowBytes = 1 << 20;

/** Where the stream ends: behind the head, at the limit, or at a limit that was set since. */
type End = 'head' | 'limit' | 'later limit';

export class LogStream {
  /** Where the log is, and how it was asked for. */
  source = kNoSource;
  /** SHA-256 of the log; empty until the server states it. */
  digest = '';
  /** Payload bytes received of this log. */
  receivedBytes = 0;
  private transport: Transport | null = null;
  /** Keys of the fields that the stream brings. */
  private keys: readonly string[] = [];
  private end: End = 'limit';
  private target: Target | null = null;
  private isPaused = false;
  /** A connection is there, or its transport tries to make one. */
  isConnecting = false;
  /** Bytes received whose credit has not been returned: they are not applied yet. */
  private unapplied = 0;

  constructor(private readonly newTransport: (source: Source) => Transport) {}

  /** REQUIRES: the stream is disconnected. */
  use(source: Source): void {
    this.source = source;
    this.transport = this.newTransport(source);
  }

  /** Must be called before another log. */
  forget(): void {
    this.digest = '';
    this.keys = [];
    this.receivedBytes = this.unapplied = 0;
  }

  get isConnected(): boolean {
    return this.transport?.isConnected === true;
  }

  /** The server may report an end before it receives the request for more. */
  get mayEndEarly(): boolean {
    return this.end === 'later limit';
  }

  get endsAtHead(): boolean {
    return this.end === 'head';
  }

  brings(keys: readonly string[]): boolean {
    return keys.every((key) => this.keys.includes(key));
  }

  /** Whatever of this field comes is of no use. */
  giveUp(lost: string): void {
    this.keys = this.keys.filter((key) => key !== lost);
  }

  connect(): void {
    this.isConnecting = true;
    this.transport?.connect();
  }

  disconnect(): void {
    this.isConnecting = false;
    this.transport?.disconnect();
  }

  open({needsHead, keys, have, target}: RequestedPart): void {
    const fields = keys.filter((name) => name !== '');
    this.keys = fields;
    this.end = needsHead ? 'head' : 'limit';
    this.target = target;
    this.unapplied = 0;
    this.isPaused = false;
    this.transport?.open({
      mesh: this.source.mesh,
      fields,
      credit: needsHead ? 1 : kWindowBytes, // one byte buys the head and nothing more
      have,
      target,
      ...(this.digest ? {digest: this.digest} : {}),
    });
  }

  /** Moves the end of the stream to the limit of now. */
  aim({target}: RequestedPart): void {
    if (target?.chunks === this.target?.chunks) return;
    this.target = target;
    if (!this.endsAtHead) this.end = 'later limit';
    this.transport?.aim(target);
  }

  /** Returns false if there is nothing to pause. */
  pause(): boolean {
    this.isPaused = true;
    this.transport?.pause();
    return this.transport !== null;
  }

  /** Ends a pause. Returns false if the stream cannot continue; it must be opened again. */
  resume(): boolean {
    const {isPaused} = this;
    this.isPaused = false;
    return !isPaused || this.transport?.resume() === true;
  }

  /** Payload that came beside the stream, which no credit was for. */
  receivedAside(bytes: number): void {
    this.receivedBytes += bytes;
  }

  received(bytes: number): void {
    this.receivedBytes += bytes;
    this.unapplied += bytes;
  }

  /** Returns the credit: everything received is applied. */
  giveCredit(): void {
    const {unapplied} = this;
    this.unapplied = 0;
    if (unapplied > 0) this.transport?.applied(unapplied);
  }
}
