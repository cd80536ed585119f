// The blocks of a log that have arrived, by chunk and part.

import {kPositionsPart, kStructurePart} from '../protocol/parts';

export class Blocks {
  private readonly chunks: (Uint8Array | undefined)[][];
  /** By part: the results of leading. */
  private readonly received: number[] = [];

  constructor(chunkCount: number) {
    this.chunks = Array.from({length: chunkCount}, () => []);
  }

  keep(chunk: number, part: number, bytes: Uint8Array): void {
    this.chunks[chunk]![part] = bytes;
  }

  at(chunk: number, part: number): Uint8Array | undefined {
    return this.chunks[chunk]?.[part];
  }

  /** The chunk's structure and positions; null unless both are here. */
  mesh(chunk: number): [Uint8Array, Uint8Array] | null {
    const structure = this.at(chunk, kStructurePart);
    const positions = this.at(chunk, kPositionsPart);
    return structure && positions ? [structure, positions] : null;
  }

  /** How many leading chunks have this part. */
  leading(part: number): number {
    let count = this.received[part] ?? 0;
    while (this.at(count, part)) ++count;
    return (this.received[part] = count);
  }
}
