// Brings one mesh into the page. It opens the stream, keeps it going over lost connections, refines
// as far as is asked for, and reports its state.

import type {Assembler} from '../decode/assembler';
import {QtetError} from '../protocol/errors';
import type {Limit} from '../protocol/limit';
import type {LogTable} from '../protocol/log_table';
import type {Frame, ServerMessage} from '../protocol/messages';
import {kFirstFieldPart, kHeadPart} from '../protocol/parts';
import type {Transport, TransportHandlers} from '../transport/transport';
import {makeTransport} from '../transport/transports';
import type {CoarseVolume} from './coarse_volume';
import {Decoding} from './decoding';
import {Gate} from './gate';
import {LaterPart} from './later_part';
import {LogStream} from './log_stream';
import type {Publisher} from './publisher';
import {Recovery} from './recovery';
import {Reports} from './reports';
import {Progress, RequestedPart} from './requested_part';
import {canPause, isAtRest, stateMessage, type SessionState} from './session_state';
import {Throttle} from './throttle';
import type {FromWorker, Source} from './worker_messages';

/** Between two openings for other wishes. A server refuses more than 50 a second (STREAM.md). */
const kReopenMs = 100;
export type TransportFactory = (
  source: Source,
  table: LogTable,
  handlers: TransportHandlers,
) => Transport;

export class Session implements TransportHandlers {
  /** Receives every frame of the log. */
  coarse: Pick<CoarseVolume, 'note' | 'noteLater' | 'forget'> | null = null;
  private state: SessionState = {name: 'connecting'};
  /** Closed before the codec is here. */
  private readonly gate = new Gate();
  readonly stream: LogStream;
  readonly requested: RequestedPart;
  readonly decoding: Decoding;
  readonly reports: Reports;
  readonly recovery = new Recovery(this);
  private readonly later = new LaterPart(this, () => {
    if (!this.takeManifest()) this.stream.open(this.requested);
  });
  private readonly reopening = new Throttle(() => this.bring(), kReopenMs);

  constructor(
    readonly assembler: Assembler,
    readonly publisher: Publisher,
    send: (message: FromWorker) => void,
    newTransport: TransportFactory = makeTransport,
  ) {
    this.stream = new LogStream((source) => newTransport(source, assembler, this));
    this.requested = new RequestedPart(assembler);
    this.decoding = new Decoding(
      assembler,
      this.requested,
      () => this.advance(),
      (thrown) => this.recovery.aheadFailed(thrown),
    );
    this.reports = new Reports(assembler, this.requested, this.stream, send);
    publisher.onFirst = () => this.advance();
    publisher.pace.untilLast = () => this.decoding.msLeft;
  }

  /** Messages and frames wait until the assembler is ready. */
  waitForCodec(): void {
    this.gate.closeUntil(this.assembler.codecReady); // whoever loads it reports a failure
  }

  start(source: Source): void {
    this.stream.disconnect();
    this.forget();
    this.assembler.leastInstants = source.isSegment ? 1 : 2;
    this.requested.begin(source);
    this.stream.use(source);
    if (source.paused) return this.enter({name: 'paused'});
    this.enter({name: 'connecting'});
    this.stream.connect();
  }

  /** Brings these fields (indexes into the manifest) instead of the previous ones. */
  want(fields: readonly number[], ahead: readonly number[] = []): void {
    if (!this.assembler.manifest) return;
    this.requested.changeAhead(ahead);
    if (this.requested.changeFields(fields)) {
      this.reports.plan();
      this.reports.progress.changed();
    }
    if (this.state.name === 'failed') return;
    this.decoding.soon();
    this.bring();
  }

  /** Refines up to this limit. A coarser limit goes back. */
  setLimit(limit: Limit): void {
    this.requested.limit = limit;
    if (!this.assembler.manifest || this.state.name === 'failed') return;
    this.endPause();
    this.recovery.guarded(() => {
      if (this.requested.isReached) {
        this.decoding.goBack();
        this.publisher.changed(true); // no picture on the way
      }
      this.goOn();
      this.reports.progress.changed();
    });
  }

