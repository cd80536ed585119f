// The cells of a volume and their textures.

import type {VolumeCells} from '../core/picture/volume';
import {CellTextures} from './cell_textures';
import type {Graphics} from './gl/graphics';

export class CellMesh {
  /** May differ from `of`: a picture that is being drawn keeps its cells. */
  requested: VolumeCells | null = null;
  of: VolumeCells | null = null;
  /** Those of `of`. */
  shown: CellTextures | null = null;
  /**
   * The layers of a picture that is drawn at once: as many as the previous one needed, and often
   * one more.
   */
  layers = 1;

  constructor(private readonly graphics: Graphics) {}

  /** Takes the requested cells. REQUIRES: no picture is being drawn. */
  update(): void {
    if (this.requested === this.of) return;
    this.shown?.dispose();
    this.of = this.requested;
    this.shown = this.of && new CellTextures(this.graphics, this.of);
  }
}
