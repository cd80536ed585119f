// How far to refine: fully, or up to a number of cells, a number of bytes, or an error.

import type {LevelError, LevelInfo} from './manifest';

export type Limit =
  | {kind: 'full'}
  /**
   * `cells` counts tetrahedra, `bytes` those of the log. `error` is the known rms error of the
   * shown fields over their range, or of the boundary over the diagonal.
   */
  | {kind: 'cells' | 'bytes' | 'error'; value: number};

export const kFull: Limit = {kind: 'full'};

/**
 * The known errors of a level. Where it was not measured, those of the last coarser level where it
 * was. Undefined: the log does not tell.
 */
export function errorsOfLevel(
  levels: readonly LevelInfo[] | undefined,
  level: number,
): LevelError | undefined {
  let error: LevelError | undefined;
  for (let at = level; at >= 0 && !error; --at) error = levels?.[at]?.error;
  return error;
}

/**
 * The known error of a level: the largest of these fields', or the boundary's if there are none.
 * Null: the log does not tell.
 */
export function errorOfLevel(
  levels: readonly LevelInfo[] | undefined,
  level: number,
  fields: readonly number[],
): number | null {
  const error = errorsOfLevel(levels, level);
  if (!error) return null;
  if (fields.length === 0) return error.toOriginal.mean;
  const largest = Math.max(...fields.map((field) => error.fields[field]?.mean ?? 0));
  return Number.isNaN(largest) ? null : largest; // no rule bounds that of a derived field
}

export function limitReached(
  limit: Limit,
  statistics: {tetrahedra: number; bytes: number},
  error: number | null,
): boolean {
  switch (limit.kind) {
    case 'full':
      return false;
    case 'cells':
      return statistics.tetrahedra >= limit.value;
    case 'bytes':
      return statistics.bytes >= limit.value;
    case 'error':
      return error !== null && error <= limit.value;
  }
}

/**
 * Reads an attribute: "full", "cells:20000", "bytes:100000", "error:0.01", "1%"; null for anything
 * else.
 */
export function parseLimit(text: string | null): Limit | null {
  if (text === null || text === 'full' || text === '') return kFull;
  const match = /^(?:(cells|bytes|error):)?(\d+(?:\.\d*)?(?:e[+-]?\d+)?)(%?)$/i.exec(text.trim());
  if (!match || (!match[1] && !match[3])) return null;
  const value = Number(match[2]) / (match[3] ? 100 : 1);
  const kind = (match[1] ?? 'error') as 'cells' | 'bytes' | 'error';
  return value > 0 ? {kind, value} : null;
}

export function limitText(limit: Limit): string {
  return limit.kind === 'full' ? 'full' : `${limit.kind}:${limit.value}`;
}
