// A file on any web server, read by byte ranges. If a server has no ranges, the whole file is
// read as it comes.

import {QtetError} from '../protocol/errors';
import {refusedOrigin} from './refused_origin';
import {
  kMaxAnswerBytes,
  kMaxFileBytes,
  kMaxRoomAhead,
  roomFor,
  statedBytes,
  tooLarge,
} from './stated_size';

/**
 * The first request asks for so much if nothing is known of the file: a log's head and its first
 * levels in one round trip.
 */
const kFirstBytes = 64 << 10;
/** A list that says how much to ask for is believed within these bounds. */
const kMinFirstBytes = 64;
const kMaxFirstBytes = 1 << 20;
/** Status codes that may pass. */
const kPassing = [408, 425, 429];

/** The answer of a server to byte ranges of an empty file. */
const kNoSuchRange = 416;

export type Fetch = (url: string, init: RequestInit) => Promise<Response>;

/**
 * Fetches. Throws `http` for an answer that will not change, and `network` for one that may. Throws
 * `limit-exceeded` for one that states more than a browser can hold.
 */
export async function fetchChecked(
  fetch: Fetch,
  url: string,
  init: RequestInit,
): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(url, init);
  } catch (thrown) {
    if (init.signal?.aborted) throw thrown;
    throw (await refusedOrigin(url)) ?? new QtetError('network', `${url} does not answer.`);
  }
  if (response.ok) {
    statedBytes(response, url);
    return response;
  }
  const {status, statusText} = response;
  if (status === kNoSuchRange) throw emptyFile(url);
  const code =
    status >= 500 || kPassing.includes(status)
      ? 'network'
      : status === 404 || status === 410
        ? 'not-found'
        : 'http';
  throw new QtetError(code, `${url} is answered by "${status} ${statusText}".`);
}

export function emptyFile(url: string): QtetError {
  return new QtetError('truncated', `${url} is empty: it has 0 bytes. Copy the file again.`);
}

export class RangedFile {
  /** The address that redirections led to, and the tag of what is there. */
  url: string;
  tag = '';
  /** In bytes; 0 until it is known. */
  size = 0;
  /**
   * The beginning of the file: the first answer, or everything so far from a server without ranges.
   */
  private front: Uint8Array<ArrayBuffer> = new Uint8Array(0);
  private frontSize = 0;
  private first: Promise<void> | null = null;
  private whole = false;
  /** All of a file without ranges is here. */
  private ended = false;
  private readonly firstBytes: number;
  /** Percent-encoded; empty for a file with an address. */
  private readonly fileName: string;
  private waiting: {to: number; resolve: () => void; reject: (thrown: unknown) => void}[] = [];

  /** `firstBytes`: what the first request asks for. */
  constructor(
    url: string,
    private readonly fetch: Fetch = (address, init) => globalThis.fetch(address, init),
    firstBytes = kFirstBytes,
  ) {
    this.url = url;
    this.fileName = /^blob:.*#(.+)$/.exec(url)?.[1] ?? '';
    this.firstBytes = Math.min(kMaxFirstBytes, Math.max(kMinFirstBytes, firstBytes));
  }

  /** Its address for people, or its name if it was dropped on the page. */
  get place(): string {
    return decodeURIComponent(this.fileName) || this.url;
  }

  /**
   * Bytes [from, to); fewer only at the end of the file. Throws `network`, `not-found`, `http`,
   * `limit-exceeded`, and `log-changed` if the file has been replaced.
   */
  async read(from: number, to: number, signal: AbortSignal): Promise<Uint8Array> {
    this.first ??= this.begin();
    try {
      await this.first;
    } catch (thrown) {
      this.first = null;
      throw thrown;
    }
    to = Math.min(to, this.size || to);
    if (this.whole) await this.arrival(to);
    if (to <= this.frontSize) return this.front.subarray(from, to);
    const known = this.front.subarray(Math.min(from, this.frontSize), this.frontSize);
    const rest = await this.range(Math.max(from, this.frontSize), to, signal);
    if (known.length === 0) return rest;
    const joined = roomFor(known.length + rest.length, this.place);
    joined.set(known);
    joined.set(rest, known.length);
    return joined;
  }