  /** The codec has become a whole one: decoding goes on from the base mesh. */
  renewed(): void {
    if (!this.assembler.manifest) return;
    this.recovery.guarded(() => this.assembler.renew(this.requested.fields));
    this.advance();
  }

  pause(): void {
    if (canPause(this.state) && this.stream.pause()) this.enter({name: 'paused'});
  }

  /** Continues after a pause, or tries again after an error. */
  resume(): void {
    const {names, limit} = this.requested;
    if (this.state.name === 'failed')
      this.start({...this.stream.source, fields: names, limit, paused: false});
    else if (this.endPause()) this.goOn();
  }

  // ---- TransportHandlers

  connected(): void {
    if (this.state.name !== 'paused') this.stream.open(this.requested);
  }

  message(message: ServerMessage): void {
    this.gate.pass(() => this.heed(message));
  }

  frame(frame: Frame): void {
    this.gate.pass(() => this.take(frame));
  }

  private heed(message: ServerMessage): void {
    switch (message.type) {
      case 'opened':
        this.stream.digest = message.digest;
        return;
      case 'done':
        return this.later.isAwaited ? undefined : this.done();
      case 'error':
        return this.refused(message);
      case 'stopped':
        return;
    }
  }

  private take(frame: Frame): void {
    if (this.later.isAwaited) return; // its fields are not known; another stream brings them
    const isFirst = !this.assembler.manifest;
    try {
      this.assembler.take(frame);
    } catch (thrown) {
      const fields = fieldsIn(frame);
      const isAhead = fields.length > 0 && !fields.some((field) => this.requested.shows(field));
      if (isAhead) return this.recovery.aheadFailed(thrown, fields);
      return this.recovery.endBy(thrown); // blocks before it are sound, and decoding goes on
    }
    this.recovery.guarded(() => {
      this.coarse?.note(frame);
      this.stream.received(frame.payload.length);
      if (isFirst && this.takeManifest()) return;
      const {name} = this.state;
      if (name !== 'streaming' && name !== 'paused' && this.requested.progress < Progress.settled)
        this.enter({name: 'streaming'});
      this.decoding.soon();
    });
  }

  down(attempt: number, delayMs: number): void {
    if (!isAtRest(this.state)) this.enter({name: 'reconnecting', attempt, delayMs});
    // If nothing is missing, the connection may end. Asking for more connects again.
    else if (this.state.name === 'paused' || this.requested.isAheadReceived)
      this.stream.disconnect();
  }

  failed(error: QtetError): void {
    this.stream.disconnect();
    this.reports.error(error.code, error.message);
    this.enter({name: 'failed'});
  }

  private done(): void {
    if (this.requested.progress >= Progress.received) {
      this.decoding.soon();
    } else if (!this.stream.brings(this.requested.keys)) {
      return; // another stream is opened soon, or once a pause ends
    } else if (this.stream.mayEndEarly) {
      this.stream.open(this.requested);
    } else {
      this.failed(
        new QtetError(
          'incomplete',
          'The server says that everything was sent, but parts of the mesh are missing. Try again.',
        ),
      );
    }
  }

  private refused({code, detail}: {code: string; detail: string}): void {
    // Another mesh has taken this name: what was decoded is useless.
    if (code === 'log-changed' && this.stream.digest) {
      this.forget();
      this.stream.open(this.requested);
      return;
    }
    if (code === 'unknown-field' && !this.assembler.manifest) {
      const message = `${detail.replace(/\.?$/, '.')} The first field is shown instead.`;
      this.reports.error(code, message);
      this.requested.names = null;
      this.stream.open(this.requested);
      return;
    }
    this.failed(new QtetError(code, detail));
  }

  // ---- the stream

