// Sizes that a server states. None is believed beyond what a browser can hold.

import {QtetError} from '../protocol/errors';

/**
 * Bytes of one answer, or of a file that is read whole: arrays of every browser of today can be so
 * long. Larger logs need a server with byte ranges.
 */
export const kMaxAnswerBytes = 2 ** 31;
/** Bytes of a file: larger ones have no exact places in a number. */
export const kMaxFileBytes = Number.MAX_SAFE_INTEGER;
/** Bytes that an array takes before any of them is here: most logs fit, and a lie costs little. */
export const kMaxRoomAhead = 16 << 20;

const kGigabyte = 1e9;

export function tooLarge(place: string, bytes: number, most: number): QtetError {
  const [stated, allowed] = [bytes, most].map((size) => (size / kGigabyte).toPrecision(2));
  return new QtetError(
    'limit-exceeded',
    `${place} has ${stated} GB, and at most ${allowed} GB can be read at once. ` +
      'Put the log on a server that answers byte ranges.',
  );
}

/**
 * The length of the answer as its header states it; 0: it states none. Throws `limit-exceeded` and
 * drops the answer.
 */
export function statedBytes(response: Response, place: string): number {
  const bytes = Number(response.headers.get('content-length') ?? 0);
  if (bytes > kMaxAnswerBytes) {
    void response.body?.cancel();
    throw tooLarge(place, bytes, kMaxAnswerBytes);
  }
  return bytes > 0 && Number.isInteger(bytes) ? bytes : 0;
}

/** Throws `limit-exceeded` where memory ends. */
export function roomFor(bytes: number, place: string): Uint8Array<ArrayBuffer> {
  if (bytes > kMaxAnswerBytes) throw tooLarge(place, bytes, kMaxAnswerBytes);
  try {
    return new Uint8Array(bytes);
  } catch {
    throw new QtetError(
      'limit-exceeded',
      `There is no memory for the ${(bytes / kGigabyte).toPrecision(2)} GB of ${place}. ` +
        'Close other pages, or put the log on a server that answers byte ranges.',
    );
  }
}
