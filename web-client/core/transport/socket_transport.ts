// One WebSocket to /v1/stream that reconnects by itself. It counts streams and credit, and does not
// look into the blocks.

import {errorCode, errorText, QtetError} from '../protocol/errors';
import type {LogTable} from '../protocol/log_table';
import {
  creditMessage,
  kSubprotocol,
  openMessage,
  parseFrame,
  parseServerMessage,
  pauseMessage,
  resumeMessage,
  stopMessage,
  targetMessage,
  viewMessage,
  type OpenRequest,
  type Target,
} from '../protocol/messages';
import {kNoViewRequest, wireView, type ViewRequest} from '../protocol/view_request';
import {reconnectDelayMs} from './backoff';
import type {Transport, TransportHandlers} from './transport';

/**
 * Credit is returned in portions of this share of the window. Messages are few, and the server
 * never waits for one.
 */
const kCreditShare = 8;
/**
 * The server closes with this code after a message that it does not understand. Trying again would
 * not help.
 */
const kPolicyViolation = 1008;

/** The part of WebSocket that is used here. Tests bring their own. */
export interface Socket {
  binaryType: string;
  onopen: ((event: never) => void) | null;
  onmessage: ((event: {data: unknown}) => void) | null;
  onclose: ((event: {code: number; reason: string}) => void) | null;
  send(data: string): void;
  close(code?: number): void;
}

export type SocketFactory = (url: string, subprotocol: string) => Socket;

export class SocketTransport implements Transport {
  private socket: Socket | null = null;
  private connected = false;
  private stream = 0;
  private attempt = 0;
  /** Counts disconnections, so that an address that comes too late is not used. */
  private turn = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private window = 0;
  private owed = 0;
  /** Empty if the server has not said. It then knows no views, targets and pauses. */
  private layout = '';
  private isPaused = false;
  private view: ViewRequest = kNoViewRequest;
  /** The last view that the server was sent. */
  private sentView = '';

  /**
   * A function as `url` is called before every connection: its address is good for one connection.
   */
  constructor(
    private readonly url: string | (() => Promise<string>),
    private readonly handlers: TransportHandlers,
    private readonly makeSocket: SocketFactory = (address, protocol) =>
      new WebSocket(address, protocol) as unknown as Socket,
    private readonly random: () => number = Math.random,
    private readonly table: Pick<LogTable, 'lattice'> | null = null,
  ) {}

  get isConnected(): boolean {
    return this.connected;
  }

  connect(): void {
    this.disconnect();
    if (typeof this.url === 'string') {
      this.connectTo(this.url);
      return;
    }
    const {turn} = this;
    this.url().then(
      (url) => {
        if (turn === this.turn) this.connectTo(url);
      },
      (thrown: unknown) => {
        if (turn !== this.turn) return;
        if (errorCode(thrown) === 'network') this.lost(0, '');
        else this.fail(thrown);
      },
    );
  }

  private connectTo(url: string): void {
    const socket = this.makeSocket(url, kSubprotocol);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => {
      this.connected = true;
      this.stream = 0;
      this.handlers.connected();
    };
    socket.onmessage = (event) => this.receive(event.data);
    socket.onclose = (event) => this.lost(event.code, event.reason);
  }

  /** Starts a stream. Late frames of the previous one are dropped. */
  open(request: OpenRequest): void {
    if (!this.connected) return;
    ++this.stream;
    this.window = request.credit;
    this.owed = 0;
    this.layout = '';
    this.isPaused = false;
    this.view = request.view ?? this.view;
    const wire = this.wire();
    this.sentView = viewMessage(wire);
    this.socket?.send(openMessage(request, wire));
  }

  look(view: ViewRequest): void {
    this.view = view;
    const text = viewMessage(this.wire());
    if (!this.connected || this.layout !== 'regions' || text === this.sentView) return;
    this.sentView = text;
    this.socket?.send(text);
  }

  stop(): void {
    if (this.connected) this.socket?.send(stopMessage());
  }

  pause(): void {
    if (!this.connected || this.layout === '') return this.stop();
    this.isPaused = true;
    this.socket?.send(pauseMessage());
  }

  resume(): boolean {
    if (!this.connected || !this.isPaused) return false;
    this.isPaused = false;
    this.socket?.send(resumeMessage());
    return true;
  }

  aim(target: Target | null): void {
    if (this.connected && this.layout !== '') this.socket?.send(targetMessage(target));
  }

  /**
   * Returns the credit of `bytes` applied payload bytes. It is sent once a portion has come
   * together.
   */
  applied(bytes: number): void {
    this.owed += bytes;
    if (this.owed * kCreditShare >= this.window) this.grant();
  }

  /** Disconnects; `connect` may be called again. */
  disconnect(): void {
    clearTimeout(this.timer);
    ++this.turn;
    const socket = this.socket;
    this.socket = null;
    this.connected = this.isPaused = false;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close(1000);
  }

  private wire(): Record<string, unknown> | null {
    const lattice = this.table?.lattice;
    return lattice ? wireView(this.view, lattice) : null;
  }

  private grant(): void {
    if (!this.connected || this.owed <= 0) return;
    this.socket?.send(creditMessage(this.owed));
    this.owed = 0;
  }

  private receive(data: unknown): void {
    try {
      if (typeof data === 'string') {
        const message = parseServerMessage(data);
        if (message?.type === 'opened') {
          this.layout = message.layout ?? '';
          this.look(this.view); // it may have changed since the `open`
        }
        // Replies to an earlier `open` do not concern the current one.
        if (message && (message.type === 'error' || message.stream === this.stream))
          this.handlers.message(message);
        return;
      }
      const frame = parseFrame(data as ArrayBuffer);
      if (frame.stream !== this.stream) return;
      this.attempt = 0; // only bytes prove that the connection works
      this.handlers.frame(frame);
    } catch (thrown) {
      this.fail(thrown);
    }
  }

  private fail(thrown: unknown): void {
    this.disconnect();
    this.handlers.failed(
      thrown instanceof QtetError ? thrown : new QtetError('internal', errorText(thrown)),
    );
  }

  private lost(code: number, reason: string): void {
    this.disconnect();
    if (code === kPolicyViolation) {
      this.handlers.failed(
        new QtetError(
          'bad-message',
          `The server ended the stream: ${reason || 'a message was not understood'}.`,
        ),
      );
      return;
    }
    const delayMs = reconnectDelayMs(this.attempt, this.random());
    ++this.attempt;
    this.timer = setTimeout(() => this.connect(), delayMs);
    this.handlers.down(this.attempt, delayMs);
  }
}
