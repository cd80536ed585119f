// The places from which lines begin. They are fixed in space, so that a line stays where it is
// while the mesh refines, and while time plays.

import {sideways} from '../picture/cell_ray';
import type {Seeds} from '../picture/streamlines';
import {sidesOf, type Vector} from '../protocol/geometry';

/** [x0, y0, z0, x1, y1, z1], on the lattice. */
export type Box = readonly number[];

/** Places to choose from, for each line that is wanted. */
const kChoice = 12;
/** A box that is rounded to this share of its largest side hardly changes while a mesh refines. */
const kBoxShare = 1 / 64;
/** Powers of 1 / this number spread evenly in three dimensions (Roberts 2018). */
const kPlastic = 1.2207440846057596;
const kSpread = [1 / kPlastic, 1 / kPlastic ** 2, 1 / kPlastic ** 3];
const kGolden = Math.PI * (3 - Math.sqrt(5));

/** Places along the longer side of a plane that tell how much of it is in the mesh. */
const kProbesAlong = 64;

/**
 * Candidates for `even`; all for the others. Some may lie outside the mesh. `isIn` says which of
 * some places lie in it.
 */
export function placesOf(
  seeds: Seeds,
  box: Box,
  isIn: (places: readonly Vector[]) => boolean[],
): Vector[] {
  switch (seeds.kind) {
    case 'even':
      return spread(rounded(box), kChoice * seeds.count);
    case 'line':
      return onLine(seeds);
    case 'plane':
      return onPlane(seeds, rounded(box), isIn);
    case 'sphere':
      return inSphere(seeds);
  }
}

function rounded(box: Box): number[] {
  const unit = Math.max(1, kBoxShare * Math.max(...sidesOf(box)));
  return box.map((x, i) => unit * (i < 3 ? Math.floor(x / unit) : Math.ceil(x / unit)));
}

function spread([x0, y0, z0, x1, y1, z1]: readonly number[], count: number): Vector[] {
  const shareOf = (i: number, axis: number): number => (0.5 + (i + 1) * kSpread[axis]!) % 1;
  return Array.from({length: count}, (_, i) => [
    x0! + shareOf(i, 0) * (x1! - x0!),
    y0! + shareOf(i, 1) * (y1! - y0!),
    z0! + shareOf(i, 2) * (z1! - z0!),
  ]);
}

const onLine = ({from, to, count}: Extract<Seeds, {kind: 'line'}>): Vector[] =>
  Array.from({length: count}, (_, i) => {
    const share = count > 1 ? i / (count - 1) : 0.5;
    return from.map((x, axis) => x + share * (to[axis]! - x)) as Vector;
  });

/** The grid covers the part of the plane that is in the mesh. */
function onPlane(
  {normal, offset, count}: Extract<Seeds, {kind: 'plane'}>,
  box: Box,
  isIn: (places: readonly Vector[]) => boolean[],
): Vector[] {
  const across = acrossOf(normal);
  const grid = (around: readonly Vector[], along: number): Vector[] => {
    const extents = across.map((direction) => extentOf(around, direction));
    const side = Math.max(...extents.map(([from, to]) => to - from)) / along;
    const [us, vs] = extents.map(([from, to]) => {
      const steps = Math.max(1, Math.round((to - from) / side));
      return Array.from({length: steps}, (_, i) => from + ((i + 0.5) / steps) * (to - from));
    }) as [number[], number[]];
    return placesAt({normal, offset}, across, us, vs);
  };
  const probes = grid(cornersOf(box), kProbesAlong);
  const are = isIn(probes);
  const inside = probes.filter((_, i) => are[i]);
  return inside.length > 1 ? grid(inside, count) : inside;
}

/** Places of a plane at equal distances, over a box. They are fixed in the plane. */
export function planePlaces(
  {normal, offset}: {normal: readonly number[]; offset: number},
  box: Box,
  spacing: number,
): Vector[] {
  const across = acrossOf(normal as Vector);
  const [us, vs] = across.map((direction) => {
    const [from, to] = extentOf(cornersOf(box), direction);
    const first = Math.ceil(from / spacing);
    const count = Math.max(0, Math.floor(to / spacing) - first + 1);
    return Array.from({length: count}, (_, i) => (first + i) * spacing);
  }) as [number[], number[]];
  return placesAt({normal, offset}, across, us, vs);
}

/** The places of a plane at these numbers along two directions. */
const placesAt = (
  {normal, offset}: {normal: readonly number[]; offset: number},
  [u, v]: readonly [Vector, Vector],
  us: readonly number[],
  vs: readonly number[],
): Vector[] =>
  vs.flatMap((b) =>
    us.map((a) => normal.map((n, i) => offset * n + a * u[i]! + b * v[i]!) as Vector),
  );

const cornersOf = (box: Box): Vector[] =>
  Array.from(
    {length: 8},
    (_, i) => [0, 1, 2].map((axis) => box[axis + ((i >> axis) & 1) * 3]!) as Vector,
  );

/** Two directions of length 1 across another one, and across each other. */
const acrossOf = (normal: Vector): [Vector, Vector] =>
  sideways(normal).map((its) => its.map((x) => x / Math.hypot(...its))) as [Vector, Vector];

function extentOf(corners: readonly Vector[], direction: Vector): [number, number] {
  const at = corners.map((corner) => corner.reduce((sum, x, i) => sum + x * direction[i]!, 0));
  return [Math.min(...at), Math.max(...at)];
}

/** Even in its volume. */
const inSphere = ({centre, radius, count}: Extract<Seeds, {kind: 'sphere'}>): Vector[] =>
  Array.from({length: count}, (_, i) => {
    const share = (i + 0.5) / count;
    const z = 1 - 2 * share;
    const r = radius * Math.cbrt((0.5 + (i + 1) * kSpread[0]!) % 1);
    const across = r * Math.sqrt(1 - z * z);
    const turn = kGolden * i;
    return [
      centre[0] + across * Math.cos(turn),
      centre[1] + across * Math.sin(turn),
      centre[2] + r * z,
    ];
  });
