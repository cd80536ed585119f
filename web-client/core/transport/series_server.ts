// Asks the qtet server that has the log for a series at a point (proto/PROTOCOL.md, "Values over
// time").

import {QtetError} from '../protocol/errors';
import type {FieldInfo} from '../protocol/fields';
import type {Vector} from '../protocol/geometry';
import {fetchChecked, type Fetch} from './ranged_file';
import {statedBytes} from './stated_size';
import {fetchWith} from './token';

/** If no level is asked for, the answer is off by at most this share of the range (rms). */
export const kSeriesError = 0.01;
/** Answers of a server that has no time now. It is asked once more. */
const kBusy = [429, 503];
/** The pause before that, if the server names none. */
const kPauseMs = 2000;
/** The longest one: a user waits for the plot, and the blocks of the instants come without it. */
export const kMaxPauseMs = 10000;

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

  /**
   * Asks a busy server once more. Throws `network`, `not-found`, `http`, `limit-exceeded`,
   * `bad-message`, and the reason of `signal`.
   */
  async values(question: SeriesQuestion, signal: AbortSignal): Promise<SeriesValues> {
    const {point, field, level} = question;
    const url = new URL(this.address);
    point.forEach((x, axis) => url.searchParams.set('xyz'[axis]!, String(x)));
    url.searchParams.set('field', keyOf(field));
    if (level !== null) url.searchParams.set('level', String(level));
    const patient: Fetch = async (address, init) => {
      const first = await this.fetch(address, init);
      if (!kBusy.includes(first.status)) return first;
      await pause(pauseOf(first.headers.get('retry-after')), signal);
      return this.fetch(address, init);
    };
    const response = await fetchChecked(patient, url.href, {signal});
    const text = await response.text();
    const length = statedBytes(response, url.href);
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

/** REQUIRES: an instant. */
function keyOf({association, instant}: FieldInfo): string {
  const {name} = instant!;
  return association === 'cell' ? `cell:${name}` : name;
}

/** The time in ms for a header Retry-After: seconds or a date. */
function pauseOf(header: string | null): number {
  if (!header) return kPauseMs;
  const ms = /^\d+$/.test(header) ? 1000 * Number(header) : Date.parse(header) - Date.now();
  return Number.isNaN(ms) ? kPauseMs : Math.min(kMaxPauseMs, Math.max(0, ms));
}

/** Throws the reason of `signal` when it is aborted. */
function pause(ms: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const abort = (): void => {
      clearTimeout(timer);
      reject(signal.reason as Error);
    };
    const timer = setTimeout(() => {
      signal.removeEventListener('abort', abort);
      resolve();
    }, ms);
    signal.addEventListener('abort', abort, {once: true});
    if (signal.aborted) abort();
  });
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
    !times.every((time, i) => Number.isFinite(time) && (i === 0 || time > times[i - 1])) ||
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
