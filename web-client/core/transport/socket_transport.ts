// Streams from one WebSocket to /v1/stream. It counts streams and credit, and does not look into
// the blocks.

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
  type OpenRequest,
  type Target,
} from '../protocol/messages';
import {Pieces} from './pieces';
import {ReconnectingSocket, type SocketFactory} from './reconnecting_socket';
import type {Transport, TransportHandlers} from './transport';

/**
 * Credit is returned in portions of this share of the window. Messages are few, and the server
 * never waits for one.
 */
export const kCreditShare = 8;

/** One stream, from its `open` to the next. */
interface Stream {
  /** Bytes that the server may send without credit. */
  window: number;
  /** Applied bytes whose credit has not been returned. */
  owed: number;
  isPaused: boolean;
  pieces: Pieces;
}

const noStream = (): Stream => ({
  window: 0,
  owed: 0,
  isPaused: false,
  pieces: new Pieces(),
});

export class SocketTransport implements Transport {
  private readonly socket: ReconnectingSocket;
  private stream = noStream();
  /** The number of the stream in this connection; 0: none was opened. */
  private number = 0;

  /** As ReconnectingSocket. */
  constructor(
    url: string | (() => Promise<string>),
    private readonly handlers: TransportHandlers,
    makeSocket?: SocketFactory,
    random?: () => number,
  ) {
    const socketHandlers = {
      connected: () => {
        this.number = 0;
        this.stream = {...this.stream, isPaused: false};
        handlers.connected();
      },
      received: (data: unknown) => this.receive(data),
      down: handlers.down.bind(handlers),
      failed: handlers.failed.bind(handlers),
    };
    this.socket = new ReconnectingSocket(url, kSubprotocol, socketHandlers, makeSocket, random);
  }

  get isConnected(): boolean {
    return this.socket.isConnected;
  }

  connect(): void {
    this.socket.connect();
  }

  /** Starts a stream. Late frames of the previous one are dropped. */
  open(request: OpenRequest): void {
    if (!this.isConnected) return;
    ++this.number;
    this.stream = {...noStream(), window: request.credit};
    this.socket.send(openMessage(request));
  }

  stop(): void {
    this.socket.send(stopMessage());
  }

  pause(): void {
    if (!this.isConnected) return;
    this.stream.isPaused = true;
    this.socket.send(pauseMessage());
  }

  resume(): boolean {
    if (!this.isConnected || !this.stream.isPaused) return false;
    this.stream.isPaused = false;
    this.socket.send(resumeMessage());
    return true;
  }

  aim(target: Target | null): void {
    this.socket.send(targetMessage(target));
  }

  /**
   * Returns the credit of `bytes` applied payload bytes. It is sent once a portion has come
   * together.
   */
  applied(bytes: number): void {
    const {stream} = this;
    stream.owed += bytes;
    if (stream.owed * kCreditShare < stream.window) return;
    if (!this.isConnected || stream.owed <= 0) return;
    this.socket.send(creditMessage(stream.owed));
    stream.owed = 0;
  }

  /** Disconnects; `connect` may be called again. */
  disconnect(): void {
    this.socket.disconnect();
  }

  private receive(data: unknown): void {
    if (typeof data === 'string') {
      const message = parseServerMessage(data);
      // Replies to an earlier `open` do not concern the current one.
      if (message && (message.type === 'error' || message.stream === this.number))
        this.handlers.message(message);
      return;
    }
    const frame = parseFrame(data as ArrayBuffer);
    if (frame.stream !== this.number) return;
    this.socket.works(); // only bytes prove it
    const whole = this.stream.pieces.join(frame);
    // A piece is credited when it arrives: blocks may be larger than the window.
    if (!whole) return this.applied(frame.payload.length);
    this.stream.owed -= whole.payload.length - frame.payload.length;
    this.handlers.frame(whole);
  }
}
