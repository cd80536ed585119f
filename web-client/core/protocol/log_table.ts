// The places of a log's blocks.

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
  /** Byte offset in the file. */
  blockOffset(chunk: number, part: number): number;
  blockSize(chunk: number, part: number): number;
}
