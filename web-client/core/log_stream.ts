// The connection of a session, with the stream that was opened on it last.

import type {Transport} from './transport';
import type {ViewRequest} from './view_request';
import type {Wanted} from './wanted';

/**
 * Payload bytes under way: enough for 80 Mbit/s at 100 ms, and some ten chunks of decoding that a
 * click has to wait for at most.
 */
const kWindowBytes = 1 << 20;

/** Where the stream ends: behind the head, where the limit was, or where the limit is since. */
type End = 'head' | 'limit' | 'later limit';

export class LogStream {
  /** Of the log; empty before the server has told. */
  digest = '';
  /** Payload bytes that came of the log. */
  receivedBytes = 0;
  private transport: Transport | null = null;
  /** Keys of the fields that it brings. */
  private keys: readonly string[] = [];
  private end: End = 'limit';
  /** Bytes that arrived and whose credit waits until they are applied. */
  private unapplied = 0;

  /** REQUIRES: the transport of before, if any, is disconnected. */
  use(transport: Transport): void {
    this.transport = transport;
  }

  /** Another log comes. */
  forget(): void {
    this.digest = '';
    this.keys = [];
    this.receivedBytes = this.unapplied = 0;
  }

  get isConnected(): boolean {
    return this.transport?.isConnected === true;
  }

  /** The server may be done with a limit before it hears of the later one. */
  get mayEndEarly(): boolean {
    return this.end === 'later limit';
  }

  get endsAtHead(): boolean {
    return this.end === 'head';
  }

  brings(keys: readonly string[]): boolean {
    return keys.every((key) => this.keys.includes(key));
  }

  connect(): void {
    this.transport?.connect();
  }

  disconnect(): void {
    this.transport?.disconnect();
  }

  open(mesh: string, {needsHead, keys, have, view, goal}: Wanted): void {
    const fields = keys.filter((name) => name !== '');
    this.keys = fields;
    this.end = needsHead ? 'head' : 'limit';
    this.unapplied = 0;
    this.transport?.open({
      mesh,
      fields,
      credit: needsHead ? 1 : kWindowBytes, // one byte buys the head and nothing behind it
      have,
      view,
      goal,
      ...(this.digest ? {digest: this.digest} : {}),
    });
  }

  /** Has the stream end where the limit is now. */
  aim({goal}: Wanted): void {
    if (!this.endsAtHead) this.end = 'later limit';
    this.transport?.aim(goal);
  }

  look(view: ViewRequest): void {
    this.transport?.look(view);
  }

  /** False: there is nothing to pause. */
  pause(): boolean {
    this.transport?.pause();
    return this.transport !== null;
  }

  /** False: it cannot go on where it paused; `open` does. */
  resume(): boolean {
    return this.transport?.resume() === true;
  }

  received(bytes: number): void {
    this.receivedBytes += bytes;
    this.unapplied += bytes;
  }

  /** Everything that came is applied: as much may follow. */
  giveCredit(): void {
    const {unapplied} = this;
    this.unapplied = 0;
    if (unapplied > 0) this.transport?.applied(unapplied);
  }
}
