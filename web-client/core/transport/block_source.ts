// Brings blocks over HTTP: from a file, by byte ranges; or from a qtet-server or a cache in front
// of it, by their numbers.

import {QtetError} from '../protocol/errors';
import type {LogTable} from '../protocol/log_table';
import {beginsLog} from '../protocol/magic';
import {kFirstFieldPart, kStructurePart} from '../protocol/parts';
import {emptyFile, fetchChecked, RangedFile, type Fetch} from './ranged_file';

/** Neighbouring blocks of one chunk. */
export interface Piece {
  chunk: number;
  firstPart: number;
  parts: number;
}

export interface BlockSource {
  /** Header, manifest and chunk table. */
  head(signal: AbortSignal): Promise<Uint8Array>;
  /**
   * How many of `pieces` (at least one) one request should fetch when about `bytes` bytes are
   * wanted.
   */
  together(pieces: readonly Piece[], bytes: number): number;
  /**
   * The bytes of each piece. Throws `network`, `not-found`, `http`, `log-changed`,
   * `limit-exceeded`.
   */
  fetch(pieces: readonly Piece[], signal: AbortSignal): Promise<Uint8Array[]>;
  /** SHA-256 of the log if the server states it, else the response's tag. */
  readonly digest: string;
}

const kHeaderBytes = 64;
/** proto/limits.h. */
const kMaxManifestBytes = 8 << 20;
/** A log of 1 GB with 8,192 fields takes 60 MB; a browser decodes no larger one. */
const kMaxTableBytes = 256 << 20;
const kManifestBytesAt = 24;
const kTableBytesAt = 28;
/** Reading over so many unwanted bytes is cheaper than another request. */
const kGapBytes = 4096;

/** The size of the log's front, from its first 64 bytes. Throws `truncated`, `limit-exceeded`. */
export function headBytesOf(header: Uint8Array): number {
  if (header.length < kHeaderBytes)
    throw new QtetError('truncated', 'The file is too short for a qtet log.');
  const view = new DataView(header.buffer, header.byteOffset);
  const manifest = view.getUint32(kManifestBytesAt, true);
  const table = view.getUint32(kTableBytesAt, true);
  if (manifest > kMaxManifestBytes || table > kMaxTableBytes)
    throw new QtetError(
      'limit-exceeded',
      `The log's head says that it has ${manifest + table} bytes, more than a log can have. ` +
        'Copy the file again.',
    );
  return kHeaderBytes + manifest + table;
}

const plainTag = (tag: string): string => tag.replace(/^"|"$/g, '');

export class RangeSource implements BlockSource {
  private readonly file: RangedFile;

  constructor(
    url: string,
    private readonly table: LogTable,
    fetch?: Fetch,
    firstBytes?: number,
  ) {
    this.file = new RangedFile(url, fetch, firstBytes);
  }

  get digest(): string {
    return plainTag(this.file.tag);
  }

  async head(signal: AbortSignal): Promise<Uint8Array> {
    const header = await this.file.read(0, kHeaderBytes, signal);
    if (header.length === 0) throw emptyFile(this.file.place);
    if (!beginsLog(header)) {
      throw new QtetError('bad-magic', `${this.file.place} is no qtet log. Is it the right one?`);
    }
    return this.file.read(0, headBytesOf(header), signal);
  }

  together(pieces: readonly Piece[], bytes: number): number {
    const start = this.begin(pieces[0]!);
    let count = 1;
    for (; count < pieces.length; ++count) {
      const gap = this.begin(pieces[count]!) - this.end(pieces[count - 1]!);
      if (gap < 0 || gap > kGapBytes || this.end(pieces[count]!) - start > bytes) break;
    }
    return count;
  }

  async fetch(pieces: readonly Piece[], signal: AbortSignal): Promise<Uint8Array[]> {
    const start = this.begin(pieces[0]!);
    const end = this.end(pieces[pieces.length - 1]!);
    const bytes = end > start ? await this.file.read(start, end, signal) : new Uint8Array(0);
    if (bytes.length < end - start)
      throw new QtetError(
        'truncated',
        `${this.file.url} ends before its last chunk does. Copy the file again.`,
      );
    return pieces.map((piece) =>
      bytes.subarray(this.begin(piece) - start, this.end(piece) - start),
    );
  }

  private begin({chunk, firstPart}: Piece): number {
    return this.table.blockOffset(chunk, firstPart);
  }
  private end({chunk, firstPart, parts}: Piece): number {
    const last = firstPart + parts - 1;
    return this.table.blockOffset(chunk, last) + this.table.blockSize(chunk, last);
  }
}

export class ChunkSource implements BlockSource {
  digest = '';
  /** The base of the log's own addresses, once a redirection has given it. */
  private base: string;

  /** `url`: /v1/meshes/{id}/log of a server. */
  constructor(
    url: string,
    private readonly table: LogTable,
    private readonly get: Fetch = (address, init) => globalThis.fetch(address, init),
  ) {
    this.base = url;
  }

  async head(signal: AbortSignal): Promise<Uint8Array> {
    const response = await fetchChecked(this.get, new URL('base', this.base).href, {signal});
    if (response.url) this.base = response.url;
    this.digest =
      /\/v1\/logs\/([0-9a-f]{64})\//.exec(response.url)?.[1] ??
      plainTag(response.headers.get('etag') ?? '');
    const bytes = new Uint8Array(await response.arrayBuffer());
    return bytes.subarray(0, headBytesOf(bytes));
  }

  together(): number {
    return 1;
  }

  async fetch([piece]: readonly Piece[], signal: AbortSignal): Promise<Uint8Array[]> {
    const {chunk, firstPart} = piece!;
    const key =
      firstPart === kStructurePart
        ? ''
        : `fields/${encodeURIComponent(this.table.fieldKeys[firstPart - kFirstFieldPart]!)}/`;
    const response = await fetchChecked(
      this.get,
      new URL(`${key}chunks/${chunk}`, this.base).href,
      {signal},
    );
    return [new Uint8Array(await response.arrayBuffer())];
  }
}
