// The cells of a volume as textures for a ray caster's shaders. They have one texel a vertex and a
// cell, and the faces by which rays enter.

import {
  BufferGeometry,
  DataTexture,
  FloatType,
  NearestFilter,
  RGBAFormat,
  RGBAIntegerFormat,
  RGIntegerFormat,
  RedFormat,
  Sphere,
  UnsignedIntType,
  Vector3,
  type PixelFormat,
  type TextureDataType,
} from 'three';
import type {Vector} from '../core/protocol/geometry';
import {cellAround} from '../core/picture/cell_entry';
import type {VolumeCells} from '../core/picture/volume';

/**
 * Texels in a row: a power of two. Nearly every GPU with WebGL 2 takes such rows, most of them four
 * times as many: sixteen million cells.
 */
export const kRowBits = 12;
export const kRow = 1 << kRowBits;

export class CellTextures {
  readonly vertices: DataTexture;
  readonly links: DataTexture;
  readonly entries: DataTexture;
  readonly cellValues: DataTexture;
  readonly ofCells: boolean;
  readonly count: number;
  /** One triangle for each entry. The shader reads it from `entries`. */
  readonly entryGeometry = new BufferGeometry();
  /** The last question, and its answer. */
  private eye = '';
  private cellOfEye = -1;

  constructor(private readonly from: VolumeCells) {
    this.vertices = rows(from.vertices, 4, RGBAFormat, FloatType);
    this.links = rows(from.links, 2, RGIntegerFormat, UnsignedIntType);
    this.entries = rows(from.entries, 4, RGBAIntegerFormat, UnsignedIntType);
    this.cellValues = rows(from.cellValues ?? new Float32Array(1), 1, RedFormat, FloatType);
    this.ofCells = from.cellValues !== null;
    this.count = from.cells.length / 4;
    this.entryGeometry.setDrawRange(0, (3 * from.entries.length) / 8);
    // there are no positions to compute it from
    this.entryGeometry.boundingSphere = new Sphere(new Vector3(), Infinity);
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
    this.entryGeometry.dispose();
  }
}

/** The rows of the largest texture of these cells. */
export function maxRows({vertices, links, entries}: VolumeCells): number {
  return Math.max(heightOf(vertices, 4), heightOf(links, 2), heightOf(entries, 4));
}

function heightOf(values: {length: number}, size: number): number {
  return Math.max(1, Math.ceil(values.length / (size * kRow)));
}

function rows(
  values: Float32Array | Uint32Array,
  size: number,
  format: PixelFormat,
  type: TextureDataType,
): DataTexture {
  const height = heightOf(values, size);
  const filled = new (values.constructor as Float32ArrayConstructor)(size * kRow * height);
  filled.set(values);
  return dataTexture(filled, kRow, height, format, type);
}

/** RGBA in one row. */
export function tableTexture(values: Float32Array): DataTexture {
  return dataTexture(values, values.length / 4, 1, RGBAFormat, FloatType);
}

function dataTexture(
  values: Float32Array,
  width: number,
  height: number,
  format: PixelFormat,
  type: TextureDataType,
): DataTexture {
  const texture = new DataTexture(values, width, height, format, type);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}
