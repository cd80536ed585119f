// The volume on the canvas. Fast graphics draw all of it at once. Slow ones draw few cells with few
// pixels while something moves, and all cells with all pixels once it rests. They draw in strips of
// pixels, so that the next movement waits for a strip and not for the picture.

import type {PerspectiveCamera, Scene, WebGLRenderer} from 'three';
import type {TransferTables} from '../core/picture/transfer';
import {kCoarseCells, type CoarseCells, type VolumeCells} from '../core/picture/volume';
import {CellTextures} from './cell_textures';
import {DeepTarget} from './deep_target';
import {FrameBudget, kMovingMs, reachesPixels, whenDrawn} from './frame_budget';
import {RayCaster, type Sight} from './ray_caster';

/** The time of a strip, about. */
const kStripMs = 120;
/**
 * The pixels of the first strip, whose time is unknown. Without a GPU it takes some tenths of
 * kStripMs.
 */
const kFirstPixels = 1 << 14;
/** The most pixels of a strip, as a multiple of the previous strip's. */
const kStripGrowth = 2;
/** A picture rests so long after its last change. */
const kRestMs = 150;
/**
 * The most times that a line of sight enters the mesh. Cells behind hundreds of walls cannot be
 * told apart, and every layer takes its passes.
 */
const kMaxLayers = 256;

/** A mesh of cells. */
interface Layered {
  /** May differ from `shown`: a picture that is being drawn keeps its cells. */
  requested: VolumeCells | null;
  of: VolumeCells | null;
  shown: CellTextures | null;
  /**
   * The layers of a picture that is drawn at once: as many as the previous one needed, and often
   * one more.
   */
  layers: number;
}

/** The parts of a picture. */
export interface Picture extends Sight {
  renderer: WebGLRenderer;
  scene: Scene;
  camera: PerspectiveCamera;
}

const layered = (): Layered => ({requested: null, of: null, shown: null, layers: 1});

export class VolumeView {
  private readonly fine = layered();
  private readonly coarse = layered();
  private readonly caster = new RayCaster();
  private readonly deep = new DeepTarget();
  private readonly budget = new FrameBudget();
  private coarseVersion = -1;
  private coarseState: 'stale' | 'asked' | 'here' | 'none' = 'stale';
  /**
   * The last time for all cells and pixels, and the pixels a millisecond in its slowest strip; 0 if
   * unknown.
   */
  private wholeMs = 0;
  private rate = 0;
  private inHand: Promise<void> | null = null;
  /** Another picture must follow the current one. */
  waiting = false;
  private interrupted = false;
  private whole = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `changed` asks for another picture. `askCoarse` and `works` are those of ViewListeners. */
  constructor(
    private readonly changed: (moved: boolean) => void,
    private readonly askCoarse?: (have: number) => Promise<CoarseCells>,
    private readonly works: (working: boolean) => void = () => undefined,
  ) {}

  get hasCells(): boolean {
    return this.fine.requested !== null;
  }
  /** The graphics are drawing. */
  get busy(): boolean {
    return this.inHand !== null;
  }
  /** Nothing moves, and all of it is on the canvas. */
  get atRest(): boolean {
    return this.whole && !this.busy && this.timer === undefined;
  }

  take(cells: VolumeCells | null): void {
    this.fine.requested = cells;
    this.whole = false;
    this.coarseState = 'stale'; // it may belong to another field now; its next answer tells
    if (cells) return;
    this.coarse.requested = null;
    this.coarseVersion = -1;
    this.interrupt();
    if (!this.busy) this.update();
  }

  setTransfer(tables: TransferTables): void {
    this.caster.setTransfer(tables);
  }
  setRange(...words: Parameters<RayCaster['setRange']>): void {
    this.caster.setRange(...words);
  }
  setClip(...words: Parameters<RayCaster['setClip']>): void {
    this.caster.setClip(...words);
  }

  /** The current drawing is useless now. */
  interrupt(): void {
    this.interrupted = true;
    this.whole = false;
    clearTimeout(this.timer);
    this.timer = undefined;
  }

