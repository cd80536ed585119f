// A WebSocket that connects again by itself.

import {errorCode, errorText, QtetError} from '../protocol/errors';
import {reconnectDelayMs} from './backoff';
import type {TransportHandlers} from './transport';

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

/** `received` may throw: the connection ends then, and `failed` is called. */
export interface SocketHandlers extends Pick<TransportHandlers, 'connected' | 'down' | 'failed'> {
  received(data: unknown): void;
}

export class ReconnectingSocket {
  private socket: Socket | null = null;
  private connected = false;
  /** The attempts since the connection last worked. */
  private attempt = 0;
  /** Counts disconnections, so that an address that comes too late is not used. */
  private turn = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /**
   * A function as `url` is called before every connection: its address is good for one connection.
   */
  constructor(
    private readonly url: string | (() => Promise<string>),
    private readonly subprotocol: string,
    private readonly handlers: SocketHandlers,
    private readonly makeSocket: SocketFactory = (address, protocol) =>
      new WebSocket(address, protocol) as unknown as Socket,
    private readonly random: () => number = Math.random,
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

  /** Does nothing without a connection. */
  send(text: string): void {
    if (this.connected) this.socket?.send(text);
  }

  /** The connection has proved to work: the next loss is a first one. */
  works(): void {
    this.attempt = 0;
  }

  /** Disconnects; `connect` may be called again. */
  disconnect(): void {
    clearTimeout(this.timer);
    ++this.turn;
    const {socket} = this;
    this.socket = null;
    this.connected = false;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close(1000);
  }

  private connectTo(url: string): void {
    const socket = this.makeSocket(url, this.subprotocol);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => {
      this.connected = true;
      this.handlers.connected();
    };
    socket.onmessage = (event) => {
      try {
        this.handlers.received(event.data);
      } catch (thrown) {
        this.fail(thrown);
      }
    };
    socket.onclose = (event) => this.lost(event.code, event.reason);
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
