// Watches the pixel density: it changes when a window moves to another screen or is zoomed.

/** Calls `changed` at every change of devicePixelRatio until the returned function is called. */
export function watchDensity(changed: () => void): () => void {
  const ended = new AbortController();
  const listen = (): void =>
    matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`).addEventListener(
      'change',
      () => {
        changed();
        listen();
      },
      {once: true, signal: ended.signal},
    );
  listen();
  return () => ended.abort();
}
