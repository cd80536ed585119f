// The colours of a map as a texture.

import {colorTable, kColorMapEntries, type ColorMapName} from '../core/picture/color_maps';
import type {Graphics} from './gl/graphics';
import {Texture} from './gl/texture';

export class ColorTable {
  readonly texture: Texture;
  private readonly values = new Uint8Array(4 * kColorMapEntries);
  private shown = '';

  constructor(graphics: Graphics) {
    this.texture = new Texture(graphics, this.values, kColorMapEntries, 1, 'rgba8');
  }

  show(map: ColorMapName, reversed: boolean): void {
    const name = `${map} ${reversed}`;
    if (name === this.shown) return;
    this.values.set(colorTable(map, reversed));
    this.texture.update();
    this.shown = name;
  }
}
