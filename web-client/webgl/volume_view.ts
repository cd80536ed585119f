// The volume on the canvas. Fast graphics draw all of it at once. Slow ones draw few cells with few
// pixels while something moves, and all cells with all pixels once it rests. They draw in strips of
// pixels, so that the next movement waits for a strip and not for the picture.

import type {transferTables} from '../core/picture/transfer';
import {kCoarseCells, type CoarseCells, type VolumeCells} from '../core/picture/volume';
import {CellDrawer, type Picture} from './cell_drawer';
import {CellMesh} from './cell_mesh';
import {CoarseMesh} from './coarse_mesh';
import {FrameBudget, kMovingMs} from './frame_budget';
import type {Graphics} from './gl/graphics';
import type {RayCaster} from './ray_caster';

/** A picture rests so long after its last change. */
const kRestMs = 150;

/** The words of transferTables and of RayCaster.setRange; null before there are any. */
export interface VolumeLook {
  transfer: Parameters<typeof transferTables> | null;
  range: Parameters<RayCaster['setRange']> | null;
}

export class VolumeView {
  private readonly fine: CellMesh;
  private readonly coarse: CoarseMesh;
  private readonly drawer: CellDrawer;
  private readonly budget = new FrameBudget();
  /** The last time for all cells and pixels; 0: unknown. */
  private wholeMs = 0;
  private inHand: Promise<void> | null = null;
  /** Another picture must follow the current one. */
  waiting = false;
  private interrupted = false;
  private whole = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `changed` asks for another picture. `askCoarse` and `works` are those of ViewListeners. */
  constructor(
    graphics: Graphics,
    private readonly changed: (moved: boolean) => void,
    askCoarse?: (have: number) => Promise<CoarseCells>,
    private readonly works: (working: boolean) => void = () => undefined,
  ) {
    this.fine = new CellMesh(graphics);
    this.coarse = new CoarseMesh(graphics, askCoarse);
    this.drawer = new CellDrawer(graphics);
  }

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
    this.fine.request(cells);
    this.whole = false;
    this.coarse.expire();
    if (this.hasCells) return;
    this.coarse.forget();
    this.interrupt();
    if (!this.busy) this.update();
  }

  setLook({transfer, range}: VolumeLook): void {
    const {caster} = this.drawer;
    if (range) caster.setRange(...range);
    if (transfer) caster.setTransfer(...transfer);
  }
  setClip(...words: Parameters<RayCaster['setClip']>): void {
    this.drawer.caster.setClip(...words);
  }

  /** The current drawing is useless now. */
  interrupt(): void {
    this.interrupted = true;
    this.whole = false;
    this.stopTimer();
  }

  /**
   * Draws as much as there is time for. The rest follows by itself. REQUIRES: not busy, hasCells.
   */
  draw(picture: Picture, moved: boolean): void {
    this.stopTimer();
    this.interrupted = this.waiting = this.whole = false;
    this.update();
    const isSlow = this.wholeMs === 0 || this.wholeMs > kMovingMs;
    const isSmall = this.fine.shown!.count <= kCoarseCells;
    if (moved && isSlow && !isSmall)
      this.coarse.refresh(() => {
        if (this.hasCells) this.changed(true);
      });
    if (!isSlow) this.start(this.drawAtOnce(picture, this.fine, 1));
    else if (moved && isSmall) this.start(this.drawAtOnce(picture, this.fine, this.budget.share()));
    else if (moved && this.coarse.isHere)
      this.start(this.drawAtOnce(picture, this.coarse, this.budget.share()));
    else if (!moved || this.coarse.isMissing)
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
  present(): void {
    this.drawer.present();
  }

  dispose(): void {
    this.interrupt();
    this.fine.requested = this.coarse.requested = null;
    this.update();
    this.drawer.dispose();
  }

  /** Takes the new cells. REQUIRES: no picture is being drawn. */
  private update(): void {
    this.fine.update();
    this.coarse.update();
  }

  private async idle(): Promise<void> {
    while (this.inHand) await this.inHand;
  }

  private stopTimer(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
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

  private async drawAtOnce(picture: Picture, its: CellMesh, share: number): Promise<void> {
    const {ms, isCut} = await this.drawer.drawAtOnce(picture, its, share);
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
    const ms = await this.drawer.drawStrips(picture, this.fine, ends);
    if (ms === null) return;
    this.wholeMs = ms;
    this.whole = !this.interrupted;
  }
}
