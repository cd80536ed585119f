// One mesh on its way into the page: opens the stream, keeps it going over lost connections, refines as far as is wished, and says how it stands.

import type {Assembler} from './assembler';
import {errorCode, errorText, QtetError} from './errors';
import {errorOfLevel, kFull, limitReached, type Limit} from './limit';
import {fieldKeys} from './manifest';
import {kFirstFieldPart, kStructurePart, type Frame, type OpenRequest, type ServerMessage} from './protocol';
import type {Publisher} from './publisher';
import type {LogTable, Transport, TransportHandlers} from './transport';
import {makeTransport} from './transports';
import {kNoWishes, type Wishes} from './wishes';
import type {FromWorker, Source, StreamState} from './worker_messages';

/** Payload bytes under way: enough for 80 Mbit/s at 100 ms, and some ten chunks of decoding that a click has to wait for at most. */
const kWindowBytes = 1 << 20;
/** Decoding pauses this often for commands from the page. */
const kSliceMs = 25;

/** Of the cells at which memory ended: their pictures need some, too. */
const kFittingShare = 0.7;

/** What the codec's sentences leave open: what one sees now, and what to do. */
const kWaysOut: Record<string, string> = {
  'bad-checksum': '. What came before is sound and stays on the screen. Try again to fetch the rest anew; if it fails at the same chunk, the file itself is damaged: "qtet verify" says where.',
  'out-of-memory': ' It stays at a level that fits. Close other tabs and try again for more.',
};

export type TransportFactory = (source: Source, table: LogTable, handlers: TransportHandlers) => Transport;