  /** No reader's signal cancels this: the next reader needs it, too. */
  private async begin(): Promise<void> {
    const response = await fetchChecked(this.fetch, this.url, {
      headers: {Range: `bytes=0-${this.firstBytes - 1}`},
    });
    this.tag = response.headers.get('etag') ?? '';
    if (response.url) this.url = response.url;
    if (response.status !== 206) {
      this.whole = true;
      this.ended = false;
      const ahead = Math.min(kMaxRoomAhead, statedBytes(response, this.place));
      this.front = roomFor(ahead, this.place);
      void this.drain(response);
      return;
    }
    this.take(new Uint8Array(await response.arrayBuffer()));
    const total = /\/(\d+)$/.exec(response.headers.get('content-range') ?? '')?.[1];
    if (Number(total) > kMaxFileBytes) throw tooLarge(this.place, Number(total), kMaxFileBytes);
    if (total) this.size = Number(total);
    else if (this.frontSize < this.firstBytes) this.size = this.frontSize;
  }

  /**
   * Chromium keeps parts of files. Where a request meets several of them, it may give fewer bytes
   * than asked for, without an error. Then they come past its cache.
   */
  private async range(from: number, to: number, signal: AbortSignal): Promise<Uint8Array> {
    const bytes = await this.rangeBy(from, to, {signal});
    if (bytes.length >= to - from) return bytes;
    return this.rangeBy(from, to, {signal, cache: 'no-store'});
  }

  private async rangeBy(from: number, to: number, init: RequestInit): Promise<Uint8Array> {
    const response = await fetchChecked(this.fetch, this.url, {
      ...init,
      headers: {Range: `bytes=${from}-${to - 1}`},
    });
    const tag = response.headers.get('etag') ?? '';
    if (tag !== this.tag)
      throw new QtetError(
        'log-changed',
        'Another file has taken the place of the one that was being read.',
      );
    const bytes = new Uint8Array(await response.arrayBuffer());
    return response.status === 206 ? bytes : bytes.subarray(from, to);
  }

  /** Reads the whole file piece by piece. A reader continues as soon as its part is here. */
  private async drain(response: Response): Promise<void> {
    const reader = response.body!.getReader();
    try {
      for (;;) {
        const {done, value} = await reader.read();
        if (done) break;
        this.take(value);
      }
      this.size = this.frontSize;
      this.ended = true;
      this.wake(Infinity);
    } catch (thrown) {
      this.first = null;
      this.frontSize = 0;
      this.front = new Uint8Array(0);
      const isOurs = thrown instanceof QtetError;
      if (isOurs) void reader.cancel();
      const error = isOurs ? thrown : new QtetError('network', `${this.url} broke off.`);
      for (const {reject} of this.waiting.splice(0)) reject(error);
    }
  }

  private take(bytes: Uint8Array): void {
    const needed = this.frontSize + bytes.length;
    if (needed > this.front.length) {
      const twice = Math.min(kMaxAnswerBytes, 2 * this.front.length);
      const grown = roomFor(Math.max(needed, twice), this.place);
      grown.set(this.front.subarray(0, this.frontSize));
      this.front = grown;
    }
    this.front.set(bytes, this.frontSize);
    this.frontSize = needed;
    this.wake(needed);
  }

  private wake(here: number): void {
    const ready = this.waiting.filter(({to}) => to <= here);
    this.waiting = this.waiting.filter(({to}) => to > here);
    for (const {resolve} of ready) resolve();
  }

  private arrival(to: number): Promise<void> {
    if (to <= this.frontSize || this.ended || (this.size > 0 && this.frontSize >= this.size))
      return Promise.resolve();
    return new Promise((resolve, reject) => this.waiting.push({to, resolve, reject}));
  }
}
