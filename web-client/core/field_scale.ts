// From a field's integers to one number a vertex: the value, or the magnitude of a vector, in [0, 1] over the field's range.

import type {FieldInfo} from './manifest';

/** The integer of a value that is missing (codec/mesh.h, kGap). */
const kGap = -2147483648;

export class FieldScale {
  private readonly low: number;
  private readonly inverseSpan: number;
  private readonly components: number;
  private readonly step: number;
  private readonly minimum: number[];

  /** `values` holds `info.components` integers a vertex. */
  constructor(private readonly values: Int32Array, info: FieldInfo) {
    const span = info.range[1] - info.range[0];
    this.low = info.range[0];
    this.inverseSpan = span > 0 ? 1 / span : 0;
    this.components = info.components;
    this.step = info.step;
    this.minimum = info.minimum;
  }

  /** NaN where a value is missing. Relative to the range, so that a small range round a large value keeps its digits in 32-bit floats. */
  at(vertex: number): number {
    if (this.components === 1) {
      const integer = this.values[vertex]!;
      return integer === kGap ? NaN : (this.minimum[0]! + this.step * integer - this.low) * this.inverseSpan;
    }
    let sum = 0;
    for (let c = 0; c < this.components; ++c) {
      const integer = this.values[vertex * this.components + c]!;
      if (integer === kGap) return NaN;
      const value = this.minimum[c]! + this.step * integer;
      sum += value * value;
    }
    return (Math.sqrt(sum) - this.low) * this.inverseSpan;
  }
}
