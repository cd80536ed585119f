// The places of a log's blocks.

import type {Packet} from './packet';
import type {WireLattice} from './view_request';

/**
 * The chunk table and the fields' keys, once the head is here, for those who fetch blocks by their
 * places.
 */
export interface LogTable {
  /** Settled once a head can be taken: the codec may still be on its way. */
  readonly codecReady: Promise<void>;
  readonly isKnown: boolean;
  readonly chunkCount: number;
  readonly fieldKeys: string[];
  /** Empty in the layout `stream`, whose order is the file's. */
  readonly packets: readonly Packet[];
  /** Null before the head is here. */
  readonly lattice: WireLattice | null;
  /** Byte offset in the file. */
  blockOffset(chunk: number, part: number): number;
  blockSize(chunk: number, part: number): number;
}
