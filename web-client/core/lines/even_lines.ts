// Chooses lines that are evenly spaced (after Jobard & Lefer 1997): one begins only where no other
// one is near. The distance shrinks until there are enough.

import {kLineWidth} from '../picture/streamlines';
import {sidesOf, type Vector} from '../protocol/geometry';
import type {Box} from './seeds';

/** Distances over the diagonal of the box: 1 / 3, and each time 1 / sqrt(2) of it. */
const kFirstShare = 3;
const kDistances = 12;

/** The boxes of one size that have a line in them, with a margin of one box. */
class TakenBoxes {
  private readonly counts: readonly number[];
  private readonly taken: Uint8Array;
  /** From a box to itself and its 26 neighbours. */
  private readonly around: readonly number[];

  constructor(
    private readonly box: Box,
    private readonly size: number,
  ) {
    this.counts = sidesOf(box).map((side) => Math.floor(side / size) + 3);
    const [x, y, z] = this.counts;
    this.taken = new Uint8Array(x! * y! * z!);
    this.around = Array.from({length: 27}, (_, i) => {
      const [dx, dy, dz] = [(i % 3) - 1, (Math.floor(i / 3) % 3) - 1, Math.floor(i / 9) - 1];
      return (dz * y! + dy) * x! + dx;
    });
  }

  isFree([x, y, z]: Vector): boolean {
    const {around, taken} = this;
    const at = this.at(x, y, z);
    for (let i = 0; i < 27; ++i) if (taken[at + around[i]!] !== 0) return false;
    return true;
  }

  take(points: Float32Array): void {
    for (let i = 0; i < points.length; i += kLineWidth)
      this.taken[this.at(points[i]!, points[i + 1]!, points[i + 2]!)] = 1;
  }

  private at(x: number, y: number, z: number): number {
    return (
      (this.along(z, 2) * this.counts[1]! + this.along(y, 1)) * this.counts[0]! + this.along(x, 0)
    );
  }

  /** Places a little outside of the box are in its margin. */
  private along(x: number, axis: number): number {
    const box = Math.floor((x - this.box[axis]!) / this.size) + 1;
    return Math.max(1, Math.min(this.counts[axis]! - 2, box));
  }
}

/**
 * Calls `trace` with the numbers of places until it gave `count` lines. It gives the points of a
 * line, kLineWidth numbers each; null: there is none.
 */
export function chooseEven(
  box: Box,
  places: readonly Vector[],
  count: number,
  trace: (place: number) => Float32Array | null,
): void {
  const diagonal = Math.hypot(...sidesOf(box));
  const all = Array.from({length: kDistances}, (_, k) => {
    const size = Math.max(1, diagonal / (kFirstShare * Math.SQRT2 ** k));
    return new TakenBoxes(box, size);
  });
  let left = places.map((_, place) => place);
  let lines = 0;
  for (const boxes of all) {
    const later: number[] = [];
    for (const place of left) {
      if (lines === count) return;
      if (!boxes.isFree(places[place]!)) {
        later.push(place);
        continue;
      }
      const points = trace(place);
      if (!points) continue;
      ++lines;
      for (const its of all) its.take(points);
    }
    left = later;
  }
}
