// The first transport that works: a WebSocket, else byte ranges, else numbered chunks. When one
// fails for good, the next takes over. Any of them can continue where another stopped.

import type {QtetError} from '../protocol/errors';
import type {Frame, OpenRequest, ServerMessage, Target} from '../protocol/messages';
import type {Transport, TransportHandlers} from './transport';

export type TransportKind = 'websocket' | 'range' | 'chunks';
export const kTransportKinds: readonly TransportKind[] = ['websocket', 'range', 'chunks'];

/** After so many failures in a row, without a byte between them, the next transport is tried. */
const kPatience = 2;

export class AutoTransport implements Transport, TransportHandlers {
  private current: Transport;
  private at = 0;
  private failures = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** REQUIRES: at least one kind. `make` creates a transport of a kind with these handlers. */
  constructor(
    private readonly kinds: readonly TransportKind[],
    private readonly make: (kind: TransportKind, handlers: TransportHandlers) => Transport,
    private readonly handlers: TransportHandlers,
  ) {
    this.current = make(kinds[0]!, this);
  }

  get kind(): TransportKind {
    return this.kinds[this.at]!;
  }
  get isConnected(): boolean {
    return this.current.isConnected;
  }
  connect(): void {
    clearTimeout(this.timer);
    this.current.connect();
  }
  open(request: OpenRequest): void {
    this.current.open(request);
  }
  stop(): void {
    this.current.stop();
  }
  pause(): void {
    this.current.pause();
  }
  resume(): boolean {
    return this.current.resume();
  }
  aim(target: Target | null): void {
    this.current.aim(target);
  }
  applied(bytes: number): void {
    this.current.applied(bytes);
  }
  disconnect(): void {
    clearTimeout(this.timer);
    this.current.disconnect();
  }

  // ---- TransportHandlers

  connected(): void {
    this.handlers.connected();
  }
  message(message: ServerMessage): void {
    this.handlers.message(message);
  }
  frame(frame: Frame): void {
    this.failures = 0;
    this.handlers.frame(frame);
  }
  down(attempt: number, delayMs: number): void {
    if (++this.failures >= kPatience && this.kinds.length > 1) this.change(delayMs);
    this.handlers.down(attempt, delayMs);
  }
  failed(error: QtetError): void {
    // Another transport may succeed. If all have failed without a byte between them, the last error
    // is reported.
    if (error.code === 'http' && ++this.failures < kPatience + this.kinds.length) {
      this.change(0);
      return;
    }
    this.handlers.failed(error);
  }

  private change(delayMs: number): void {
    this.current.disconnect();
    this.at = (this.at + 1) % this.kinds.length;
    // the new transport gets one try before the next one
    this.failures = Math.max(0, this.failures - 1);
    this.current = this.make(this.kind, this);
    this.timer = setTimeout(() => this.current.connect(), delayMs);
  }
}
