// From a field's integers to one number a vertex (or a cell): the value, a component, or the
// magnitude of a vector, in [0, 1] over a range that does not change while the mesh refines.

import type {FieldInfo} from './manifest';

/** The integer of a value that is missing (codec/mesh.h). */
const kMissing = -2147483648;
/**
 * Instead of a component: the magnitude of all of them, or the value itself where there is but one.
 */
export const kMagnitude = -1;

/**
 * What a colour, an isosurface or a threshold goes by: field `field` of the manifest, one component
 * of it or kMagnitude.
 */
export interface Scalar {
  field: number;
  component: number;
}

/**
 * What 0 and 1 mean for this scalar. The manifest knows the range of values and magnitudes; a
 * component stays within the largest magnitude.
 */
export function scalarRange(info: FieldInfo, component: number): [number, number] {
  if (component === kMagnitude || info.components === 1) return info.range;
  const most = Math.max(Math.abs(info.range[0]), Math.abs(info.range[1]));
  return [-most, most];
}

export class FieldScale {
  readonly ofCells: boolean;
  private readonly low: number;
  private readonly inverseSpan: number;
  private readonly components: number;
  private readonly step: number;
  private readonly minimum: number[];

  /** `values` holds `info.components` integers a vertex, or a cell of a cell field. */
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
   * NaN where a value is missing. Relative to the range, so that a small range round a large value
   * keeps its digits in 32-bit floats.
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
   * Smallest and largest that occurs in these cells, in [0, 1]; [0, 1] where nothing does. Holes,
   * cells of one vertex, hold what is no value.
   */
  extent(tetrahedra: Uint32Array): [number, number] {
    const occurs = new Uint8Array(this.size);
    for (let cell = 0, at = 0; at < tetrahedra.length; ++cell, at += 4) {
      if (tetrahedra[at] === tetrahedra[at + 1]) continue;
      if (this.ofCells) occurs[cell] = 1;
      else for (let i = at; i < at + 4; ++i) occurs[tetrahedra[i]!] = 1;
    }
    let low = Infinity;
    let high = -Infinity;
    for (let i = 0; i < occurs.length; ++i) {
      if (occurs[i] === 0) continue;
      const value = this.at(i);
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return low <= high ? [low, high] : [0, 1];
  }
}
