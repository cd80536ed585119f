// The figures behind the progress bar: what there is now, what there will be, and how many bytes lie between.

import type {Codec} from './codec';
import type {Manifest} from './manifest';
import {kFirstFieldPart, kPositionsPart, kStructurePart} from './protocol';

export interface Counts {
  tetrahedra: number;
  vertices: number;
  boundaryTriangles: number;
}

export interface Statistics extends Counts {
  /** Of the original mesh. */
  total: Counts;
  level: number;
  lastLevel: number;
  chunks: number;
  chunkCount: number;
  /** Bytes applied and needed to show the whole mesh with the chosen fields. */
  bytes: number;
  bytesNeeded: number;
}

export const kNoStatistics: Statistics = {
  tetrahedra: 0, vertices: 0, boundaryTriangles: 0, total: {tetrahedra: 0, vertices: 0, boundaryTriangles: 0},
  level: 0, lastLevel: 0, chunks: 0, chunkCount: 0, bytes: 0, bytesNeeded: 0,
};

/** Bytes of a log's front by chunks: prefix sums, so that a figure costs nothing however many chunks there are. */
export class ByteLedger {
  private readonly mesh: Float64Array;
  private readonly fields = new Map<number, Float64Array>();

  constructor(private readonly codec: Codec, private readonly headBytes: number) {
    this.mesh = this.sums([kStructurePart, kPositionsPart]);
  }

  /** Bytes applied and bytes needed of the mesh with these fields. */
  bytes(fields: readonly number[]): {applied: number; needed: number} {
    const sum = {applied: this.headBytes + this.mesh[this.codec.chunksApplied]!, needed: this.headBytes + this.mesh[this.mesh.length - 1]!};
    for (const field of fields) {
      const sums = this.sumsOf(field);
      sum.applied += sums[this.codec.fieldChunksApplied(field)]!;
      sum.needed += sums[sums.length - 1]!;
    }
    return sum;
  }

  private sumsOf(field: number): Float64Array {
    let sums = this.fields.get(field);
    if (!sums) this.fields.set(field, (sums = this.sums([kFirstFieldPart + field])));
    return sums;
  }

  private sums(parts: number[]): Float64Array {
    const sums = new Float64Array(this.codec.chunkCount + 1);
    for (let chunk = 0; chunk < this.codec.chunkCount; ++chunk) {
      sums[chunk + 1] = sums[chunk]! + parts.reduce((sum, part) => sum + this.codec.blockSize(chunk, part), 0);
    }
    return sums;
  }
}

/** `fields` are indexes into the manifest's. */
export function statisticsOf(codec: Codec, manifest: Manifest, ledger: ByteLedger, fields: readonly number[]): Statistics {
  const last = manifest.levels[manifest.levels.length - 1];
  const {applied, needed} = ledger.bytes(fields);
  return {
    tetrahedra: codec.tetrahedronCount, vertices: codec.vertexCount, boundaryTriangles: codec.boundaryCount,
    total: {tetrahedra: last?.tetrahedra ?? 0, vertices: last?.vertices ?? 0, boundaryTriangles: last?.boundaryTriangles ?? 0},
    level: codec.level, lastLevel: last?.level ?? 0, chunks: codec.chunksApplied, chunkCount: codec.chunkCount,
    bytes: applied, bytesNeeded: needed,
  };
}
