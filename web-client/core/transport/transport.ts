// A transport of blocks as a session needs it: a WebSocket, byte ranges of a file, or numbered
// chunks. All of them use the frames and messages of proto/STREAM.md, and each can continue where
// another stopped.

import type {QtetError} from '../protocol/errors';
import type {Frame, OpenRequest, ServerMessage, Target} from '../protocol/messages';

export interface TransportHandlers {
  /** Connected, or reconnected: the moment to `open`. */
  connected(): void;
  message(message: ServerMessage): void;
  /** A frame of the current stream. */
  frame(frame: Frame): void;
  /** The connection is lost or was never made. The next attempt comes after `delayMs`. */
  down(attempt: number, delayMs: number): void;
  /** The transport has given up. */
  failed(error: QtetError): void;
}

export interface Transport {
  readonly isConnected: boolean;
  connect(): void;
  /** Starts a stream. Late frames of the previous one are dropped. */
  open(request: OpenRequest): void;
  stop(): void;
  /** Nothing more comes until `resume` or `open`. */
  pause(): void;
  /** Returns false if the stream cannot continue; it must be opened again. */
  resume(): boolean;
  /** Moves the place to stop at; null means the end. */
  aim(target: Target | null): void;
  /** Returns the credit of `bytes` applied payload bytes. */
  applied(bytes: number): void;
  /** Disconnects; `connect` may be called again. */
  disconnect(): void;
}
