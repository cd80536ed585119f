// What the chunks of a log of layout `stream` reach one after the other: where a stream may stop,
// so that nobody sends or fetches what lies behind a limit.

import type {Codec} from './codec';
import {errorOfLevel, limitReached, type Limit} from './limit';
import type {Manifest} from './manifest';
import {kFirstFieldPart} from './parts';

export interface Goal {
  /** Leading chunks. */
  chunks: number;
  /** The first level that holds all of them: what qtet.v1 calls a target. */
  level: number;
}

/**
 * Of the log, to show the mesh with the fields that are asked for; `level`: index into the
 * manifest's.
 */
export interface LevelBytes {
  bytes: number;
  level: number;
}

/**
 * null: everything is wanted, also of logs of regions, whose limits are about what is looked at.
 * `headBytes`: of the log.
 */
export function goalOf(
  limit: Limit,
  codec: Codec,
  {levels}: Manifest,
  fields: readonly number[],
  headBytes: number,
): Goal | null {
  if (limit.kind === 'full' || codec.headChunks < codec.chunkCount) return null;
  for (const {chunks, tetrahedra, bytes, level} of stepsOf(codec, levels, fields, headBytes)) {
    if (!limitReached(limit, {tetrahedra, bytes}, errorOfLevel(levels[level], fields))) continue;
    const holding = levels.find((info) => info.tetrahedra >= tetrahedra);
    return holding ? {chunks, level: holding.level} : null;
  }
  return null;
}

/**
 * The least bytes with which each level is there that a chunk ends, ascending. In a log of regions
 * the packets end it that do not depend on one another: what is looked at may come before them, so
 * that a level is there later than this, and never sooner.
 */
export function planOf(
  codec: Codec,
  {levels}: Manifest,
  fields: readonly number[],
  headBytes: number,
): LevelBytes[] {
  let first = 0; // of those that end the level together
  return [...stepsOf(codec, levels, fields, headBytes)]
    .filter(({chunks}) => {
      const ends = chunks === codec.chunkCount || codec.dependency(chunks) >= first;
      if (ends) first = chunks;
      return ends;
    })
    .map(({bytes, level}) => ({bytes, level}));
}

interface Step extends LevelBytes {
  chunks: number;
  tetrahedra: number;
}

function* stepsOf(
  codec: Codec,
  levels: Manifest['levels'],
  fields: readonly number[],
  headBytes: number,
): Generator<Step> {
  const step = {chunks: 0, tetrahedra: 0, bytes: headBytes, level: 0};
  for (let chunk = 0; chunk < codec.chunkCount; ++chunk) {
    step.chunks = chunk + 1;
    step.tetrahedra += codec.brings(chunk).tetrahedra;
    for (let part = 0; part < kFirstFieldPart; ++part) step.bytes += codec.blockSize(chunk, part);
    for (const field of fields) step.bytes += codec.blockSize(chunk, kFirstFieldPart + field);
    while (step.level + 1 < levels.length && levels[step.level + 1]!.tetrahedra <= step.tetrahedra)
      ++step.level;
    yield {...step};
  }
}
