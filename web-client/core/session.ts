// One mesh on its way into the page: opens the stream, keeps it going over lost connections,
// refines as far as is wished, and says how it stands.

import {kFirstFieldPart, kStructurePart} from './parts';
import type {Assembler} from './assembler';
import type {CoarseVolume} from './coarse_volume';
import {errorCode, errorText, QtetError} from './errors';
import {scalarRange} from './field_scale';
import {errorOfLevel, kFull, limitReached, type Limit} from './limit';
import {fieldKeys} from './manifest';
import {surfaceBoxesOf} from './surface_boxes';
import type {Frame, OpenRequest, ServerMessage} from './protocol';
import type {Publisher} from './publisher';
import type {LogTable, Transport, TransportHandlers} from './transport';
import {makeTransport} from './transports';
import {kNoViewRequest, type Isovalue, type ViewRequest} from './view_request';
import type {FromWorker, Source, StreamState} from './worker_messages';

/**
 * Payload bytes under way: enough for 80 Mbit/s at 100 ms, and some ten chunks of decoding that a
 * click has to wait for at most.
 */
const kWindowBytes = 1 << 20;
/** Decoding pauses this often for commands from the page. */
const kSliceMs = 25;

/** Decoding waits so long for the first picture: who shows pictures says of what sooner. */
const kFirstPictureMs = 500;

/**
 * Blocks may come by the hundred a second: telling of each costs both threads more than it shows.
 */
const kProgressMs = 100;

/** A view of the protocol has no more (proto/PROTOCOL.md, "View"). */
const kMaxIsovalues = 8;

/** Of the cells at which memory ended: their pictures need some, too. */
const kFittingShare = 0.7;

/** What the codec's sentences leave open: what one sees now, and what to do. */
const kWaysOut: Record<string, string> = {
  'bad-checksum':
    '. What came before is sound and stays on the screen. Try again to fetch the rest anew; if ' +
    'it fails at the same chunk, the file itself is damaged: "qtet verify" says where.',
  'out-of-memory': ' It stays at a level that fits. Close other tabs and try again for more.',
};

export type TransportFactory = (
  source: Source,
  table: LogTable,
  handlers: TransportHandlers,
) => Transport;

export class Session implements TransportHandlers {
  /** Hears of every part of the log. */
  coarse: Pick<CoarseVolume, 'note' | 'forget'> | null = null;
  private transport: Transport | null = null;
  private source: Source = {
    url: '',
    log: '',
    mesh: '',
    fields: null,
    limit: kFull,
    transport: 'auto',
  };
  private state: StreamState = 'connecting';
  private digest = '';
  /** The fields to bring: indexes into the manifest. */
  private fields: number[] = [];
  /** Fields that the current `open` asks for. */
  private requested: string[] = [];
  /** It asks for the head alone. */
  private probing = false;
  private limit: Limit = kFull;
  private paused = false;
  /** Another target was sent since the stream was opened. */
  private aimed = false;
  private view: ViewRequest = kNoViewRequest;
  private receivedBytes = 0;
  /** Bytes that arrived and whose credit waits until they are applied. */
  private unapplied = 0;
  /**
   * Carries a word of this session to itself: the next slice, behind the page's commands. A timer
   * would wait 4 ms each time.
   */
  private slices: MessageChannel | undefined;
  private sliceIsDue = false;
  private sliceIsCalled = false;
  private progressTimer: ReturnType<typeof setTimeout> | undefined;
  private progressAt = -kProgressMs;
  /** When decoding goes on without a first picture; 0: it does not wait yet. */
  private pictureBy = 0;
  private decodedBytes = 0;
  private decodedMs = 0;

  constructor(
    private readonly assembler: Assembler,
    private readonly publisher: Publisher,
    private readonly send: (message: FromWorker) => void,
    private readonly newTransport: TransportFactory = makeTransport,
  ) {
    publisher.onFirst = () => this.advance();
    publisher.untilLast = () => this.untilDecoded();
    publisher.onIsosurface = (positions) => this.lookAtSurface(positions);
  }

  start(source: Source): void {
    this.transport?.disconnect();
    this.source = source;
    this.limit = source.limit;
    this.paused = source.paused === true;
    this.forget();
    this.transport = this.newTransport(source, this.assembler, this);
    if (this.paused) return this.setState('paused');
    this.setState('connecting');
    this.transport.connect();
  }