  /**
   * Sees to it that what is wanted and not here comes: by the present stream, or else by another
   * one. Wishes that follow each other fast open one together.
   */
  private bring(): void {
    const {requested, state, stream} = this;
    if (state.name === 'paused' || state.name === 'failed') return;
    const isReceived = requested.progress >= Progress.received;
    if (isReceived && requested.isAheadReceived) return;
    const {isConnected} = stream;
    if (isAtRest(state) && !isReceived)
      this.enter({name: isConnected ? 'streaming' : 'connecting'});
    if (isConnected && stream.brings(requested.keys)) {
      stream.aim(requested);
      if (!stream.resume()) stream.open(requested);
    } else if (isConnected || !stream.isConnecting) {
      if (!this.reopening.take()) return;
      if (isConnected) stream.open(requested);
      else stream.connect();
    }
  }

  /** Returns true if the stream was opened again, now that the fields are known. */
  private takeManifest(): boolean {
    const unknown = this.requested.findFields();
    const mayComeLater = unknown !== undefined || this.stream.source.time != null;
    if (mayComeLater && this.later.isMissing) {
      void this.later.bring();
      return true;
    }
    if (unknown !== undefined) {
      const message = `The mesh has no field "${unknown}". The first one is shown instead.`;
      this.reports.error('unknown-field', message);
    }
    this.reports.manifest();
    if (!this.stream.endsAtHead && this.stream.brings(this.requested.keys)) return false;
    this.stream.open(this.requested);
    return true;
  }

  // ---- decoding

  advance(): void {
    this.recovery.guarded(() => {
      const pictureFirst = this.stream.source.pictureFirst === true && !this.publisher.hasPublished;
      const hasChanged = this.decoding.advance(pictureFirst);
      this.reports.base();
      const {progress} = this.requested;
      const isSettled = progress >= Progress.settled;
      if (hasChanged) this.publisher.changed(progress >= Progress.decoded);
      if (this.publisher.hasPublished || isSettled) void this.later.bring();
      this.reports.progress.changed();
      if (this.state.name === 'failed') return;
      if (progress === Progress.complete) {
        if (this.state.name !== 'complete') this.enter({name: 'complete'});
      } else if (isSettled) this.hold();
      if (this.state.name === 'paused') return;
      if (!isSettled || !this.requested.isAheadReceived) this.stream.giveCredit();
    });
  }

  // ---- states

  private enter(state: SessionState): void {
    this.state = state;
    this.reports.progress.flush();
    this.reports.send(stateMessage(state));
  }

  hold(): void {
    if (this.state.name === 'held' || this.state.name === 'paused') return;
    this.publisher.changed(true);
    this.enter({name: 'held'});
  }

  /** Returns true if there was a pause. The caller reports the next state. */
  private endPause(): boolean {
    const wasPaused = this.state.name === 'paused';
    if (wasPaused) this.state = {name: 'streaming'};
    return wasPaused;
  }

  /** Continues after a pause or a new limit: first with what is here, then with the network. */
  private goOn(): void {
    this.state = {name: 'streaming'}; // reported below, unless decoding ends it at once
    this.advance();
    if (this.state.name === 'streaming') {
      const isReceived = this.requested.progress >= Progress.received;
      const isUnderWay = isReceived || this.stream.isConnected;
      this.enter({name: isUnderWay ? 'streaming' : 'connecting'});
    }
    this.bring();
  }

  /** Must be called before another log. */
  private forget(): void {
    this.later.forget();
    this.gate.forget();
    this.reports.forget();
    this.reopening.drop();
    this.decoding.forget();
    this.stream.forget();
    this.requested.forget();
    this.assembler.forget();
    this.coarse?.forget();
    this.publisher.reset();
  }
}

/** The fields that the frame has blocks of; none if it has others, too. */
function fieldsIn({firstPart, parts}: Frame): number[] {
  if (firstPart < kFirstFieldPart || firstPart === kHeadPart) return [];
  return Array.from({length: parts}, (_, part) => firstPart - kFirstFieldPart + part);
}
