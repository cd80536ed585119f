// How much a request asks for, so that requests are few and progress is steady.

/** A request asks for what the line brings in so many seconds, within the bounds below. */
const kRequestSeconds = 0.4;
const kMinBytes = 32 << 10;
const kMaxBytes = 512 << 10;

export class RequestSize {
  bytes = kMinBytes;
  private arrivedAt = 0;

  /** Adapts to the line. Must be called when so many bytes have come. */
  measure(bytes: number): void {
    const now = performance.now();
    const seconds = (now - this.arrivedAt) / 1000;
    if (this.arrivedAt > 0 && seconds > 0) {
      const fitting = (bytes / seconds) * kRequestSeconds;
      this.bytes = Math.min(kMaxBytes, Math.max(kMinBytes, (this.bytes + fitting) / 2));
    }
    this.arrivedAt = now;
  }
}
