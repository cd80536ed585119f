// The pictures on a view's canvas, one after the other. They are drawn only after changes.

import {FrameBudget, whenDrawn} from './frame_budget';
import type {Scene} from './scene';
import {usePixels, type ViewCanvas} from './worker_canvas';

/** Slower graphics show parts that move at rest: they would be busy for ever. */
const kMostMovingMs = 50;
/** So many slow pictures in a row are no accident: the first ones make programs and buffers. */
const kMostSlow = 6;

export class Frames {
  /** The time of the last one on this thread. */
  ms = 0;
  /** The user has changed something since the last picture; new levels alone do not count. */
  private moved = false;
  /** Slow pictures in a row. */
  private slow = 0;
  private hasEnded = false;
  /** The requested frame; 0: none is. */
  private requested = 0;
  /** Between two pictures; 0: nothing plays. */
  everyMs = 0;
  /** The pictures without a volume learn and use it. */
  private readonly budget = new FrameBudget();
  /** They are called with the time of drawing, once the next one is drawn. */
  waiting: ((ms: number) => void)[] = [];

  /** `drawn` is called after each one. */
  constructor(
    private readonly canvas: ViewCanvas,
    private readonly scene: Scene,
    private readonly drawn: () => void,
  ) {}

  /** As View.setPlaying. */
  setPlaying(everyMs: number): void {
    if (everyMs === this.everyMs) return;
    this.everyMs = everyMs;
    if (everyMs === 0 && !this.scene.hasVolume) this.invalidate();
  }

  /** `moved`: the user did it and should see something at once. */
  invalidate(moved = true): void {
    const {volume} = this.scene;
    if (moved) volume?.interrupt();
    this.moved ||= moved;
    // The graphics draw one picture at a time. The next begins after it, from the state of then.
    if (volume?.busy) volume.waiting = true;
    else this.requested ||= requestAnimationFrame(() => this.draw());
  }

  /** Gives the picture this share of the canvas's pixels, each way. */
  draw(share = this.share): void {
    const {canvas, scene} = this;
    const {camera, graphics, volume} = scene;
    this.cancel();
    if (volume?.busy) return void (volume.waiting = true);
    scene.parts.setPixelRatio(usePixels(canvas, share));
    const start = performance.now();
    const done = this.waiting;
    this.waiting = [];
    // Graphics without a GPU draw long after the call. Failures are reported, too, or a caller
    // would wait for ever.
    const tell = (ms: number): void => {
      if (!scene.hasVolume) this.budget.learn(share, ms);
      done.forEach((drawn) => drawn(ms));
      this.slow = ms < kMostMovingMs ? 0 : this.slow + 1;
      const goesOn = !this.hasEnded && !graphics.gl.isContextLost() && this.slow < kMostSlow;
      if (scene.parts.moves && goesOn) this.invalidate(false);
    };
    try {
      const {lens} = camera.orbit;
      if (scene.drawsVolume) {
        scene.fadeLines(lens, canvas);
        volume!.draw(scene.pictureOf(lens), this.moved);
      } else scene.drawSurface(lens, canvas);
      this.moved = false;
      this.ms = performance.now() - start;
      this.drawn();
    } finally {
      if (done.length > 0 || scene.parts.moves) void whenDrawn(graphics.gl, start).then(tell);
    }
  }

  /** Nothing is drawn any more. */
  end(): void {
    this.hasEnded = true;
    this.cancel();
  }

  /** A requested one is not drawn. */
  cancel(): void {
    cancelAnimationFrame(this.requested);
    this.requested = 0;
  }

  /** The share of the canvas's pixels that a picture of now gets, each way. */
  private get share(): number {
    return this.everyMs > 0 && !this.scene.hasVolume ? this.budget.steadyShare(this.everyMs) : 1;
  }
}
