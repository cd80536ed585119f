// One mesh on its way into the page: opens the stream, keeps it going over lost connections, and says how it stands.

import type {Assembler} from './assembler';
import {errorCode, errorText, QtetError} from './errors';
import type {Frame, ServerMessage} from './protocol';
import type {Publisher} from './publisher';
import {Transport, type TransportHandlers} from './transport';
import type {FromWorker, Source, StreamState} from './worker_messages';

/** Payload bytes under way: enough for 80 Mbit/s at 100 ms, and some ten chunks of decoding that a click has to wait for at most. */
const kWindowBytes = 1 << 20;

export type TransportFactory = (url: string, handlers: TransportHandlers) => Transport;

export class Session implements TransportHandlers {
  private transport: Transport | null = null;
  private source: Source = {url: '', mesh: '', field: null, pauseAfter: 0};
  private state: StreamState = 'connecting';
  private digest = '';
  /** The field to show: an index into the manifest, -1 none. */
  private field = -1;
  /** Fields that the current `open` asks for. */
  private requested: string[] = [];
  /** Bytes of credit that may still be granted, and that may still arrive, before the pause; Infinity without one. */
  private grantable = Infinity;
  private untilPause = Infinity;
  private paused = false;

  constructor(
    private readonly assembler: Assembler, private readonly publisher: Publisher, private readonly send: (message: FromWorker) => void,
    private readonly makeTransport: TransportFactory = (url, handlers) => new Transport(url, handlers)) {}

  start(source: Source): void {
    this.transport?.disconnect();
    this.source = source;
    this.grantable = this.untilPause = source.pauseAfter > 0 ? source.pauseAfter : Infinity;
    this.paused = false;
    this.forget();
    this.transport = this.makeTransport(source.url, this);
    this.setState('connecting');
    this.transport.connect();
  }

  showField(name: string): void {
    this.source.field = name;
    if (!this.assembler.manifest) return;
    this.chooseField();
    this.send({type: 'progress', statistics: this.statistics()});
    if (this.paused || this.state === 'failed') return;
    if (this.isComplete()) this.finish();
    else this.reopen();
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
      this.start({...this.source, pauseAfter: 0});
      return;
    }
    if (!this.paused) return;
    this.paused = false;
    this.grantable = this.untilPause = Infinity;
    this.reopen();
  }

  // ---- TransportHandlers

  connected(): void {
    if (!this.paused) this.open();
  }

  message(message: ServerMessage): void {
    if (message.type === 'opened') this.digest = message.digest;
    if (message.type === 'done') this.finish();
    if (message.type !== 'error') return;
    // Another mesh stands under this name now: what was decoded is of no use, so start anew with the new one.
    if (message.code === 'log-changed' && this.digest) {
      this.forget();
      this.open();
      return;
    }
    if (message.code === 'unknown-field' && !this.assembler.manifest) {
      this.send({type: 'error', code: message.code, message: `${message.detail} The first field is shown instead.`});
      this.source.field = null;
      this.open();
      return;
    }
    this.failed(new QtetError(message.code, message.detail));
  }

  frame(frame: Frame): void {
    try {
      const first = !this.assembler.manifest;
      this.assembler.take(frame);
      if (first) {
        this.send({type: 'manifest', manifest: this.assembler.manifest!, digest: this.digest});
        if (this.openFirstField()) return;
      } else {
        this.publisher.changed();
      }
      if (this.state !== 'streaming' && !this.paused) this.setState('streaming');
      this.send({type: 'progress', statistics: this.statistics()});
      this.giveBack(frame.payload.length);
    } catch (thrown) {
      this.failed(new QtetError(errorCode(thrown), errorText(thrown)));
    }
  }

  down(attempt: number, delayMs: number): void {
    this.assembler.dropWaiting();
    if (this.state === 'complete' || this.paused) {
      this.transport?.disconnect();  // nothing is missing; a wish for more connects again
      return;
    }
    this.setState('reconnecting', attempt, delayMs);
  }

  failed(error: QtetError): void {
    this.transport?.disconnect();
    this.send({type: 'error', code: error.code, message: error.message});
    this.setState('failed');
  }

  // ---- helpers

  private forget(): void {
    this.digest = '';
    this.field = -1;
    this.requested = [];
    this.assembler.manifest = null;
    this.assembler.dropWaiting();
    this.publisher.reset();
  }

  private chooseField(): void {
    const fields = this.assembler.manifest!.fields;
    const usable = fields.findIndex((field) => field.association === 'point');
    const named = fields.findIndex((field) => field.association === 'point' && field.name === this.source.field);
    this.field = named >= 0 ? named : usable;
    this.publisher.show(this.field);
  }

  /** Only the head tells which fields there are: when the right one was not asked for, ask again. True when it did. */
  private openFirstField(): boolean {
    this.chooseField();
    const name = this.assembler.manifest!.fields[this.field]?.name;
    if (this.source.field !== null && (name === undefined || this.requested.includes(name))) return false;
    this.open();
    return true;
  }

  private open(): void {
    const {codec, manifest} = this.assembler;
    const name = manifest ? manifest.fields[this.field]?.name : undefined;
    // While it is unknown which fields there are, one byte of credit buys the head and nothing that another `open` would waste.
    const probing = !manifest && this.source.field === null;
    this.requested = name !== undefined ? [name] : !manifest && this.source.field ? [this.source.field] : [];
    this.assembler.dropWaiting();
    const credit = probing ? 1 : Math.min(kWindowBytes, this.grantable);
    this.grantable -= credit;
    this.transport?.open({
      mesh: this.source.mesh, fields: this.requested, credit,
      have: {
        chunks: manifest ? codec.chunksApplied : 0,
        fields: name === undefined ? {} : {[name]: codec.fieldChunksApplied(this.field)},
      },
      ...(this.digest ? {digest: this.digest} : {}),
    });
  }

  /** Opens on the connection there is, or makes one. */
  private reopen(): void {
    this.setState(this.transport?.isConnected ? 'streaming' : 'connecting');
    if (this.transport?.isConnected) this.open();
    else this.transport?.connect();
  }

  private giveBack(bytes: number): void {
    const granted = Math.min(bytes, this.grantable);
    this.grantable -= granted;
    this.untilPause -= bytes;
    if (granted > 0) this.transport?.applied(granted);
    if (this.untilPause <= 0 && !this.isComplete()) this.pause();
  }

  private finish(): void {
    if (!this.isComplete()) {
      this.failed(new QtetError('incomplete', 'The server says that everything was sent, but parts of the mesh are missing.'));
      return;
    }
    this.publisher.changed();
    this.send({type: 'progress', statistics: this.statistics()});
    this.setState('complete');
  }

  private isComplete(): boolean {
    const {codec, manifest} = this.assembler;
    if (!manifest || codec.chunksApplied < codec.chunkCount) return false;
    return this.field < 0 || codec.fieldChunksApplied(this.field) === codec.chunkCount;
  }

  private statistics() {
    return this.assembler.statistics(this.field);
  }

  private setState(state: StreamState, attempt = 0, delayMs = 0): void {
    this.state = state;
    this.send({type: 'state', state, attempt, delayMs});
  }
}
