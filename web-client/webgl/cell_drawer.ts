// Draws cells: at once, or in strips of pixels with pauses in which the graphics are free.

import type {CellMesh} from './cell_mesh';
import {DeepTarget} from './deep_target';
import {reachesPixels, whenDrawn} from './frame_budget';
import type {Graphics} from './gl/graphics';
import type {Target} from './gl/target';
import type {Eye} from './lens';
import type {Sight} from './mesh_camera';
import type {MeshParts} from './mesh_parts';
import {RayCaster} from './ray_caster';

/** The time of a strip, about. */
const kStripMs = 120;
/**
 * The pixels of the first strip, whose time is unknown. Without a GPU it takes some tenths of
 * kStripMs.
 */
const kFirstPixels = 1 << 14;
/** The most pixels of a strip, as a multiple of the previous strip's. */
const kStripGrowth = 2;
/**
 * The most times that a line of sight enters the mesh. Cells behind hundreds of walls cannot be
 * told apart, and every layer takes its passes.
 */
const kMaxLayers = 256;

/** The parts of a picture. */
export interface Picture extends Sight {
  parts: MeshParts;
  eyeOfParts: Eye;
  /** Null: the canvas. */
  target: Target | null;
}

export class CellDrawer {
  readonly caster: RayCaster;
  private readonly deep: DeepTarget;
  /** The pixels a millisecond in the slowest strip of the last picture; 0: unknown. */
  private rate = 0;

  constructor(private readonly graphics: Graphics) {
    this.caster = new RayCaster(graphics);
    this.deep = new DeepTarget(graphics);
  }

  /**
   * Draws with a share of the canvas's pixels. `isCut`: some lines of sight need more layers.
   * `ms` is the time of the graphics.
   */
  async drawAtOnce(
    picture: Picture,
    its: CellMesh,
    share: number,
  ): Promise<{ms: number; isCut: boolean}> {
    const {caster, deep} = this;
    const {gl} = this.graphics;
    const start = performance.now();
    if (this.begin(picture, its, share, deep)) caster.cast(deep, 0, deep.height);
    const reached: Promise<boolean>[] = [];
    while (reached.length < its.layers) {
      reached.push(reachesPixels(gl, () => caster.enter()));
      caster.cast(deep, 0, deep.height);
    }
    deep.present(null);
    const ms = await whenDrawn(gl, start);
    const needed = (await Promise.all(reached)).filter(Boolean).length;
    const isCut = needed === its.layers && needed < kMaxLayers;
    its.layers = Math.min(needed + 1, kMaxLayers);
    return {ms, isCut};
  }

  /**
   * Draws all pixels and layers. Returns its time in ms. Asks `ends` after each strip whether to
   * give up, and then returns null.
   */
  async drawStrips(picture: Picture, its: CellMesh, ends: () => boolean): Promise<number | null> {
    const {target} = picture;
    // what was drawn for the canvas may be presented again
    const deep = target ? new DeepTarget(this.graphics) : this.deep;
    try {
      const ms = await this.drawRows(picture, its, deep, ends);
      if (ms !== null) deep.present(target);
      return ms;
    } finally {
      if (deep !== this.deep) deep.dispose();
    }
  }

  /** As drawStrips, without presenting. */
  private async drawRows(
    picture: Picture,
    its: CellMesh,
    deep: DeepTarget,
    ends: () => boolean,
  ): Promise<number | null> {
    const {caster} = this;
    const {gl} = this.graphics;
    const begun = performance.now();
    let last = this.rate > 0 ? Infinity : 0; // pixels of the previous strip
    let rate = this.rate;
    this.rate = 0;
    const isInside = this.begin(picture, its, 1, deep);
    for (let layer = isInside ? -1 : 0; layer < kMaxLayers; ++layer) {
      const reaches = layer < 0 || reachesPixels(gl, () => caster.enter());
      if (layer > 0 && !(await reaches)) break;
      for (let row = 0; row < deep.height;) {
        const maxPixels = rate > 0 ? Math.min(rate * kStripMs, kStripGrowth * last) : kFirstPixels;
        const rows = Math.min(deep.height - row, Math.ceil(maxPixels / deep.width));
        last = rows * deep.width;
        const start = performance.now();
        caster.cast(deep, row, rows);
        row += rows;
        rate = last / (await whenDrawn(gl, start));
        this.rate = this.rate > 0 ? Math.min(this.rate, rate) : rate;
        if (ends()) return null;
      }
    }
    return performance.now() - begun;
  }

  /** Shows the last picture again on a canvas that has been cleared. */
  present(): void {
    this.deep.present(null);
  }

  dispose(): void {
    this.deep.dispose();
    this.caster.dispose();
  }

  /** Returns true if the eye is inside a cell, as RayCaster.begin. */
  private begin(
    {parts, eyeOfParts, target, ...sight}: Picture,
    its: CellMesh,
    share: number,
    deep: DeepTarget,
  ): boolean {
    const {width, height} = target ?? this.graphics.surface;
    deep.resize(Math.round(width * share), Math.round(height * share));
    deep.begin(parts, eyeOfParts);
    return this.caster.begin(its.shown!, sight, deep);
  }
}
