// Notes that a worker is silent for so long that it is dead or hangs.

/** It is asked this often whether it responds, while the page is visible. */
const kPingMs = 5000;
/**
 * So many unanswered questions are allowed: software graphics may block a worker for seconds, and a
 * page that slept has asked only once.
 */
const kMaxUnanswered = 6;

/**
 * `ask` is called now and then until the signal aborts, and `silent` with true and false. Returns a
 * function that must be called with each answer.
 */
export function watchWorker(
  ask: () => void,
  silent: (silent: boolean) => void,
  signal: AbortSignal,
): () => void {
  let unanswered = 0;
  const note = (next: number): void => {
    const was = unanswered > kMaxUnanswered,
      is = next > kMaxUnanswered;
    unanswered = next;
    if (was !== is) silent(is);
  };
  const timer = setInterval(() => {
    if (document.hidden) return;
    note(unanswered + 1);
    ask();
  }, kPingMs);
  signal.addEventListener('abort', () => clearInterval(timer));
  return () => note(0);
}
