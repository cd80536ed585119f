// Collects the points of lines.

import type {FieldScale} from '../picture/field_scale';
import {kLineWidth, type LineSoup} from '../picture/streamlines';
import type {Vector} from '../protocol/geometry';
import type {LinePoints} from './trace';
import type {VectorWalk} from './vector_walk';

/** More would take more memory and time than a page has: 24 MB. */
export const kMostLinePoints = 1_000_000;

/** Collects lines. The two directions of one are added one after the other. */
export class LineBuilder implements LinePoints {
  lines = 0;
  private points = new Float32Array(1024 * kLineWidth);
  private size = 0;
  /** Where the line in hand begins. */
  private from = 0;

  /** Null: the lines have no colour. */
  constructor(private readonly scale: FieldScale | null) {}

  get isFull(): boolean {
    return this.size >= kMostLinePoints * kLineWidth;
  }

  add([x, y, z]: Vector, time: number, walk: VectorWalk): void {
    if (this.isFull) return;
    const at = this.size;
    if (at + kLineWidth > this.points.length) {
      const larger = new Float32Array(2 * this.points.length);
      larger.set(this.points);
      this.points = larger;
    }
    const {points} = this;
    points[at] = x;
    points[at + 1] = y;
    points[at + 2] = z;
    points[at + 3] = this.scale ? walk.valueOf(this.scale) : NaN;
    points[at + 4] = time;
    points[at + 5] = this.lines;
    this.size += kLineWidth;
  }

  /** The points of the line in hand go in the other order. */
  turn(): void {
    const {points, from} = this;
    for (let a = from, b = this.size - kLineWidth; a < b; a += kLineWidth, b -= kLineWidth) {
      for (let i = 0; i < kLineWidth; ++i) {
        const other = points[a + i]!;
        points[a + i] = points[b + i]!;
        points[b + i] = other;
      }
    }
  }

  /** Ends the line in hand. Gives its numbers, kLineWidth a point; null if it has no segment. */
  end(): Float32Array | null {
    const its = this.points.subarray(this.from, this.size);
    if (its.length < 2 * kLineWidth) {
      this.size = this.from;
      return null;
    }
    ++this.lines;
    this.from = this.size;
    return its;
  }

  take(crossing: number, isCut: boolean): LineSoup {
    const {lines} = this;
    const points = this.points.slice(0, this.size);
    return {points, lines, crossing, isCut: isCut || this.isFull};
  }
}
