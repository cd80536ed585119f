// Turns the growing mesh into pictures for the page: decides when the next one is made, and what it
// shows.

import type {Assembler} from '../decode/assembler';
import {fieldsOf} from '../layers/shown';
import {kPlainDisplay, type Display} from '../picture/display';
import type {CreasesOf} from '../picture/triangle_soup';
import {isEqual} from '../protocol/equal';
import {drawable, isWaiting, type Drawn} from './held_instants';
import {PictureMaker} from './picture_maker';
import {PicturePace} from './picture_pace';
import type {Snapshot} from './worker_messages';

/**
 * Growth waits its turn, a wish of the user hardly. The last picture, which nothing finer follows
 * by itself, need not leave time for decoding.
 */
enum Cause {
  growth,
  wish,
  last,
}

/** The picture that is made next. */
interface Due {
  cause: Cause;
  /** It has the surface of the last one. */
  isOnlyCut: boolean;
  /** When it is made; null: it waits for the screen or for the mesh. */
  alarm: {at: number; timer: ReturnType<typeof setTimeout>} | null;
}

export class Publisher {
  readonly pace = new PicturePace();
  /** Called after the first picture of a mesh has been sent. */
  onFirst: () => void = () => undefined;
  private display: Display = kPlainDisplay;
  /** The last picture's display, or a wish since, as it could be drawn then; null: no wish came. */
  private seen: Display | null = null;
  /** The last picture; null: there was none since the last reset. */
  private drawn: Drawn | null = null;
  /** Null: the last picture is as the mesh and the display are. */
  private due: Due | null = null;
  private readonly maker: PictureMaker;

  constructor(
    private readonly assembler: Assembler,
    private readonly send: (snapshot: Snapshot) => void,
  ) {
    this.maker = new PictureMaker(assembler);
  }

  /** Since the last reset. */
  get hasPublished(): boolean {
    return this.drawn !== null;
  }

  /** A picture is due or on its way to the screen. */
  get isBusy(): boolean {
    return this.due?.alarm != null || !this.pace.isOnScreen;
  }

  get hasCreases(): boolean {
    return this.maker.hasCreases;
  }

  /** The display as it can be drawn now. */
  get now(): Display {
    return drawable(this.assembler, this.display, this.drawn);
  }

  /** The mesh or the shown values have changed. `isLast`: nothing finer will follow by itself. */
  changed(isLast = false): void {
    // Until an instant has values, only a finer mesh changes the picture of the last one.
    const {assembler, display, drawn} = this;
    const isFiner = assembler.codec.chunksApplied !== drawn?.chunks;
    if (isFiner || !isWaiting(assembler, display, drawn))
      this.ask(isLast ? Cause.last : Cause.growth);
  }

  /** Draws creases from the next picture on. */
  useCreases(creasesOf: CreasesOf): void {
    this.maker.useCreases(creasesOf);
    this.ask(Cause.growth);
  }

  show(display: Display): void {
    const before = this.seen;
    this.display = display;
    const now = (this.seen = {...this.now, ahead: []}); // fields ahead are not seen
    if (isEqual(now, before)) return;
    // Planes alone make another cut of the same surface, unless they hide whole cells.
    const isOnlyCut = before !== null && isEqual({...now, planes: before.planes}, before);
    this.ask(Cause.wish, isOnlyCut && now.mode !== 'cells');
  }

  /** The page has drawn the last picture in `drawingMs`; 0 if unknown. */
  shown(drawingMs = 0): void {
    this.pace.shown(drawingMs);
    this.schedule();
  }

  /** Sends the picture again, without waiting for the last one. */
  repeat(): void {
    this.pace.release();
    this.ask(Cause.last);
  }

  /** Begins with an empty mesh and waits for a display. */
  reset(): void {
    clearTimeout(this.due?.alarm?.timer);
    this.due = this.seen = this.drawn = null;
    this.display = kPlainDisplay;
    this.pace.reset();
    this.maker.forget();
  }

  /** Earlier requests still hold. */
  private ask(cause: Cause, isOnlyCut = false): void {
    const {due} = this;
    if (cause !== Cause.wish && due?.isOnlyCut !== false) this.pace.meshChanged();
    this.due = {
      cause: due && due.cause > cause ? due.cause : cause,
      isOnlyCut: isOnlyCut && due?.isOnlyCut !== false,
      alarm: due?.alarm ?? null,
    };
    this.schedule();
  }

  private schedule(): void {
    const {due} = this;
    if (!this.seen || !due || !this.pace.isOnScreen) return;
    const now = performance.now();
    const at = this.momentOf(due.cause, now);
    if (due.alarm && due.alarm.at <= at) return;
    clearTimeout(due.alarm?.timer);
    due.alarm = {at, timer: setTimeout(() => this.publishIfDue(), at - now)};
  }

  private momentOf(cause: Cause, now: number): number {
    if (cause === Cause.last) return now;
    if (cause === Cause.wish) return this.pace.cutAt(now);
    return this.pace.meshAt(now, this.assembler.statistics(fieldsOf(this.display)).bytes);
  }

  /** A better moment may be known by now. */
  private publishIfDue(): void {
    const due = this.due!;
    due.alarm = null;
    const now = performance.now();
    if (due.cause === Cause.growth && this.pace.lastAt(now) > now) this.schedule();
    else this.publish(due);
  }

  private publish({isOnlyCut}: Due): void {
    const start = performance.now();
    const {assembler, now} = this;
    const picture = this.maker.make(now, isOnlyCut);
    if (!picture) return;
    const isFirst = !this.hasPublished;
    const {color, inputs, warp = null} = picture;
    const chunks = assembler.codec.chunksApplied;
    const {streamlines, arrows} = now;
    this.drawn = {color, warp, chunks, streamlines, arrows, ...(inputs && {inputs})};
    this.seen = {...now, ahead: []};
    this.due = null;
    const statistics = assembler.statistics(fieldsOf(this.display));
    const costMs = this.pace.sends(start, statistics.bytes, isFirst);
    this.send({...picture, statistics, costMs});
    if (isFirst) this.onFirst();
  }
}
