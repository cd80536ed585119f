// The cells of a volume and their textures.

import type {VolumeCells} from '../core/picture/volume';
import {CellTextures, kRow, maxRows} from './cell_textures';
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

  /** Reports an error, and requests none, if the cells do not fit into the graphics' textures. */
  request(cells: VolumeCells | null): void {
    const maxSize = this.graphics.maxTextureSize;
    const fits = !cells || maxRows(cells) <= maxSize;
    this.requested = fits ? cells : null;
    if (fits) return;
    const most = ((maxSize * kRow) / 4e6).toFixed(1);
    reportError(
      new Error(
        `the graphics take no volume of more than ${most} million cells; set Refine to fewer`,
      ),
    );
  }

  /** Takes the requested cells. REQUIRES: no picture is being drawn. */
  update(): void {
    if (this.requested === this.of) return;
    this.shown?.dispose();
    this.of = this.requested;
    this.shown = this.of && new CellTextures(this.graphics, this.of);
  }
}
