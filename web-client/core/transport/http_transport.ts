// A log over plain HTTP. A few requests run at a time. Blocks are delivered in order, as the frames
// of proto/STREAM.md, and within the credit.

import {errorCode, errorText, QtetError} from '../protocol/errors';
import type {LogTable} from '../protocol/log_table';
import type {OpenRequest, Target} from '../protocol/messages';
import {kFirstFieldPart, kHeadPart, kStructurePart} from '../protocol/parts';
import {reconnectDelayMs} from './backoff';
import type {BlockSource, Piece} from './block_source';
import type {Transport, TransportHandlers} from './transport';

/**
 * How many requests run at a time. Browsers open six connections to a host over HTTP/1.1, and
 * others want some of them.
 */
const kAhead = 3;
/**
 * A request asks for what the line brings in so many seconds, within the bounds below. Requests are
 * few, and progress is steady.
 */
const kRequestSeconds = 0.4;
const kMinBytes = 32 << 10;
const kMaxBytes = 512 << 10;

export class HttpTransport implements Transport {
  isConnected = false;
  private stream = 0;
  private credit = 0;
  private target: Target | null = null;
  /** The pieces that remain to be fetched, in this order. */
  private pieces: Piece[] = [];
  private attempt = 0;
  private source: BlockSource;
  private abort = new AbortController();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private creditCame: () => void = () => undefined;
  private requestBytes = kMinBytes;
  private arrived = {at: 0, bytes: 0};

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
    this.credit = request.credit;
    this.target = request.target ?? null;
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
    this.target = target;
    this.creditCame();
  }

  applied(bytes: number): void {
    this.credit += bytes;
    this.creditCame();
  }

  disconnect(): void {
    clearTimeout(this.timer);
    this.stop();
    this.isConnected = false;
  }

  private async run(stream: number, request: OpenRequest, signal: AbortSignal): Promise<void> {
    const deliver = (piece: Piece, payload: Uint8Array): void => {
      this.credit -= payload.length;
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
    this.pieces = piecesOf(this.table, request);
    await this.fetchAll(deliver, signal);
    if (!isOver()) this.handlers.message({type: 'done', stream});
  }

  private async fetchAll(
    deliver: (piece: Piece, payload: Uint8Array) => void,
    signal: AbortSignal,
  ): Promise<void> {
    const ahead: {pieces: Piece[]; size: number; payloads: Promise<Uint8Array[]>}[] = [];
    const isOver = (): boolean => signal.aborted;
    let underWay = 0;
    for (;;) {
      for (
        let near = this.wantedNext();
        near.length > 0 && ahead.length < kAhead && underWay < this.credit;
        near = this.wantedNext()
      ) {
        const wanted = this.pieces.splice(0, this.source.together(near, this.requestBytes));
        const payloads = this.source.fetch(wanted, signal);
        payloads.catch(() => undefined); // awaited below, in its turn
        const size = wanted.reduce((sum, piece) => sum + sizeOf(this.table, piece), 0);
        ahead.push({pieces: wanted, size, payloads});
        underWay += size;
      }
      const next = ahead.shift();
      if (!next && this.pieces.length === 0) return;
      if (!next) await new Promise<void>((resolve) => void (this.creditCame = resolve));
      if (isOver()) return;
      if (!next) continue;
      const payloads = await next.payloads;
      underWay -= next.size;
      this.measure(next.size);
      for (const [i, piece] of next.pieces.entries()) if (!isOver()) deliver(piece, payloads[i]!);
    }
  }

  /** The next pieces before the target. */
  private wantedNext(): Piece[] {
    const near = this.pieces.slice(0, kMaxPieces);
    const {target} = this;
    return target ? near.filter(({chunk}) => chunk < target.chunks) : near;
  }

  /** Adapts the size of requests to the line. */
  private measure(bytes: number): void {
    const now = performance.now();
    const seconds = (now - this.arrived.at) / 1000;
    if (this.arrived.at > 0 && seconds > 0) {
      const fitting = (bytes / seconds) * kRequestSeconds;
      this.requestBytes = Math.min(
        kMaxBytes,
        Math.max(kMinBytes, (this.requestBytes + fitting) / 2),
      );
    }
    this.arrived = {at: now, bytes};
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
