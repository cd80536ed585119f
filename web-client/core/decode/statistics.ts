// The figures behind the progress bar: what is here, what will be, and how many bytes are missing.

import type {Counts} from '../protocol/counts';
import type {Manifest} from '../protocol/manifest';
import {kFirstFieldPart, kPositionsPart, kStructurePart} from '../protocol/parts';
import type {Codec} from './codec';

export interface Statistics extends Counts {
  /** The original mesh. */
  total: Counts;
  level: number;
  lastLevel: number;
  chunks: number;
  chunkCount: number;
  /** Bytes applied, and bytes needed for the whole mesh with the chosen fields. */
  bytes: number;
  bytesNeeded: number;
}

export const kNoStatistics: Statistics = {
  tetrahedra: 0,
  vertices: 0,
  boundaryTriangles: 0,
  total: {tetrahedra: 0, vertices: 0, boundaryTriangles: 0},
  level: 0,
  lastLevel: 0,
  chunks: 0,
  chunkCount: 0,
  bytes: 0,
  bytesNeeded: 0,
};

/** Counts what is applied, as it comes. */
export class Ledger {
  counts: Counts = {tetrahedra: 0, vertices: 0, boundaryTriangles: 0};
  private meshBytes = 0;
  private readonly meshNeeded: number;
  /** Bytes applied and needed, by field. */
  private readonly fields = new Map<number, {applied: number; needed: number}>();

  constructor(
    private readonly codec: Codec,
    private readonly headBytes: number,
  ) {
    this.meshNeeded = this.needed([kStructurePart, kPositionsPart]);
  }

  addChunk(chunk: number): void {
    this.meshBytes +=
      this.codec.blockSize(chunk, kStructurePart) + this.codec.blockSize(chunk, kPositionsPart);
    const {tetrahedra, vertices, boundaryTriangles} = this.codec.brings(chunk);
    this.counts.tetrahedra += tetrahedra;
    this.counts.vertices += vertices;
    this.counts.boundaryTriangles += boundaryTriangles;
  }
  addField(field: number, chunk: number): void {
    this.ofField(field).applied += this.codec.blockSize(chunk, kFirstFieldPart + field);
  }

  clear(): void {
    this.counts = {tetrahedra: 0, vertices: 0, boundaryTriangles: 0};
    this.meshBytes = 0;
    for (const sums of this.fields.values()) sums.applied = 0;
  }

  /** Bytes applied and bytes needed for the mesh with these fields. */
  bytes(fields: readonly number[]): {applied: number; needed: number} {
    const sum = {
      applied: this.headBytes + this.meshBytes,
      needed: this.headBytes + this.meshNeeded,
    };
    for (const field of fields) {
      const {applied, needed} = this.ofField(field);
      sum.applied += applied;
      sum.needed += needed;
    }
    return sum;
  }

  private ofField(field: number): {applied: number; needed: number} {
    let sums = this.fields.get(field);
    if (!sums)
      this.fields.set(field, (sums = {applied: 0, needed: this.needed([kFirstFieldPart + field])}));
    return sums;
  }

  private needed(parts: number[]): number {
    let sum = 0;
    for (let chunk = 0; chunk < this.codec.chunkCount; ++chunk)
      for (const part of parts) sum += this.codec.blockSize(chunk, part);
    return sum;
  }
}

/** `fields` are indexes into the manifest's. */
export function statisticsOf(
  codec: Codec,
  manifest: Manifest,
  ledger: Ledger,
  fields: readonly number[],
): Statistics {
  const last = manifest.levels[manifest.levels.length - 1];
  const {applied, needed} = ledger.bytes(fields);
  return {
    ...ledger.counts,
    total: {
      tetrahedra: last?.tetrahedra ?? 0,
      vertices: last?.vertices ?? 0,
      boundaryTriangles: last?.boundaryTriangles ?? 0,
    },
    level: codec.level,
    lastLevel: last?.level ?? 0,
    chunks: codec.chunksApplied,
    chunkCount: codec.chunkCount,
    bytes: applied,
    bytesNeeded: needed,
  };
}
