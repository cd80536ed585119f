// The boxes of a grid over the lattice that a surface passes through. They are the parts of a log
// of regions that an isosurface needs, as far as is known.

import {kBoxSteps, type PacketBox} from './packet';

/** Boxes along an axis. A packet's box is given in 256ths, each of which lies in one of these. */
const kGridSteps = 16;

/**
 * One byte a box, x fastest; null if there are no corners. A byte is 1 if a corner lies in the box
 * or beside it, because a finer mesh has the surface elsewhere. `size` is the lattice's.
 */
export function surfaceBoxesOf(positions: Float32Array, size: number): Uint8Array | null {
  if (positions.length === 0) return null;
  const boxes = new Uint8Array(kGridSteps ** 3);
  for (let at = 0; at < positions.length; at += 3) boxes[boxAt(positions, at, size)] = 1;
  const grown = new Uint8Array(boxes.length);
  const range = (at: number): [number, number] => [
    Math.max(0, at - 1),
    Math.min(kGridSteps - 1, at + 1),
  ];
  boxes.forEach((inside, i) => {
    if (inside === 0) return;
    forBoxes(placeOf(i).map(range), (near) => void (grown[near] = 1));
  });
  return grown;
}

export function meets(boxes: Uint8Array, box: PacketBox): boolean {
  let found = false;
  const scale = kBoxSteps / kGridSteps;
  forBoxes(
    [0, 1, 2].map(
      (axis) =>
        [Math.floor(box[axis]! / scale), Math.floor(box[axis + 3]! / scale)] as [number, number],
    ),
    (i) => void (found ||= boxes[i] === 1),
  );
  return found;
}

/** The bounds of all boxes that are 1, as shares of the lattice. REQUIRES: there is one. */
export function boundsOfBoxes(boxes: Uint8Array): number[] {
  const bounds = [1, 1, 1, 0, 0, 0];
  boxes.forEach((inside, i) => {
    if (inside === 0) return;
    placeOf(i).forEach((at, axis) => {
      bounds[axis] = Math.min(bounds[axis]!, at / kGridSteps);
      bounds[axis + 3] = Math.max(bounds[axis + 3]!, (at + 1) / kGridSteps);
    });
  });
  return bounds;
}

const placeOf = (i: number): number[] => [
  i % kGridSteps,
  Math.floor(i / kGridSteps) % kGridSteps,
  Math.floor(i / kGridSteps ** 2),
];

function boxAt(positions: Float32Array, at: number, size: number): number {
  const step = (axis: number): number =>
    Math.min(kGridSteps - 1, Math.floor((positions[at + axis]! / size) * kGridSteps));
  return step(0) + kGridSteps * (step(1) + kGridSteps * step(2));
}

function forBoxes(ranges: [number, number][], use: (i: number) => void): void {
  const [[x0, x1], [y0, y1], [z0, z1]] = ranges as [
    [number, number],
    [number, number],
    [number, number],
  ];
  for (let z = z0; z <= z1; ++z)
    for (let y = y0; y <= y1; ++y)
      for (let x = x0; x <= x1; ++x) use(x + kGridSteps * (y + kGridSteps * z));
}
