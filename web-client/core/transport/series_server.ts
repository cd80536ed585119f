// Asks the qtet server that has the log for a series at a point (proto/PROTOCOL.md, "Values over
// time").

import {QtetError} from '../protocol/errors';
import type {FieldInfo} from '../protocol/fields';
import type {Vector} from '../protocol/geometry';
import {instantName} from '../protocol/series';
import {fetchChecked, type Fetch} from './ranged_file';
import {fetchWith} from './token';

/** If no level is asked for, the answer is off by at most this share of the range (rms). */
export const kSeriesError = 0.01;

export interface SeriesQuestion {
  /** In the coordinates of the input. */
  point: Vector;
  /** An instant of the series. */
  field: FieldInfo;
  /** Null: the coarsest level within kSeriesError, else the last. */
  level: number | null;
}

export interface SeriesValues {
  /** Ascending. */
  times: number[];
  /** By instant: one value a component; NaN is missing. */
  values: number[][];
  level: number;
  /** The length of the answer, as it was sent. */
  bytes: number;
}

export class SeriesServer {
  /** `address`: /v1/logs/{sha256}/series. */
  constructor(
    private readonly address: string,
    private readonly fetch: Fetch,
  ) {}

  /** Throws `network`, `not-found`, `http`, `bad-message`, and what `signal` makes fetch throw. */
  async values(question: SeriesQuestion, signal: AbortSignal): Promise<SeriesValues> {
    const {point, field, level} = question;
    const url = new URL(this.address);
    point.forEach((x, axis) => url.searchParams.set('xyz'[axis]!, String(x)));
    url.searchParams.set('field', keyOf(field));
    if (level !== null) url.searchParams.set('level', String(level));
    const response = await fetchChecked(this.fetch, url.href, {signal});
    const text = await response.text();
    const length = Number(response.headers.get('content-length'));
    return {
      ...checkedValues(text, field.components),
      bytes: length || new TextEncoder().encode(text).length,
    };
  }
}

/**
 * The server that has the log of this address; null for a file of another host. `digest` is the
 * log's SHA-256. Where another tag stands for it, the server is asked by the mesh's name.
 */
export function seriesServer(
  log: string,
  digest: string,
  token: string,
  fetch: Fetch = (url, init) => globalThis.fetch(url, init),
): SeriesServer | null {
  const found = /^(https?:\/\/.*\/v1\/)((?:meshes|logs)\/[^/]+)\/log$/.exec(log);
  if (!found) return null;
  const mesh = /^[0-9a-f]{64}$/.test(digest) ? `logs/${digest}` : found[2]!;
  return new SeriesServer(`${found[1]!}${mesh}/series`, fetchWith(token, fetch) ?? fetch);
}

function keyOf({association, name}: FieldInfo): string {
  const series = instantName(name)!.series;
  return association === 'cell' ? `cell:${series}` : series;
}

/** An answer as it arrives: no member has been checked. */
type Received = Partial<Record<keyof SeriesValues, unknown>>;

function checkedValues(text: string, components: number): Omit<SeriesValues, 'bytes'> {
  const {times, values, level} = (parsed(text) ?? {}) as Received;
  const isRow = (row: unknown): boolean =>
    Array.isArray(row) &&
    row.length === components &&
    row.every((value) => value === null || typeof value === 'number');
  if (
    !Array.isArray(times) ||
    !Array.isArray(values) ||
    !Number.isInteger(level) ||
    times.length !== values.length ||
    !times.every(Number.isFinite) ||
    !values.every(isRow)
  )
    throw new QtetError('bad-message', 'The server gives something else than values over time.');
  return {
    times: times as number[],
    values: (values as (number | null)[][]).map((row) => row.map((value) => value ?? NaN)),
    level: level as number,
  };
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}
