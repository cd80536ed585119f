// What a session needs of whatever brings the log's blocks: a WebSocket, byte ranges of a file, or
// numbered chunks. All speak in the frames and messages of proto/PROTOCOL.md, and each goes on
// where another one ended.

import type {Packet} from './packet';
import type {QtetError} from './errors';
import type {Goal} from './goal';
import type {WireLattice, ViewRequest} from './view_request';
import type {Frame, OpenRequest, ServerMessage} from './protocol';

export interface TransportHandlers {
  /** Connected (again): the moment to `open`. */
  connected(): void;
  message(message: ServerMessage): void;
  /** A frame of the current stream. */
  frame(frame: Frame): void;
  /** The connection is lost, or was never made; the next attempt comes after `delayMs`. */
  down(attempt: number, delayMs: number): void;
  /** The conversation cannot go on; nothing more is tried. */
  failed(error: QtetError): void;
}

export interface Transport {
  readonly isConnected: boolean;
  connect(): void;
  /** Starts a stream; what still arrives of the one before is dropped. */
  open(request: OpenRequest): void;
  stop(): void;
  /** Nothing more comes until `resume` or `open`. */
  pause(): void;
  /** False: this transport cannot go on where it paused; `open` does. */
  resume(): boolean;
  /** Another place to stop at; null: nowhere before the end. */
  aim(goal: Goal | null): void;
  /** Gives the credit of `bytes` applied payload bytes back. */
  applied(bytes: number): void;
  /** What is looked at: of a log of regions, packets come in another order from now on. */
  look(view: ViewRequest): void;
  /** Ends the connection for good; `connect` may be called again. */
  disconnect(): void;
}

/**
 * The chunk table and the fields' keys, once the head is here: whoever fetches blocks by their
 * places needs them.
 */
export interface LogTable {
  readonly isKnown: boolean;
  readonly chunkCount: number;
  readonly fieldKeys: string[];
  /** Empty in the layout `stream`, whose order is the file's. */
  readonly packets: readonly Packet[];
  /** Null before the head is here. */
  readonly lattice: WireLattice | null;
  /** In the file. */
  blockOffset(chunk: number, part: number): number;
  blockSize(chunk: number, part: number): number;
}
