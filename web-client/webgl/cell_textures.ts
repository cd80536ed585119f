// The cells of a volume as textures for a ray caster's shaders. They have one texel a vertex and a
// cell, and the faces by which rays enter.

import type {Vector} from '../core/protocol/geometry';
import {cellAround} from '../core/picture/cell_entry';
import type {VolumeCells} from '../core/picture/volume';
import type {Graphics} from './gl/graphics';
import {Texture, type TexelKind} from './gl/texture';

/**
 * Texels in a row: a power of two. Nearly every GPU with WebGL 2 takes such rows, most of them four
 * times as many: sixteen million cells.
 */
export const kRowBits = 12;
export const kRow = 1 << kRowBits;

export class CellTextures {
  readonly vertices: Texture;
  readonly links: Texture;
  readonly entries: Texture;
  readonly cellValues: Texture;
  readonly ofCells: boolean;
  readonly count: number;
  /** The corners of one triangle for each entry. The shader reads it from `entries`. */
  readonly entryCorners: number;
  /** The last question, and its answer. */
  private eye = '';
  private cellOfEye = -1;

  constructor(
    graphics: Graphics,
    private readonly from: VolumeCells,
  ) {
    this.vertices = rows(graphics, from.vertices, 'rgba32f');
    this.links = rows(graphics, from.links, 'rg32ui');
    this.entries = rows(graphics, from.entries, 'rgba32ui');
    this.cellValues = rows(graphics, from.cellValues ?? new Float32Array(1), 'r32f');
    this.ofCells = from.cellValues !== null;
    this.count = from.cells.length / 4;
    this.entryCorners = (3 * from.entries.length) / 8;
  }

  /** The cell that contains the eye, as its corners and its tag; null if none does. */
  eyeCell(eye: Vector): Uint32Array | null {
    if (eye.join() !== this.eye)
      this.cellOfEye = cellAround(this.from.vertices, this.from.cells, eye);
    this.eye = eye.join();
    const cell = this.cellOfEye;
    return cell < 0
      ? null
      : Uint32Array.of(...this.from.cells.subarray(4 * cell, 4 * cell + 4), this.from.tags[cell]!);
  }

  dispose(): void {
    for (const texture of [this.vertices, this.links, this.entries, this.cellValues])
      texture.dispose();
  }
}

/** The rows of the largest texture of these cells. */
export function maxRows({vertices, links, entries}: VolumeCells): number {
  return Math.max(heightOf(vertices, 4), heightOf(links, 2), heightOf(entries, 4));
}

function heightOf(values: {length: number}, size: number): number {
  return Math.max(1, Math.ceil(values.length / (size * kRow)));
}

const kChannels = {r32f: 1, rg32ui: 2, rgba32f: 4, rgba32ui: 4};

function rows(
  graphics: Graphics,
  values: Float32Array | Uint32Array,
  kind: keyof typeof kChannels & TexelKind,
): Texture {
  const size = kChannels[kind];
  const height = heightOf(values, size);
  const filled = new (values.constructor as Float32ArrayConstructor)(size * kRow * height);
  filled.set(values);
  return new Texture(graphics, filled, kRow, height, kind);
}
