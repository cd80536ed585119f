// How fine a costly picture may be drawn: coarse while something moves, fine once it rests, by what the last ones took on the graphics' side.

/** A moving picture takes at most so long, and one at rest. */
const kMovingMs = 60;
const kRestingMs = 1200;
/** Shares of the canvas's pixels each way: below this one sees nothing. */
const kLeastShare = 0.2;
const kPollMs = 4;

export class FrameBudget {
  /** What the cells take, and all pixels, in ms. */
  private fixed = 0;
  private perPicture = 0;
  private last: {share: number; ms: number} | null = null;
  private pending = false;

  get busy(): boolean { return this.pending; }

  share(moving: boolean): number {
    const most = moving ? kMovingMs : kRestingMs;
    if (this.fixed + this.perPicture <= most) return 1;
    return Math.max(kLeastShare, Math.sqrt(Math.max(0, most - this.fixed) / this.perPicture));
  }

  /** Two pictures of different sizes tell what goes by pixels; until then all of it does. */
  private learn(share: number, ms: number): void {
    const {last} = this;
    const difference = last ? share * share - last.share * last.share : 0;
    const slope = last && Math.abs(difference) > 0.02 ? (ms - last.ms) / difference : 0;
    this.perPicture = slope > 0 ? slope : Math.max(1, ms - this.fixed) / (share * share);
    if (slope > 0) this.fixed = Math.max(0, ms - slope * share * share);
    this.last = {share, ms};
  }

  /** To be called after the picture's commands; `done` once the graphics have drawn it. */
  measure(gl: WebGL2RenderingContext, share: number, done: () => void): void {
    const start = performance.now();
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence) return;
    gl.flush();
    this.pending = true;
    const poll = (): void => {
      const status = gl.isContextLost() ? gl.WAIT_FAILED : gl.clientWaitSync(fence, 0, 0);
      if (status === gl.TIMEOUT_EXPIRED) return void setTimeout(poll, kPollMs);
      gl.deleteSync(fence);
      this.pending = false;
      this.learn(share, performance.now() - start);
      done();
    };
    setTimeout(poll, kPollMs);
  }
}
