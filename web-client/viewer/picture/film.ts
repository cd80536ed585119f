// The loop that makes a movie: each instant is shown, drawn and added.

/** Shows the instants of a movie. */
export interface Stage {
  /** Fields, by time. */
  readonly instants: readonly number[];
  /** Resolves once the instant is wholly on the screen. Throws a sentence if it is lost. */
  show(i: number, signal: AbortSignal): Promise<void>;
  draw(): Promise<OffscreenCanvas>;
  /** Shows what was shown before. */
  restore(): void;
}

/** The file that is made. */
export interface Sink {
  /** It holds no transparency. */
  readonly isOpaque: boolean;
  add(frame: OffscreenCanvas): Promise<void>;
  end(): Promise<Blob>;
  /** Frees what it holds. */
  close(): void;
}

/** `progress` is called with the instants that are drawn and the count of all. */
export interface Filming {
  signal: AbortSignal;
  progress: (done: number, count: number) => void;
}

/** Rejects with the signal's reason once it is aborted. Nothing is returned then. */
export async function film(stage: Stage, sink: Sink, {signal, progress}: Filming): Promise<Blob> {
  const count = stage.instants.length;
  const aborted = new Promise<never>((_, reject) => {
    signal.addEventListener('abort', () => reject(signal.reason as Error), {once: true});
  });
  aborted.catch(() => undefined);
  try {
    for (let i = 0; i < count; ++i) {
      progress(i, count);
      await stage.show(i, signal);
      await Promise.race([stage.draw().then((frame) => sink.add(frame)), aborted]);
    }
    progress(count, count);
    const movie = await Promise.race([sink.end(), aborted]);
    signal.throwIfAborted();
    return movie;
  } finally {
    stage.restore();
  }
}
