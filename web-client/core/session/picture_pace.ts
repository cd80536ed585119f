// Decides when the next picture is made: no faster than the page shows them and decoding can spare.

/**
 * The least time between two pictures: decoding needs the worker, and the page needs its frames.
 */
const kShortestPauseMs = 100;
/**
 * The pause between pictures is so many times the cost of the last one, in the worker and on its
 * way to the screen. Graphics without a GPU take the processors from decoding.
 */
const kCostFactor = 4;
/** A hidden page draws nothing, so that the time until it does says nothing about pictures. */
const kLongestPauseMs = 1000;
/**
 * Below this share of new bytes a picture hardly differs from the last one. It waits for more, but
 * at most kSmallGrowthMs.
 */
const kGrowth = 0.1;
/** The same share where a picture takes so long that decoding suffers. */
const kSlowMs = 100;
const kSlowGrowth = 1;
const kSmallGrowthMs = 500;
/**
 * A picture is worth making if it stays at least this many times as long as it takes to reach the
 * screen. Otherwise only the last one is made, and it arrives sooner.
 */
const kWorthMaking = 2;
/** A cut that the user drags comes at once. This pause only keeps it from starving the decoder. */
const kCutPauseMs = 8;

export class PicturePace {
  /** How long until everything wanted is decoded, in ms; Infinity if unknown. */
  untilLast: () => number = () => Infinity;
  /** The last picture has reached the screen. */
  private onScreen = true;
  /** The last picture. */
  private sent = {at: 0, bytes: 0, isFirst: true};
  /**
   * How long the last picture took to the screen; for the first one, without the start of the
   * graphics. 0 if unknown.
   */
  private tookMs = 0;
  /** When the mesh began to differ from the last picture's. */
  private changedAt = 0;
  private nextAt = 0;

  get isOnScreen(): boolean {
    return this.onScreen;
  }

  /** Nobody waits for the last picture any more. */
  release(): void {
    this.onScreen = true;
  }

  /** Begins with a new mesh. */
  reset(): void {
    this.onScreen = true;
    this.sent.bytes = this.tookMs = 0;
  }

  meshChanged(): void {
    this.changedAt = performance.now();
  }

  /**
   * A picture of this many bytes is made and leaves now; making it began at `start`. Returns the
   * cost of making it, in ms.
   */
  sends(start: number, bytes: number, isFirst: boolean): number {
    const at = performance.now();
    this.onScreen = false;
    this.sent = {at, bytes, isFirst};
    this.nextAt = start + Math.max(kShortestPauseMs, kCostFactor * (at - start));
    return at - start;
  }

  /** The page has drawn the last picture in `drawingMs`; 0 if unknown. */
  shown(drawingMs: number): void {
    if (this.onScreen) return;
    const now = performance.now();
    const passed = now - this.sent.at;
    this.nextAt = Math.max(this.nextAt, now + Math.min(kLongestPauseMs, kCostFactor * passed));
    this.tookMs = Math.min(kLongestPauseMs, this.sent.isFirst ? drawingMs : passed);
    this.onScreen = true;
  }

  /** When a picture with another cut is due. With nothing to decode it is due at once. */
  cutAt(now: number): number {
    return Math.min(this.nextAt, this.untilLast() === 0 ? now : now + kCutPauseMs);
  }

  /** When a picture of a mesh of this many bytes is due. */
  meshAt(now: number, bytes: number): number {
    const last = this.sent.bytes;
    const growth = this.tookMs < kSlowMs ? kGrowth : kSlowGrowth;
    const isSmall = bytes >= last && bytes < (1 + growth) * last;
    return Math.max(this.nextAt, isSmall ? this.changedAt + kSmallGrowthMs : 0, this.lastAt(now));
  }

  /** When the last picture is due, if one before it is not worth making; else 0. */
  lastAt(now: number): number {
    const left = this.tookMs > 0 ? this.untilLast() : Infinity;
    return left < kWorthMaking * this.tookMs ? now + left : 0;
  }
}
