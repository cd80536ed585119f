// Pictures that are drawn in tiles, apart from the canvas, because they may be larger than it and
// than the graphics allow.

import type {Graphics} from './gl/graphics';
import {Target} from './gl/target';
import type {Frame, Tile} from './view';

/** The side of a tile: every WebGL 2 draws it, and four samples a pixel and depths take 128 MB. */
const kTilePixels = 2048;
/** Every WebGL 2 has four samples a pixel. */
const kSamples = 4;

/** A part of a picture, in pixels from its upper left corner. */
export interface Part {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** The parts of a picture, row by row. */
export function partsOf({width, height}: Pick<Frame, 'width' | 'height'>): Part[] {
  const parts: Part[] = [];
  for (let y = 0; y < height; y += kTilePixels)
    for (let x = 0; x < width; x += kTilePixels)
      parts.push({
        x,
        y,
        width: Math.min(kTilePixels, width - x),
        height: Math.min(kTilePixels, height - y),
      });
  return parts;
}

/** Draws a part by `draw`, which must draw onto the target. */
export async function tileOf(
  graphics: Graphics,
  {x, y, width, height}: Part,
  draw: (target: Target) => void | Promise<void>,
): Promise<Tile> {
  const target = new Target(graphics, {kind: 'rgba8', depths: 'buffer', samples: kSamples});
  target.resize(width, height);
  try {
    await draw(target);
    const pixels = target.read();
    straighten(pixels);
    const image = new ImageData(pixels, width, height);
    return {x, y, bitmap: await createImageBitmap(image, {imageOrientation: 'flipY'})};
  } finally {
    target.dispose();
  }
}

/** Graphics multiply colours by their opacity, and pictures do not. */
export function straighten(pixels: Uint8ClampedArray): void {
  for (let at = 0; at < pixels.length; at += 4) {
    const alpha = pixels[at + 3]!;
    if (alpha === 0 || alpha === 255) continue;
    for (let i = at; i < at + 3; ++i) pixels[i] = (255 * pixels[i]!) / alpha;
  }
}
