// A list of segments: the logs of a run whose cells change over time, each with its times. The
// instants of all of them are one series.

import {QtetError} from './errors';
import {nearestTo} from './series';

export const kMaxSegments = 1024;
export const kMaxListBytes = 4 << 20;
/** A log name in UTF-8. */
const kMaxNameBytes = 256;
/** The member `qtet` of a list. */
const kMark = 'series';
const kEnding = '.qtet';

export interface ListedInstant {
  time: number;
  text: string;
  /** An index into `logs`. */
  segment: number;
}

export interface SegmentList {
  /** The files' names, beside the list. */
  readonly logs: readonly string[];
  /** Ascending by time; each log has at least one. */
  readonly instants: readonly ListedInstant[];
}

/** Whether the value, as parsed from JSON, says that it is a list of segments. */
export function isSegmentList(value: unknown): boolean {
  return isObject(value) && value.qtet === kMark;
}

/**
 * Reads a list that was parsed from `sizeBytes` of JSON. Unknown members are ignored. Throws
 * `bad-value` or `limit-exceeded`. REQUIRES: isSegmentList(value).
 */
export function readSegmentList(value: unknown, sizeBytes: number): SegmentList {
  const {segments} = value as {segments?: unknown};
  if (sizeBytes > kMaxListBytes)
    throw wrong(`it has ${sizeBytes} bytes, more than ${kMaxListBytes}`, 'limit-exceeded');
  if (!Array.isArray(segments) || segments.length === 0)
    throw wrong('"segments" is no array of at least one segment');
  if (segments.length > kMaxSegments)
    throw wrong(`it has ${segments.length} segments, more than ${kMaxSegments}`, 'limit-exceeded');
  const logs: string[] = [];
  const instants: ListedInstant[] = [];
  segments.forEach((its: unknown, segment) => {
    const at = `segments[${segment}]`;
    if (!isObject(its)) throw wrong(`${at} is no object`);
    logs.push(readLog(its.log, `${at}.log`));
    if (!Array.isArray(its.times) || its.times.length === 0)
      throw wrong(`${at}.times is no array of at least one time`);
    its.times.forEach((time: unknown, i) => {
      const last = instants.at(-1)?.time ?? -Infinity;
      instants.push({...readTime(time, last, `${at}.times[${i}]`), segment});
    });
  });
  return {logs, instants};
}

/** The instant nearest to the time, the earlier one of two; null: the first one. */
export function listedInstant({instants}: SegmentList, time: number | null): ListedInstant {
  return instants[nearestTo(instants, time ?? -Infinity)]!;
}

function readLog(log: unknown, at: string): string {
  if (typeof log === 'string' && isFileName(log)) return log;
  throw wrong(
    `${at} is ${JSON.stringify(log)}, but a log lies beside its list: it takes the name of a ` +
      `file that ends in ${kEnding}, without a folder`,
  );
}

/** Lone surrogates have no UTF-8, so no address holds them. */
function isFileName(log: string): boolean {
  return (
    log.endsWith(kEnding) &&
    log.length > kEnding.length &&
    !/[/\\\0]|\.\.|\p{Surrogate}/u.test(log) &&
    new TextEncoder().encode(log).length <= kMaxNameBytes
  );
}

function readTime(time: unknown, last: number, at: string): {time: number; text: string} {
  if (typeof time !== 'number' || !Number.isFinite(time))
    throw wrong(`${at} is ${JSON.stringify(time)}, which is no finite number`);
  if (time <= last)
    throw wrong(`${at} is ${time}, but the time before it is ${last}; times ascend`);
  return {time, text: String(time)};
}

function wrong(what: string, code = 'bad-value'): QtetError {
  return new QtetError(code, `${what}. Correct the list, or make it again.`);
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null;
}