  /** Bring these fields (indexes into the manifest), whatever was wanted before. */
  want(fields: number[]): void {
    if (
      !this.assembler.manifest ||
      (fields.length === this.fields.length && fields.every((field) => this.fields.includes(field)))
    )
      return;
    this.fields = fields;
    this.source.fields = this.keys();
    this.tellPlan();
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
    const wasPaused = this.paused;
    this.paused = false;
    this.guarded(() => {
      if (this.isHeld()) this.goBack();
      if (this.isHeld()) this.hold();
      else this.goOn(wasPaused);
      this.tellProgress();
    });
  }

  /** What the user looks at. */
  look(view: ViewRequest): void {
    const {surfaceBoxes = null, isovalue = null} = this.view;
    this.view = {...view, surfaceBoxes, isovalue};
    this.follow();
  }

  /** A log of regions refines isosurfaces where they are now, as coarse as they may be. */
  private lookAtSurface(positions: Float32Array): void {
    const {lattice, packets} = this.assembler;
    if (packets.length === 0 || !lattice) return;
    const surfaceBoxes = surfaceBoxesOf(positions, lattice.size);
    const isovalue = this.isovalue();
    if (
      String(surfaceBoxes) === String(this.view.surfaceBoxes ?? null) &&
      JSON.stringify(isovalue) === JSON.stringify(this.view.isovalue ?? null)
    )
      return;
    this.view = {...this.view, surfaceBoxes, isovalue};
    this.follow();
  }

  /** Of the isosurfaces that are shown, for the server; null: it would not understand them. */
  private isovalue(): Isovalue | null {
    const {isosurfaces} = this.publisher.display;
    const fields = this.assembler.manifest?.fields ?? [];
    const info = isosurfaces && fields[isosurfaces.scalar.field];
    if (!info || info.association === 'cell' || isosurfaces.values.length > kMaxIsovalues)
      return null;
    const {field, component} = isosurfaces.scalar;
    const [low, high] = scalarRange(info, component);
    const values = isosurfaces.values.map((share) => low + share * (high - low));
    return {field: fieldKeys(fields)[field]!, ...(component >= 0 && {component}), values};
  }

  private follow(): void {
    if (this.assembler.packets.length === 0) return;
    this.assembler.look(this.view);
    if (!this.paused) this.transport?.look(this.view);
  }

  pause(): void {
    if (!this.transport || this.state === 'complete' || this.state === 'failed' || this.paused)
      return;
    this.paused = true;
    this.transport.pause();
    this.setState('paused');
  }

  /** Goes on after a pause, or tries again after an error. */
  resume(): void {
    if (this.state === 'failed') {
      this.start({...this.source, paused: false});
      return;
    }
    if (!this.paused) return;
    this.paused = false;
    this.goOn(true);
  }

  // ---- TransportHandlers

  connected(): void {
    if (!this.paused) this.open();
  }

