// Spaces what may be asked for too often.

export class Throttle {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private takenAt = -Infinity;

  /** After a refusal `again` is called once, when `ms` have passed since the last turn. */
  constructor(
    private readonly again: () => void,
    private readonly ms: number,
  ) {}

  /** Returns true if the turn may be taken now. */
  take(): boolean {
    const now = performance.now();
    const wait = this.takenAt + this.ms - now;
    if (wait > 0) {
      this.timer ??= setTimeout(() => {
        this.timer = undefined;
        this.again();
      }, wait);
      return false;
    }
    this.drop();
    this.takenAt = now;
    return true;
  }

  /** No call of `again` is due any more. */
  drop(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
  }
}
