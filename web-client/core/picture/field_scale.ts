// Turns a field's integers into one number a vertex or cell: the value, a component, or a vector's
// magnitude. The number is in [0, 1] over a range that stays the same while the mesh refines.

import type {FieldInfo} from '../protocol/fields';

/** The integer that marks a missing value (codec/mesh.h). */
export const kMissing = -2147483648;
/** The component that means the magnitude of a vector, or the value of a scalar. */
export const kMagnitude = -1;

/**
 * The quantity of a colour, an isosurface or a threshold: a field of the manifest, and a component
 * of it or kMagnitude.
 */
export interface Scalar {
  field: number;
  component: number;
}

/**
 * The values that 0 and 1 stand for. The manifest knows the range of values and magnitudes. A
 * component lies within the largest magnitude.
 */
export function scalarRange(info: FieldInfo, component: number): [number, number] {
  if (component === kMagnitude || info.components === 1) return info.range;
  const max = Math.max(Math.abs(info.range[0]), Math.abs(info.range[1]));
  return [-max, max];
}

export class FieldScale {
  readonly ofCells: boolean;
  protected readonly low: number;
  protected readonly inverseSpan: number;
  private readonly components: number;
  private readonly step: number;
  private readonly minimum: number[];

  /**
   * `values` holds `info.components` integers for each vertex, or for each cell of a cell field.
   */
  constructor(
    private readonly values: Int32Array,
    info: FieldInfo,
    private readonly component = kMagnitude,
  ) {
    const [low, high] = scalarRange(info, component);
    this.ofCells = info.association === 'cell';
    this.low = low;
    this.inverseSpan = high > low ? 1 / (high - low) : 0;
    this.components = info.components;
    this.step = info.step;
    this.minimum = info.minimum;
    if (info.components === 1) this.component = 0;
  }

  get size(): number {
    return this.values.length / this.components;
  }

  /**
   * The value at a vertex or cell, NaN if it is missing. It is relative to the range, so that a
   * small range round a large value keeps its digits in 32-bit floats.
   */
  at(index: number): number {
    if (this.component >= 0) {
      const integer = this.values[index * this.components + this.component]!;
      return integer === kMissing
        ? NaN
        : (this.minimum[this.component]! + this.step * integer - this.low) * this.inverseSpan;
    }
    let sum = 0;
    for (let c = 0; c < this.components; ++c) {
      const integer = this.values[index * this.components + c]!;
      if (integer === kMissing) return NaN;
      const value = this.minimum[c]! + this.step * integer;
      sum += value * value;
    }
    return (Math.sqrt(sum) - this.low) * this.inverseSpan;
  }

  /**
   * The smallest and the largest value in these cells, in [0, 1]; [0, 1] if there is none. Holes
   * (cells whose first two vertices are equal) do not count.
   */
  extent(tetrahedra: Uint32Array): [number, number] {
    let low = Infinity;
    let high = -Infinity;
    for (const value of this.occurring(tetrahedra)) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return low <= high ? [low, high] : [0, 1];
  }

  /** The values of these cells, one a vertex or cell, without missing ones and without holes. */
  occurring(tetrahedra: Uint32Array): Float64Array {
    const occurs = new Uint8Array(this.size);
    for (let cell = 0, at = 0; at < tetrahedra.length; ++cell, at += 4) {
      if (tetrahedra[at] === tetrahedra[at + 1]) continue;
      if (this.ofCells) occurs[cell] = 1;
      else for (let i = at; i < at + 4; ++i) occurs[tetrahedra[i]!] = 1;
    }
    const values = new Float64Array(occurs.length);
    let count = 0;
    for (let i = 0; i < occurs.length; ++i) {
      const value = occurs[i] === 0 ? NaN : this.at(i);
      if (!Number.isNaN(value)) values[count++] = value;
    }
    return values.subarray(0, count);
  }
}