  message(message: ServerMessage): void {
    if (message.type === 'opened') this.digest = message.digest;
    if (message.type === 'done') {
      if (!this.isReceived(this.assembler.goal(this.limit, this.fields)?.chunks)) {
        // it may be of the target before, sent as the new one was on its way
        if (this.aimed) return this.open();
        this.failed(
          new QtetError(
            'incomplete',
            'The server says that everything was sent, but parts of the mesh are missing. Try ' +
              'again.',
          ),
        );
        return;
      }
      this.advanceSoon();
    }
    if (message.type !== 'error') return;
    // Another mesh stands under this name now: what was decoded is of no use, so start anew with
    // the new one.
    if (message.code === 'log-changed' && this.digest) {
      this.forget();
      this.open();
      return;
    }
    if (message.code === 'unknown-field' && !this.assembler.manifest) {
      this.send({
        type: 'error',
        code: message.code,
        message: `${message.detail.replace(/\.?$/, '.')} The first field is shown instead.`,
      });
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
      this.coarse?.note(frame);
      this.receivedBytes += frame.payload.length;
      this.unapplied += frame.payload.length;
      if (first && this.takeManifest()) return;
      if (this.state !== 'streaming' && !this.paused && !this.isHeld()) this.setState('streaming');
      this.advanceSoon();
    });
  }

  down(attempt: number, delayMs: number): void {
    if (this.state === 'complete' || this.state === 'held' || this.paused) {
      this.transport?.disconnect(); // nothing is missing; to ask for more connects again
      return;
    }
    this.setState('reconnecting', attempt, delayMs);
  }

  failed(error: QtetError): void {
    this.sliceIsDue = false;
    this.transport?.disconnect();
    this.send({type: 'error', code: error.code, message: error.message});
    this.setState('failed');
  }

  // ---- decoding

  /** Applies what is here, in slices, so that the page's commands come between. */
  private advance(): void {
    this.sliceIsDue = false;
    this.guarded(() => {
      const start = performance.now();
      const until = start + kSliceMs;
      const {bytes} = this.assembler.statistics(this.fields);
      let applied = false;
      while (!this.awaitsPicture() && this.assembler.step(this.fields, !this.isHeld())) {
        applied = true;
        if (performance.now() < until) continue;
        this.callSlice();
        break;
      }
      if (applied) {
        this.decodedMs += performance.now() - start;
        this.decodedBytes += this.assembler.statistics(this.fields).bytes - bytes;
        this.publisher.changed(this.isComplete());
      }
      this.tellProgress();
      if (this.isComplete()) this.complete();
      else if (this.isHeld()) this.hold();
      else this.giveCredit();
    });
  }

  /** At the pace so far, once everything is here; Infinity before. */
  private untilDecoded(): number {
    if (this.limit.kind !== 'full' || this.decodedBytes === 0 || !this.isReceived())
      return Infinity;
    const {bytes, bytesNeeded} = this.assembler.statistics(this.fields);
    return ((bytesNeeded - bytes) * this.decodedMs) / this.decodedBytes;
  }

  /**
   * Frames come in crowds: were each to take a slice, the page's commands and the pictures would
   * wait for all of them.
   */
  private advanceSoon(): void {
    if (!this.sliceIsDue) this.advance();
  }

  private callSlice(): void {
    this.sliceIsDue = true;
    if (!this.slices) {
      this.slices = new MessageChannel();
      this.slices.port1.onmessage = () => {
        this.sliceIsCalled = false;
        if (this.sliceIsDue) this.advance();
      };
    }
    if (!this.sliceIsCalled) this.slices.port2.postMessage(null);
    this.sliceIsCalled = true;
  }

  /** The first mesh that there is goes to the page before anything finer is decoded. */
  private awaitsPicture(): boolean {
    const {codec} = this.assembler;
    if (!this.source.pictureFirst || this.publisher.hasPublished || codec.chunksApplied === 0)
      return false;
    if (this.fields.some((field) => codec.fieldChunksApplied(field) === 0)) return false;
    const now = performance.now();
    if (this.pictureBy === 0) {
      this.pictureBy = now + kFirstPictureMs;
      setTimeout(() => this.advance(), kFirstPictureMs);
    }
    return now < this.pictureBy;
  }

  /** From the empty mesh to the limit, at once: no picture of the way is shown. */
  private goBack(): void {
    this.assembler.rewind();
    while (this.assembler.step(this.fields, !this.isHeld())) continue;
    this.publisher.changed(true);
  }

  private isHeld(): boolean {
    const {codec, manifest} = this.assembler;
    if (this.limit.kind === 'full' || !manifest || codec.chunksApplied === 0) return false;
    const statistics = this.assembler.statistics(this.fields);
    return limitReached(
      this.limit,
      statistics,
      errorOfLevel(manifest.levels[statistics.level], this.fields),
    );
  }

  private hold(): void {
    if (this.state === 'held' || this.paused) return;
    this.publisher.changed(true);
    this.setState('held');
  }

  /** After a pause or a limit: what is here first, then the network. */
  private goOn(wasPaused: boolean): void {
    this.state = 'streaming';
    this.advance();
    if (this.isComplete() || this.isHeld()) return;
    if (this.isReceived()) return this.setState('streaming');
    const {transport} = this;
    // The stream of before serves as long as it brings the fields of now.
    if (!transport?.isConnected || !this.keys().every((key) => this.requested.includes(key)))
      return this.reopen();
    this.setState('streaming');
    this.aimed = true;
    transport.aim(this.assembler.goal(this.limit, this.fields));
    if (wasPaused && !transport.resume()) this.open();
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

  /**
   * Begins anew in a fresh codec and ends with room to spare. False when not even the base mesh
   * fits.
   */
  private stayAtWhatFits(): boolean {
    const {tetrahedra} = this.assembler.statistics(this.fields);
    if (tetrahedra === 0) return false;
    this.sliceIsDue = false;
    this.transport?.disconnect();
    this.limit = this.source.limit = {
      kind: 'cells',
      value: Math.max(1, Math.floor(kFittingShare * tetrahedra)),
    };
    this.guarded(() => {
      this.assembler.codec.restart();
      this.goBack();
      this.send({
        type: 'error',
        code: 'out-of-memory',
        message:
          'The whole mesh needs more memory than the browser gives to a ' +
          `page.${kWaysOut['out-of-memory']}`,
      });
      this.tellProgress();
      this.hold();
    });
    return true;
  }

  private forget(): void {
    this.sliceIsDue = false;
    this.digest = '';
    this.view = {...this.view, surfaceBoxes: null, isovalue: null};
    this.fields = [];
    this.requested = [];
    this.receivedBytes = this.unapplied = this.pictureBy = this.decodedBytes = this.decodedMs = 0;
    this.assembler.forget();
    this.coarse?.forget();
    this.publisher.reset();
  }

  /** Before the head is here nobody knows more than the names that were given. */
  private keys(): string[] {
    const {manifest} = this.assembler;
    if (!manifest) return this.source.fields ?? [];
    const keys = fieldKeys(manifest.fields);
    return this.fields.map((field) => keys[field]!);
  }

  /**
   * Only the head tells which fields there are: when the right ones were not asked for, ask again.
   * True when it did.
   */
  private takeManifest(): boolean {
    const manifest = this.assembler.manifest!;
    const keys = fieldKeys(manifest.fields);
    this.fields = (this.source.fields ?? [])
      .map((name) => keys.indexOf(name))
      .filter((field) => field >= 0);
    const unknown = this.source.fields?.find((name) => !keys.includes(name));
    if (unknown !== undefined)
      this.send({
        type: 'error',
        code: 'unknown-field',
        message: `The mesh has no field "${unknown}". The first one is shown instead.`,
      });
    if (
      this.fields.length === 0 &&
      keys.length > 0 &&
      (this.source.fields === null || unknown !== undefined)
    )
      this.fields = [0];
    this.assembler.look(this.view);
    this.send({type: 'manifest', manifest, digest: this.digest, fields: this.fields});
    this.tellPlan();
    if (!this.probing && this.keys().every((key) => this.requested.includes(key))) return false;
    this.open();
    return true;
  }

  private open(): void {
    const {manifest} = this.assembler;
    const asked = this.keys();
    // While it is unknown which fields there are, or where a limit lies, one byte of credit buys
    // the head and nothing that another `open` would waste.
    this.probing = !manifest && (this.source.fields === null || this.limit.kind !== 'full');
    this.requested = asked.filter((name) => name !== '');
    this.unapplied = 0;
    this.aimed = false;
    this.transport?.open({
      mesh: this.source.mesh,
      fields: this.requested,
      credit: this.probing ? 1 : kWindowBytes,
      have: this.have(asked),
      view: this.view,
      goal: this.assembler.goal(this.limit, this.fields),
      ...(this.digest ? {digest: this.digest} : {}),
    });
  }

  private have(keys: string[]): OpenRequest['have'] {
    const {assembler} = this;
    if (!assembler.manifest) return {chunks: 0, fields: {}};
    const chunks = assembler.receivedChunks;
    const fields = this.fields.map((field, i) => {
      const count = assembler.receivedOfField(field);
      const ranges =
        assembler.packets.length > 0 ? assembler.rangesBeyond(count, kFirstFieldPart + field) : [];
      return [keys[i]!, ranges.length > 0 ? {chunks: count, ranges} : count] as const;
    });
    const ranges =
      assembler.packets.length > 0 ? assembler.rangesBeyond(chunks, kStructurePart) : [];
    return {chunks, ...(ranges.length > 0 ? {ranges} : {}), fields: Object.fromEntries(fields)};
  }

  /** Opens on the connection there is, or makes one. */
  private reopen(): void {
    this.setState(this.transport?.isConnected ? 'streaming' : 'connecting');
    if (this.transport?.isConnected) this.open();
    else this.transport?.connect();
  }

  private giveCredit(): void {
    if (this.paused) return;
    if (this.unapplied > 0) this.transport?.applied(this.unapplied);
    this.unapplied = 0;
  }

  /** The leading chunks, all by default, with the fields. */
  private isReceived(chunks = this.assembler.codec.chunkCount): boolean {
    const {assembler} = this;
    return (
      assembler.manifest !== null &&
      assembler.receivedChunks >= chunks &&
      this.fields.every((field) => assembler.receivedOfField(field) >= chunks)
    );
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

  private tellPlan(): void {
    this.send({type: 'plan', plan: this.assembler.plan(this.fields)});
  }

  /**
   * As often as a page can show it; the last word of a burst comes late, and before any other
   * state.
   */
  private tellProgress(): void {
    this.progressTimer ??= setTimeout(
      () => this.sendProgress(),
      Math.max(0, this.progressAt + kProgressMs - performance.now()),
    );
  }

  private sendProgress(): void {
    clearTimeout(this.progressTimer);
    this.progressTimer = undefined;
    this.progressAt = performance.now();
    this.send({
      type: 'progress',
      statistics: this.assembler.statistics(this.fields),
      received: this.receivedBytes,
    });
  }

  private setState(state: StreamState, attempt = 0, delayMs = 0): void {
    this.state = state;
    if (this.progressTimer !== undefined) this.sendProgress();
    this.send({type: 'state', state, attempt, delayMs});
  }
}
