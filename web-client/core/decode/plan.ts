// The targets that the chunks of a log reach, one after the other. They decide where a
// stream may stop, so that nothing behind a limit is sent or fetched.

import {errorOfLevel, limitReached, type Limit} from '../protocol/limit';
import type {Manifest} from '../protocol/manifest';
import type {Target} from '../protocol/messages';
import {kFirstFieldPart} from '../protocol/parts';
import type {Codec} from './codec';

/**
 * Bytes of the log that a level needs with the fields that are asked for. `level` is an index into
 * the manifest's levels.
 */
export interface LevelBytes {
  bytes: number;
  level: number;
}

/** Returns null if everything is wanted. `headBytes` is the size of the log's head. */
export function targetOf(
  limit: Limit,
  codec: Codec,
  {levels}: Manifest,
  fields: readonly number[],
  headBytes: number,
): Target | null {
  if (limit.kind === 'full') return null;
  for (const {chunks, tetrahedra, bytes, level} of stepsOf(codec, levels, fields, headBytes)) {
    if (!limitReached(limit, {tetrahedra, bytes}, errorOfLevel(levels, level, fields))) continue;
    const holding = levels.find((info) => info.tetrahedra >= tetrahedra);
    return holding ? {chunks, level: holding.level} : null;
  }
  return null;
}

/** The bytes with which each level is complete, ascending, for the levels that a chunk ends. */
export function planOf(
  codec: Codec,
  {levels}: Manifest,
  fields: readonly number[],
  headBytes: number,
): LevelBytes[] {
  return [...stepsOf(codec, levels, fields, headBytes)].map(({bytes, level}) => ({bytes, level}));
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
