// Chooses lines that are evenly spaced (after Jobard & Lefer 1997): one begins only where no other
// one is near. The distance shrinks until there are enough.

import {kLineWidth} from '../picture/streamlines';
import type {Vector} from '../protocol/geometry';
import type {Box} from './seeds';

/** Distances over the diagonal of the box: 1 / 3, and each time 1 / sqrt(2) of it. */
const kFirstShare = 3;
const kDistances = 12;

export class EvenLines {
  /** By distance the boxes of that size with a line in them. */
  private readonly taken = Array.from({length: kDistances}, () => new Set<number>());
  private readonly sizes: number[];

  constructor(private readonly box: Box) {
    const diagonal = Math.hypot(...[0, 1, 2].map((i) => box[i + 3]! - box[i]!));
    this.sizes = this.taken.map((_, k) => Math.max(1, diagonal / (kFirstShare * Math.SQRT2 ** k)));
  }

  /**
   * Calls `trace` with the numbers of places until it gave `count` lines. It gives the points of a
   * line, kLineWidth numbers each; null: there is none.
   */
  choose(
    places: readonly Vector[],
    count: number,
    trace: (place: number) => Float32Array | null,
  ): void {
    let left = places.map((_, place) => place);
    let lines = 0;
    for (let k = 0; k < kDistances && lines < count; ++k) {
      const later: number[] = [];
      for (const place of left) {
        if (lines === count) return;
        if (!this.isFree(k, places[place]!)) {
          later.push(place);
          continue;
        }
        const points = trace(place);
        if (!points) continue;
        this.take(points);
        ++lines;
      }
      left = later;
    }
  }

  private isFree(k: number, place: Vector): boolean {
    const [x, y, z] = this.boxesOf(k, place[0], place[1], place[2]);
    const middle = keyOf(x, y, z);
    return kAround.every((step) => !this.taken[k]!.has(middle + step));
  }

  private take(points: Float32Array): void {
    this.taken.forEach((boxes, k) => {
      for (let at = 0; at < points.length; at += kLineWidth)
        boxes.add(keyOf(...this.boxesOf(k, points[at]!, points[at + 1]!, points[at + 2]!)));
    });
  }

  private boxesOf(k: number, x: number, y: number, z: number): [number, number, number] {
    const size = this.sizes[k]!;
    const {box} = this;
    return [
      Math.floor((x - box[0]!) / size),
      Math.floor((y - box[1]!) / size),
      Math.floor((z - box[2]!) / size),
    ];
  }
}

/** Boxes are few along an axis. */
const keyOf = (x: number, y: number, z: number): number => (x * 1024 + y) * 1024 + z;

/** From the key of a box to that of itself and its 26 neighbours. */
const kAround = Array.from({length: 27}, (_, i) =>
  keyOf(Math.floor(i / 9) - 1, (Math.floor(i / 3) % 3) - 1, (i % 3) - 1),
);
