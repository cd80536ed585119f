// The clock by which a series plays. It knows no document.

import type {TimeLine} from './time_line';

/** Between two instants at speed 1. */
const kStepMs = 100;
/** The clock is read so often, and with each picture. */
const kTickMs = 25;
/**
 * An instant that is not here after this time is passed over for one that is, or for the next
 * segment.
 */
const kPatienceMs = 1000;

export class TimeClock {
  /** The instant that is asked for. */
  at = 0;
  /** It was not here when it was asked for. */
  isLate = false;
  speed = 1;
  /** The first and the last instant that play. */
  part: readonly [number, number] = [0, Infinity];
  /** Playing goes on at the part's first instant; otherwise it ends at the last. */
  loops = true;
  private timer: ReturnType<typeof setInterval> | undefined;
  /** When the next instant is due. */
  private dueAt = 0;
  /** 0: `at` is on the screen, or nothing plays. */
  private waitingSince = 0;

  /** `ask` is called when `at` is another one, `ended` when the last instant was shown. */
  constructor(
    private readonly line: Pick<
      TimeLine,
      'times' | 'isHere' | 'isOnScreen' | 'awaitsFrame' | 'isOpening' | 'areTogether'
    >,
    private readonly ask: () => void,
    private readonly ended: () => void = () => undefined,
  ) {}

  get isPlaying(): boolean {
    return this.timer !== undefined;
  }

  /** Between two instants that play. */
  get stepMs(): number {
    return kStepMs / this.speed;
  }

  play(): void {
    clearInterval(this.timer);
    this.waitingSince = 0;
    this.dueAt = performance.now() + this.stepMs;
    this.timer = setInterval(() => this.tick(), kTickMs);
    if (!this.isInPart || (!this.loops && this.at === this.last)) this.show(this.part[0]);
  }

  stop(): void {
    clearInterval(this.timer);
    this.timer = undefined;
  }

  /** Asks for an instant, round the ends. */
  show(at: number): void {
    const count = this.line.times.length;
    if (count === 0) return;
    this.at = (at + count) % count;
    this.isLate = !this.line.isHere(this.at);
    this.ask();
  }

  /**
   * The next instant, once this one is in the picture. Instants whose time passes while a picture
   * is drawn are left out. The clock stands while an instant is not here, and until a segment is on
   * the screen.
   */
  tick(): void {
    const {at, line} = this;
    const now = performance.now();
    if (line.awaitsFrame) return void (this.waitingSince = 0);
    if (line.isOnScreen(at)) {
      this.waitingSince = 0;
      if (this.isLate) this.dueAt = Math.max(this.dueAt, now);
      this.isLate = false;
      if (now < this.dueAt) return;
      if (this.left === 0) return this.ended();
      const due = 1 + Math.floor((now - this.dueAt) / this.stepMs);
      const by = this.stepsTo(due);
      this.dueAt = by === due ? this.dueAt + by * this.stepMs : now + this.stepMs;
      return this.show(this.after(by));
    }
    if (this.waitingSince === 0) this.waitingSince = now;
    if (now - this.waitingSince < kPatienceMs) return;
    if (line.isOpening) return; // a segment that is slow would only begin again
    for (let by = 1; by <= this.left; ++by) {
      const next = this.after(by);
      if (!line.isHere(next) && line.areTogether(at, next)) continue;
      this.waitingSince = 0;
      return this.show(next);
    }
  }

  /**
   * The most steps up to `due` to an instant that is here; 1 if none is. The first instant of
   * another segment ends them, or slow graphics would play round in one segment.
   */
  private stepsTo(due: number): number {
    const {at, line} = this;
    let by = Math.min(due, this.left);
    for (let i = 1; i < by; ++i) if (!line.areTogether(at, this.after(i))) return i;
    while (by > 1 && !line.isHere(this.after(by))) --by;
    return Math.max(1, by);
  }

  private get last(): number {
    return Math.min(this.part[1], this.line.times.length - 1);
  }

  private get isInPart(): boolean {
    return this.at >= this.part[0] && this.at <= this.last;
  }

  /** So many other instants play before the part begins again, or ends. */
  private get left(): number {
    const [first] = this.part;
    if (!this.isInPart) return this.last - first + 1;
    return this.loops ? this.last - first : this.last - this.at;
  }

  /** The instant that plays `by` steps after this one. Outside the part its first one is next. */
  private after(by: number): number {
    const [first] = this.part;
    const from = this.isInPart ? this.at : first - 1;
    return first + ((from - first + by) % (this.last - first + 1));
  }
}