  /**
   * Draws as much as there is time for. The rest follows by itself. REQUIRES: not busy, hasCells.
   */
  draw(picture: Picture, moved: boolean): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.interrupted = this.waiting = this.whole = false;
    this.update();
    const isSlow = this.wholeMs === 0 || this.wholeMs > kMovingMs;
    const isSmall = this.fine.shown!.count <= kCoarseCells;
    if (moved && isSlow && !isSmall) this.refreshCoarse();
    if (!isSlow) this.start(this.drawAtOnce(picture, this.fine, 1));
    else if (moved && isSmall) this.start(this.drawAtOnce(picture, this.fine, this.budget.share()));
    else if (moved && this.coarseState === 'here')
      this.start(this.drawAtOnce(picture, this.coarse, this.budget.share()));
    else if (!moved || this.coarseState === 'none')
      this.start(this.drawStrips(picture, () => this.interrupted));
    // Otherwise the coarse mesh is under way, and the previous picture stays.
  }

  /** Draws all of it, even while something moves. REQUIRES: hasCells. */
  async drawWhole(picture: Picture): Promise<void> {
    this.interrupt();
    await this.idle();
    if (!this.hasCells) return;
    this.update();
    this.interrupted = false;
    this.start(this.drawStrips(picture, () => false));
    await this.inHand;
  }

  /** Shows the last picture again on a canvas that has been cleared. */
  present(renderer: WebGLRenderer): void {
    this.deep.present(renderer);
  }

  dispose(): void {
    this.interrupt();
    this.fine.requested = this.coarse.requested = null;
    this.update();
    this.deep.dispose();
    this.caster.dispose();
  }

  /** Takes the new cells. REQUIRES: no picture is being drawn. */
  private update(): void {
    for (const its of [this.fine, this.coarse]) {
      if (its.requested === its.of) continue;
      its.shown?.dispose();
      its.of = its.requested;
      its.shown = its.of && new CellTextures(its.of);
    }
  }

  private refreshCoarse(): void {
    if (this.coarseState !== 'stale') return;
    this.coarseState = 'asked';
    const end = (state: 'here' | 'none'): void => {
      if (this.coarseState === 'asked') this.coarseState = state;
      if (this.hasCells) this.changed(true);
    };
    if (!this.askCoarse) return end('none');
    this.askCoarse(this.coarseVersion).then(
      ({version, cells}) => {
        if (cells) this.coarse.requested = cells;
        this.coarseVersion = version;
        end(this.coarse.requested ? 'here' : 'none');
      },
      () => end('none'),
    );
  }

  private async idle(): Promise<void> {
    while (this.inHand) await this.inHand;
  }

  private start(drawing: Promise<void>): void {
    this.works(true);
    this.inHand = drawing.catch(reportError).finally(() => {
      this.inHand = null;
      if (this.atRest || !this.hasCells) this.works(false);
      if (!this.hasCells) this.update();
      if (this.interrupted || this.waiting) this.changed(this.interrupted);
    });
  }

  /** Returns true if the eye is inside a cell, as RayCaster.begin. */
  private begin(
    {renderer, scene, camera, ...sight}: Picture,
    its: Layered,
    share: number,
  ): boolean {
    this.deep.begin(renderer, share, scene, camera);
    return this.caster.begin(its.shown!, sight, this.deep);
  }

  private async drawAtOnce(picture: Picture, its: Layered, share: number): Promise<void> {
    const {caster, deep} = this;
    const {renderer} = picture;
    const gl = renderer.getContext() as WebGL2RenderingContext;
    const start = performance.now();
    if (this.begin(picture, its, share)) caster.cast(renderer, deep, 0, deep.height);
    const reached: Promise<boolean>[] = [];
    while (reached.length < its.layers) {
      reached.push(reachesPixels(gl, () => caster.enter(renderer)));
      caster.cast(renderer, deep, 0, deep.height);
    }
    deep.present(renderer);
    const ms = await whenDrawn(gl, start);
    const needed = (await Promise.all(reached)).filter(Boolean).length;
    const isCut = needed === its.layers && needed < kMaxLayers;
    its.layers = Math.min(needed + 1, kMaxLayers);
    const isWhole = its === this.fine && share === 1;
    if (isWhole) this.wholeMs = ms;
    else this.budget.learn(share, ms);
    if (this.interrupted) return;
    this.whole = isWhole && !isCut;
    if (this.whole) return;
    this.timer = setTimeout(
      () => {
        this.timer = undefined;
        this.changed(false);
      },
      isWhole ? 0 : kRestMs,
    );
  }

  private async drawStrips(picture: Picture, ends: () => boolean): Promise<void> {
    const {caster, deep} = this;
    const {renderer} = picture;
    const gl = renderer.getContext() as WebGL2RenderingContext;
    const begun = performance.now();
    let last = this.rate > 0 ? Infinity : 0; // pixels of the previous strip
    let rate = this.rate;
    this.rate = 0;
    const isInside = this.begin(picture, this.fine, 1);
    for (let layer = isInside ? -1 : 0; layer < kMaxLayers; ++layer) {
      const reaches = layer < 0 || reachesPixels(gl, () => caster.enter(renderer));
      if (layer > 0 && !(await reaches)) break;
      for (let row = 0; row < deep.height;) {
        const maxPixels = rate > 0 ? Math.min(rate * kStripMs, kStripGrowth * last) : kFirstPixels;
        const rows = Math.min(deep.height - row, Math.ceil(maxPixels / deep.width));
        last = rows * deep.width;
        const start = performance.now();
        caster.cast(renderer, deep, row, rows);
        row += rows;
        rate = last / (await whenDrawn(gl, start));
        this.rate = this.rate > 0 ? Math.min(this.rate, rate) : rate;
        if (ends()) return;
      }
    }
    deep.present(renderer);
    this.wholeMs = performance.now() - begun;
    this.whole = !this.interrupted;
  }
}
