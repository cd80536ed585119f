// How a value looks inside the volume: its colour from the map, its extinction from opacities at
// even shares of the shown range.

import {colorTable, kColorMapEntries, type ColorMapName} from './color_maps';

/** Opacities apply to a path of this share of the mesh's diagonal. */
export const kOpacityPath = 0.1;
/** A higher opacity would need an almost infinite density. */
export const kMaxOpacity = 0.99;
/**
 * On a dark ground a colour's largest channel is this far from black at least. All channels grow by
 * one factor, so that the hue stays.
 */
const kDarkFloor = 0.4;
/** Black then gets this share of white. Lighter colours get less, so that they stay saturated. */
const kDarkWhite = 0.2;
/** Fine enough to take the nearest step. */
export const kTransferSteps = 1023;

export interface TransferTables {
  /** RGBA at steps 0 to kTransferSteps: colour times extinction, and extinction per diagonal. */
  density: Float32Array;
  /** The same, integrated from share 0 to each step. */
  integral: Float32Array;
}

/** The extinction, per diagonal, of an opacity. */
export function extinctionOf(opacity: number): number {
  return -Math.log(1 - Math.min(kMaxOpacity, Math.max(0, opacity))) / kOpacityPath;
}

/**
 * `onDark`: colours are lifted off a dark ground. REQUIRES: at least two opacities. Between them
 * extinction is linear.
 */
export function transferTables(
  opacities: readonly number[],
  map: ColorMapName,
  reversed: boolean,
  onDark = false,
): TransferTables {
  const colors = onDark ? lifted(colorTable(map, reversed)) : colorTable(map, reversed);
  const extinctions = opacities.map(extinctionOf);
  const density = new Float32Array(4 * (kTransferSteps + 1));
  const integral = new Float32Array(density.length);
  for (let i = 0; i <= kTransferSteps; ++i) {
    const at = (i / kTransferSteps) * (extinctions.length - 1);
    const k = Math.min(Math.floor(at), extinctions.length - 2);
    const extinction = extinctions[k]! + (at - k) * (extinctions[k + 1]! - extinctions[k]!);
    const color = (i / kTransferSteps) * (kColorMapEntries - 1);
    const below = 4 * Math.floor(color);
    for (let c = 0; c < 3; ++c) {
      const [from, to] = [
        colors[below + c]!,
        colors[Math.min(below + 4, 4 * kColorMapEntries - 4) + c]!,
      ];
      density[4 * i + c] = (extinction * (from + (color % 1) * (to - from))) / 255;
    }
    density[4 * i + 3] = extinction;
    if (i === 0) continue;
    for (let c = 0; c < 4; ++c) {
      integral[4 * i + c] =
        integral[4 * i - 4 + c]! +
        (density[4 * i + c]! + density[4 * i - 4 + c]!) / 2 / kTransferSteps;
    }
  }
  return {density, integral};
}

function lifted(colors: Uint8Array): Uint8Array {
  const lighter = colors.slice();
  for (let at = 0; at < colors.length; at += 4) {
    const color = [...colors.subarray(at, at + 3)].map((channel) => channel / 255);
    const most = Math.max(...color, 1 / 255);
    const bright = color.map((channel) => channel * (1 - kDarkFloor + kDarkFloor / most));
    const [red, green, blue] = bright as [number, number, number];
    const white = kDarkWhite * (1 - (0.2126 * red + 0.7152 * green + 0.0722 * blue)) ** 2;
    lighter.set(
      bright.map((channel) => Math.round(255 * (white + (1 - white) * channel))),
      at,
    );
  }
  return lighter;
}
