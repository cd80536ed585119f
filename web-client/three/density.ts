// When a window comes to another screen, or is zoomed: as many pixels of the page, more or fewer of
// the screen.

/** Calls at every change of devicePixelRatio until the returned function is called. */
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
