// The time that pictures take on the graphics' side, and the pixels that a picture may have while
// something moves.

/** The most time for a picture while something moves. */
export const kMovingMs = 60;
/** The least share of the canvas's pixels, each way: with fewer, nothing is recognisable. */
const kMinShare = 0.2;
/** The shares that a row of pictures may have. */
const kSteps = [1, 0.7, 0.5, 0.35];
/** Polling takes time from the workers. It is rarer the longer a picture takes. */
const kPollMs = 4;
const kPollShare = 0.125;

const pause = (start: number): Promise<void> =>
  new Promise((resolve) =>
    setTimeout(resolve, Math.max(kPollMs, kPollShare * (performance.now() - start))),
  );

/** Waits until the graphics have drawn everything. Returns the time since `start`. */
export async function whenDrawn(gl: WebGL2RenderingContext, start: number): Promise<number> {
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  do await pause(start);
  while (fence && !gl.isContextLost() && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED);
  gl.deleteSync(fence);
  return performance.now() - start;
}

/** Calls `draw`. Returns whether any of its pixels passes the tests of depth and shader. */
export async function reachesPixels(
  gl: WebGL2RenderingContext,
  draw: () => void,
): Promise<boolean> {
  const query = gl.isContextLost() ? null : gl.createQuery();
  if (query) gl.beginQuery(gl.ANY_SAMPLES_PASSED, query);
  const start = performance.now();
  draw();
  if (!query) return false;
  gl.endQuery(gl.ANY_SAMPLES_PASSED);
  gl.flush();
  do await pause(start);
  while (!gl.isContextLost() && !gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE));
  const reaches = Boolean(gl.getQueryParameter(query, gl.QUERY_RESULT));
  gl.deleteQuery(query);
  return reaches;
}

export class FrameBudget {
  /** The time of the cells, and that of all pixels, in ms. The first guess is slow. */
  private fixed = 0;
  private perPicture = 10 * kMovingMs;
  private last: {share: number; ms: number} | null = null;

  /** The pixels of a picture that takes at most `mostMs`, each way. */
  share(mostMs = kMovingMs): number {
    if (this.fixed + this.perPicture <= mostMs) return 1;
    return Math.max(
      kMinShare,
      Math.min(1, Math.sqrt(Math.max(0, mostMs - this.fixed) / this.perPicture)),
    );
  }

  /** share() in few steps, so that pictures that follow each other seldom differ in size. */
  steadyShare(everyMs: number): number {
    const share = this.share(Math.min(kMovingMs, everyMs));
    return kSteps.find((step) => step <= share) ?? kSteps.at(-1)!;
  }

  /**
   * Two pictures of different sizes show how much depends on pixels. Until then all of it is
   * assumed to.
   */
  learn(share: number, ms: number): void {
    const {last} = this;
    const difference = last ? share * share - last.share * last.share : 0;
    const slope = last && Math.abs(difference) > 0.02 ? (ms - last.ms) / difference : 0;
    this.perPicture = slope > 0 ? slope : Math.max(1, ms - this.fixed) / (share * share);
    if (slope > 0) this.fixed = Math.max(0, ms - slope * share * share);
    this.last = {share, ms};
  }
}
