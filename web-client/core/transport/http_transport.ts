// A log over plain HTTP. A few requests run at a time. Blocks are delivered in order, as the frames
// of proto/STREAM.md, and within the credit.

import {errorCode, errorText, QtetError} from '../protocol/errors';
import type {LogTable} from '../protocol/log_table';
import type {OpenRequest, Target} from '../protocol/messages';
import {kFirstFieldPart, kHeadPart, kStructurePart} from '../protocol/parts';
import {reconnectDelayMs} from './backoff';
import type {BlockSource, Piece} from './block_source';
import {RequestSize} from './request_size';
import type {Transport, TransportHandlers} from './transport';

/**
 * How many requests run at a time. Browsers open six connections to a host over HTTP/1.1, and
 * others want some of them.
 */
const kAhead = 3;
export class HttpTransport implements Transport {
  isConnected = false;
  private stream = 0;
  /** How far the stream may go: so many bytes more, and to this target. */
  private allowed: {credit: number; target: Target | null} = {credit: 0, target: null};
  private attempt = 0;
  private source: BlockSource;
  private abort = new AbortController();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private creditCame: () => void = () => undefined;
  private readonly size = new RequestSize();

  /** `makeSource` is called again when the log has been replaced. */
  constructor(
    private readonly makeSource: () => BlockSource,
    private readonly table: LogTable,
    private readonly handlers: TransportHandlers,
    private readonly random: () => number = Math.random,
  ) {
    this.source = makeSource();
  }

  connect(): void {
    this.disconnect();
    this.timer = setTimeout(() => {
      this.isConnected = true;
      this.handlers.connected();
    }, 0);
  }

  open(request: OpenRequest): void {
    if (!this.isConnected) return;
    this.stop();
    this.abort = new AbortController();
    const {signal} = this.abort;
    this.allowed = {credit: request.credit, target: request.target ?? null};
    this.run(++this.stream, request, signal).catch((thrown: unknown) => {
      if (!signal.aborted) this.lost(thrown); // else another stream has taken its place
    });
  }

  stop(): void {
    this.abort.abort();
  }
  pause(): void {
    this.stop();
  }
  resume(): boolean {
    return false;
  }

  aim(target: Target | null): void {
    this.allowed.target = target;
    this.creditCame();
  }

  applied(bytes: number): void {
    this.allowed.credit += bytes;
    this.creditCame();
  }

  disconnect(): void {
    clearTimeout(this.timer);
    this.stop();
    this.isConnected = false;
  }

  private async run(stream: number, request: OpenRequest, signal: AbortSignal): Promise<void> {
    const deliver = (piece: Piece, payload: Uint8Array): void => {
      this.allowed.credit -= payload.length;
      this.attempt = 0;
      this.handlers.frame({stream, ...piece, payload});
    };
    // The head is fetched even if another transport has brought the table: only the head tells the
    // source which log this is.
    const head = await this.source.head(signal);
    await this.table.codecReady;
    const isOver = (): boolean => signal.aborted;
    if (isOver()) return;
    const {digest} = this.source;
    if (request.digest && digest && request.digest !== digest)
      throw new QtetError('log-changed', 'Another mesh stands under this name now.');
    this.handlers.message({
      type: 'opened',
      stream,
      mesh: request.mesh,
      digest,
      bytes: 0,
      planned: 0,
    });
    if (!this.table.isKnown) deliver({chunk: 0, firstPart: kHeadPart, parts: 0}, head);
    if (isOver()) return; // the manifest made the session open another stream
    await this.fetchAll(piecesOf(this.table, request), deliver, signal);
    if (!isOver()) this.handlers.message({type: 'done', stream});
  }

  /** Fetches the pieces in this order. */
  private async fetchAll(
    pieces: Piece[],
    deliver: (piece: Piece, payload: Uint8Array) => void,
    signal: AbortSignal,
  ): Promise<void> {
    const ahead: {pieces: Piece[]; size: number; payloads: Promise<Uint8Array[]>}[] = [];
    const isOver = (): boolean => signal.aborted;
    let underWay = 0;
    for (;;) {
      for (
        let near = this.wantedNext(pieces);
        near.length > 0 && ahead.length < kAhead && underWay < this.allowed.credit;
        near = this.wantedNext(pieces)
      ) {
        const wanted = pieces.splice(0, this.source.together(near, this.size.bytes));
        const payloads = this.source.fetch(wanted, signal);
        payloads.catch(() => undefined); // awaited below, in its turn
        const size = wanted.reduce((sum, piece) => sum + sizeOf(this.table, piece), 0);
        ahead.push({pieces: wanted, size, payloads});
        underWay += size;
      }
      const next = ahead.shift();
      if (!next && pieces.length === 0) return;
      if (!next) await new Promise<void>((resolve) => void (this.creditCame = resolve));
      if (isOver()) return;
      if (!next) continue;
      const payloads = await next.payloads;
      underWay -= next.size;
      this.size.measure(next.size);
      for (const [i, piece] of next.pieces.entries()) if (!isOver()) deliver(piece, payloads[i]!);
    }
  }

  /** The next pieces before the target. */
  private wantedNext(pieces: Piece[]): Piece[] {
    const near = pieces.slice(0, kMaxPieces);
    const {target} = this.allowed;
    return target ? near.filter(({chunk}) => chunk < target.chunks) : near;
  }

  private lost(thrown: unknown): void {
    this.disconnect();
    const code = errorCode(thrown);
    if (code === 'log-changed') {
      this.source = this.makeSource();
      this.isConnected = true;
      this.handlers.message({type: 'error', code, detail: errorText(thrown)});
      return;
    }
    if (code !== 'network') {
      this.handlers.failed(
        thrown instanceof QtetError ? thrown : new QtetError('internal', errorText(thrown)),
      );
      return;
    }
    const delayMs = reconnectDelayMs(this.attempt, this.random());
    ++this.attempt;
    this.timer = setTimeout(() => this.connect(), delayMs);
    this.handlers.down(this.attempt, delayMs);
  }
}

/** The most pieces that one request may ask for. */
const kMaxPieces = 256;

/**
 * The pieces that `request` lacks, in the order of proto/STREAM.md: chunk by chunk, structure
 * before fields.
 */
export function piecesOf(
  table: LogTable,
  {fields, have}: Pick<OpenRequest, 'fields' | 'have'>,
): Piece[] {
  const wanted = fields
    .map((key) => ({field: table.fieldKeys.indexOf(key), here: have.fields[key] ?? 0}))
    .filter(({field}) => field >= 0);
  const pieces: Piece[] = [];
  for (let chunk = 0; chunk < table.chunkCount; ++chunk) {
    if (chunk >= have.chunks) pieces.push({chunk, firstPart: kStructurePart, parts: 2});
    for (const {field, here} of wanted)
      if (chunk >= here) pieces.push({chunk, firstPart: kFirstFieldPart + field, parts: 1});
  }
  return pieces;
}

function sizeOf(table: LogTable, {chunk, firstPart, parts}: Piece): number {
  let size = 0;
  for (let part = firstPart; part < firstPart + parts; ++part) size += table.blockSize(chunk, part);
  return size;
}
