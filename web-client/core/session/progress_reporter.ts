// Reports progress no more often than a page can show it.

/**
 * Blocks may come by the hundred a second. Reporting each would cost both threads more than it
 * shows.
 */
const kProgressMs = 100;

export class ProgressReporter {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private reportedAt = -kProgressMs;

  constructor(private readonly report: () => void) {}

  /** The last change of a burst is reported late, but never lost. */
  changed(): void {
    const wait = Math.max(0, this.reportedAt + kProgressMs - performance.now());
    this.timer ??= setTimeout(() => this.send(), wait);
  }

  /** Reports at once if a report is waiting. */
  flush(): void {
    if (this.timer !== undefined) this.send();
  }

  private send(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.reportedAt = performance.now();
    this.report();
  }
}