export class Session implements TransportHandlers {
  private transport: Transport | null = null;
  private source: Source = {url: '', log: '', mesh: '', fields: null, limit: kFull, transport: 'auto'};
  private state: StreamState = 'connecting';
  private digest = '';
  /** The fields to bring: indexes into the manifest. */
  private fields: number[] = [];
  /** Fields that the current `open` asks for. */
  private requested: string[] = [];
  private limit: Limit = kFull;
  private paused = false;
  private wishes: Wishes = kNoWishes;
  private receivedBytes = 0;
  /** Bytes that arrived and whose credit waits until they are applied. */
  private unapplied = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly assembler: Assembler, private readonly publisher: Publisher, private readonly send: (message: FromWorker) => void,
    private readonly newTransport: TransportFactory = makeTransport) {}

  start(source: Source): void {
    this.transport?.disconnect();
    this.source = source;
    this.limit = source.limit;
    this.paused = false;
    this.forget();
    this.transport = this.newTransport(source, this.assembler, this);
    this.setState('connecting');
    this.transport.connect();
  }

  /** Bring these fields (indexes into the manifest), whatever was wanted before. */
  want(fields: number[]): void {
    if (!this.assembler.manifest || (fields.length === this.fields.length && fields.every((field) => this.fields.includes(field)))) return;
    this.fields = fields;
    this.source.fields = this.keys();
    this.tellProgress();
    if (this.state === 'failed') return;
    this.advance();
    if (this.paused || this.isComplete()) return;
    if (!this.isReceived()) this.reopen();
  }

  /** Refine so far, and no farther; coarser than now goes back. */
  setLimit(limit: Limit): void {
    this.limit = this.source.limit = limit;
    if (!this.assembler.manifest || this.state === 'failed') return;
    this.guarded(() => {
      if (this.isHeld()) this.goBack();
      this.publisher.changed();
      if (!this.isHeld()) this.goOn();
      else this.hold();
      this.tellProgress();
    });
  }

  /** What the user looks at. */
  look(wishes: Wishes): void {
    this.wishes = wishes;
    if (this.assembler.packets.length === 0) return;
    this.assembler.look(wishes);
    if (!this.paused) this.transport?.look(wishes);
  }

  pause(): void {
    if (this.state === 'complete' || this.state === 'failed' || this.paused) return;
    this.paused = true;
    this.transport?.stop();
    this.setState('paused');
  }

  /** Goes on after a pause, or tries again after an error. */
  resume(): void {
    if (this.state === 'failed') {
      this.start(this.source);
      return;
    }
    if (!this.paused) return;
    this.paused = false;
    this.goOn();
  }

  // ---- TransportHandlers

  connected(): void {
    if (!this.paused) this.open();
  }

  message(message: ServerMessage): void {
    if (message.type === 'opened') this.digest = message.digest;
    if (message.type === 'done') {
      if (!this.isReceived()) {
        this.failed(new QtetError('incomplete', 'The server says that everything was sent, but parts of the mesh are missing. Try again.'));
        return;
      }
      this.advance();
    }
    if (message.type !== 'error') return;
    // Another mesh stands under this name now: what was decoded is of no use, so start anew with the new one.
    if (message.code === 'log-changed' && this.digest) {
      this.forget();
      this.open();
      return;
    }
    if (message.code === 'unknown-field' && !this.assembler.manifest) {
      this.send({type: 'error', code: message.code, message: `${message.detail} The first field is shown instead.`});
      this.source.fields = null;
      this.open();
      return;
    }
    this.failed(new QtetError(message.code, message.detail));
  }

  frame(frame: Frame): void {
    this.guarded(() => {
      const first = !this.assembler.manifest;
      this.assembler.take(frame);
      this.receivedBytes += frame.payload.length;
      this.unapplied += frame.payload.length;
      if (first && this.takeManifest()) return;
      if (this.state !== 'streaming' && !this.paused && !this.isHeld()) this.setState('streaming');
      this.advance();
    });
  }

  down(attempt: number, delayMs: number): void {
    if (this.state === 'complete' || this.state === 'held' || this.paused) {
      this.transport?.disconnect();  // nothing is missing; a wish for more connects again
      return;
    }
    this.setState('reconnecting', attempt, delayMs);
  }

  failed(error: QtetError): void {
    clearTimeout(this.timer);
    this.transport?.disconnect();
    this.send({type: 'error', code: error.code, message: error.message});
    this.setState('failed');
  }

  // ---- decoding

  /** Applies what is here, in slices, so that the page's commands come between. */
  private advance(): void {
    clearTimeout(this.timer);
    this.guarded(() => {
      const until = performance.now() + kSliceMs;
      let applied = false;
      while (this.assembler.step(this.fields, !this.isHeld())) {
        applied = true;
        if (performance.now() < until) continue;
        this.timer = setTimeout(() => this.advance(), 0);
        break;
      }
      if (applied) this.publisher.changed();
      this.tellProgress();
      if (this.isComplete()) this.complete();
      else if (this.isHeld()) this.hold();
      else this.giveCredit();
    });
  }

  /** From the empty mesh to the limit, at once: no picture of the way is shown. */
  private goBack(): void {
    this.assembler.rewind();
    while (this.assembler.step(this.fields, !this.isHeld())) continue;
  }

  private isHeld(): boolean {
    const {codec, manifest} = this.assembler;
    if (this.limit.kind === 'full' || !manifest || codec.chunksApplied === 0) return false;
    const statistics = this.assembler.statistics(this.fields);
    return limitReached(this.limit, statistics, errorOfLevel(manifest.levels[statistics.level], this.fields));
  }

  private hold(): void {
    if (this.state === 'held' || this.paused) return;
    this.publisher.changed();
    this.setState('held');
  }

  /** After a pause or a limit: what is here first, then the network. */
  private goOn(): void {
    this.state = 'streaming';
    this.advance();
    if (this.isComplete() || this.isHeld()) return;
    if (this.isReceived()) this.setState('streaming');
    else this.reopen();
  }

  // ---- helpers

  private guarded(action: () => void): void {
    try {
      action();
    } catch (thrown) {
      const code = errorCode(thrown);
      if (code === 'out-of-memory' && this.stayAtWhatFits()) return;
      this.failed(new QtetError(code, `${errorText(thrown)}${kWaysOut[code] ?? ''}`));
    }
  }

  /** Begins anew in a fresh codec and ends with room to spare. False when not even the base mesh fits. */
  private stayAtWhatFits(): boolean {
    const {tetrahedra} = this.assembler.statistics(this.fields);
    if (tetrahedra === 0) return false;
    clearTimeout(this.timer);
    this.transport?.disconnect();
    this.limit = this.source.limit = {kind: 'cells', value: Math.max(1, Math.floor(kFittingShare * tetrahedra))};
    this.guarded(() => {
      this.assembler.codec.restart();
      this.goBack();
      this.send({type: 'error', code: 'out-of-memory', message: `The whole mesh needs more memory than the browser gives to a page.${kWaysOut['out-of-memory']}`});
      this.tellProgress();
      this.hold();
    });
    return true;
  }

  private forget(): void {
    clearTimeout(this.timer);
    this.digest = '';
    this.fields = [];
    this.requested = [];
    this.receivedBytes = this.unapplied = 0;
    this.assembler.forget();
    this.publisher.reset();
  }

  private keys(): string[] {
    const keys = fieldKeys(this.assembler.manifest!.fields);
    return this.fields.map((field) => keys[field]!);
  }

  /** Only the head tells which fields there are: when the right ones were not asked for, ask again. True when it did. */
  private takeManifest(): boolean {
    const manifest = this.assembler.manifest!;
    const keys = fieldKeys(manifest.fields);
    this.fields = (this.source.fields ?? []).map((name) => keys.indexOf(name)).filter((field) => field >= 0);
    const unknown = this.source.fields?.find((name) => !keys.includes(name));
    if (unknown !== undefined) this.send({type: 'error', code: 'unknown-field', message: `The mesh has no field "${unknown}". The first one is shown instead.`});
    if (this.fields.length === 0 && keys.length > 0 && (this.source.fields === null || unknown !== undefined)) this.fields = [0];
    this.assembler.look(this.wishes);
    this.send({type: 'manifest', manifest, digest: this.digest, fields: this.fields});
    if (this.source.fields !== null && this.keys().every((key) => this.requested.includes(key))) return false;
    this.open();
    return true;
  }

  private open(): void {
    const {manifest} = this.assembler;
    const asked = manifest ? this.keys() : this.source.fields ?? [];
    // While it is unknown which fields there are, one byte of credit buys the head and nothing that another `open` would waste.
    const probing = !manifest && this.source.fields === null;
    this.requested = asked.filter((name) => name !== '');
    this.unapplied = 0;
    this.transport?.open({
      mesh: this.source.mesh, fields: this.requested, credit: probing ? 1 : kWindowBytes,
      have: this.have(asked), wishes: this.wishes,
      ...(this.digest ? {digest: this.digest} : {}),
    });
  }

  private have(keys: string[]): OpenRequest['have'] {
    const {assembler} = this;
    if (!assembler.manifest) return {chunks: 0, fields: {}};
    const chunks = assembler.receivedChunks;
    const fields = this.fields.map((field, i) => {
      const count = assembler.receivedOfField(field);
      const ranges = assembler.packets.length > 0 ? assembler.rangesBeyond(count, kFirstFieldPart + field) : [];
      return [keys[i]!, ranges.length > 0 ? {chunks: count, ranges} : count] as const;
    });
    const ranges = assembler.packets.length > 0 ? assembler.rangesBeyond(chunks, kStructurePart) : [];
    return {chunks, ...(ranges.length > 0 ? {ranges} : {}), fields: Object.fromEntries(fields)};
  }

  /** Opens on the connection there is, or makes one. */
  private reopen(): void {
    this.setState(this.transport?.isConnected ? 'streaming' : 'connecting');
    if (this.transport?.isConnected) this.open();
    else this.transport?.connect();
  }

  private giveCredit(): void {
    if (this.unapplied > 0 && !this.paused) this.transport?.applied(this.unapplied);
    this.unapplied = 0;
  }

  private isReceived(): boolean {
    const {codec, manifest} = this.assembler;
    if (!manifest || this.assembler.receivedChunks < codec.chunkCount) return false;
    return this.fields.every((field) => this.assembler.receivedOfField(field) === codec.chunkCount);
  }

  private isComplete(): boolean {
    const {codec, manifest} = this.assembler;
    if (!manifest || codec.chunksApplied < codec.chunkCount) return false;
    return this.fields.every((field) => codec.fieldChunksApplied(field) === codec.chunkCount);
  }

  private complete(): void {
    this.paused = false;
    if (this.state !== 'complete') this.setState('complete');
  }

  private tellProgress(): void {
    this.send({type: 'progress', statistics: this.assembler.statistics(this.fields), received: this.receivedBytes});
  }

  private setState(state: StreamState, attempt = 0, delayMs = 0): void {
    this.state = state;
    this.send({type: 'state', state, attempt, delayMs});
  }
}
