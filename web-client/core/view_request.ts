// What the viewer looks at, and which packets of a log of regions to fetch first for it. In lattice
// coordinates; a box is a packet's, in 256ths of the lattice.

import type {Vector} from './cell_ray';
import {boundsOfBoxes, meets} from './surface_boxes';
import {kBoxSteps, type Packet, type PacketBox} from './packet';
import type {Plane} from './slice';

export interface ViewRequest {
  /** Up to 6: inside are the points with normal . p >= offset. Empty: everything is in sight. */
  frustum: Plane[];
  /** What lies on them is wanted. */
  planes: Plane[];
  /** What is near it comes first. */
  point: Vector | null;
  /**
   * What meets them is wanted, too (surface_boxes.ts): isosurfaces, of which the worker knows where
   * they are.
   */
  surfaceBoxes?: Uint8Array | null;
  /** The same for a server, which knows better where they will be. */
  isovalue?: Isovalue | null;
}

/** As proto/PROTOCOL.md has it. */
export interface Isovalue {
  field: string;
  component?: number;
  values: number[];
}

export const kNoViewRequest: ViewRequest = {frustum: [], planes: [], point: null};

/** Least and largest of normal . p over the box. */
function reach(box: PacketBox, size: number, normal: readonly number[]): [number, number] {
  let low = 0;
  let high = 0;
  for (let axis = 0; axis < 3; ++axis) {
    const from = (normal[axis]! * box[axis]! * size) / kBoxSteps,
      to = (normal[axis]! * (box[axis + 3]! + 1) * size) / kBoxSteps;
    low += Math.min(from, to);
    high += Math.max(from, to);
  }
  return [low, high];
}

/**
 * 0 for what is in sight and on a plane or in a surface's box, 3 for what is neither. Never above
 * that of a box within this one, so that parents come before children.
 */
export function urgency(
  {frustum, planes, surfaceBoxes}: ViewRequest,
  box: PacketBox,
  size: number,
): number {
  const inSight = frustum.every(({normal, offset}) => reach(box, size, normal)[1] >= offset);
  const onPlane =
    (surfaceBoxes ? meets(surfaceBoxes, box) : planes.length === 0) ||
    planes.some(({normal, offset}) => {
      const [low, high] = reach(box, size, normal);
      return low <= offset && offset <= high;
    });
  return (inSight ? 0 : 2) + (onPlane ? 0 : 1);
}

/** Squared, from the point to the nearest of the box. */
function distance(point: Vector, box: PacketBox, size: number): number {
  return point.reduce((sum, x, axis) => {
    const outside = Math.max(
      0,
      (box[axis]! * size) / kBoxSteps - x,
      x - ((box[axis + 3]! + 1) * size) / kBoxSteps,
    );
    return sum + outside * outside;
  }, 0);
}

/**
 * The packets as they should come: the urgent before the others, of these coarse before fine, near
 * before far. `size`: of the lattice along an axis.
 */
export function inOrder(packets: readonly Packet[], view: ViewRequest, size: number): Packet[] {
  const keys = new Map(
    packets.map((packet) => [
      packet,
      [
        urgency(view, packet.box, size),
        packet.depth,
        view.point ? distance(view.point, packet.box, size) : 0,
        packet.chunk,
      ],
    ]),
  );
  return [...packets].sort((a, b) => {
    const [ka, kb] = [keys.get(a)!, keys.get(b)!];
    const i = ka.findIndex((value, k) => value !== kb[k]);
    return i < 0 ? 0 : ka[i]! - kb[i]!;
  });
}

export interface WireLattice {
  origin: readonly number[];
  step: number;
  /** Along an axis. */
  size: number;
}

/** As proto/PROTOCOL.md has it, in the mesh's own unit; null: nothing is asked for. */
export function wireView(
  {frustum, planes, point, surfaceBoxes, isovalue}: ViewRequest,
  {origin, step, size}: WireLattice,
): Record<string, unknown> | null {
  const shift = (normal: readonly number[]): number =>
    normal.reduce((sum, x, axis) => sum + x * origin[axis]!, 0);
  // normal . (p - origin) / step = offset
  const plane = ({normal, offset}: Plane): number[] => [
    ...normal,
    -(offset * step + shift(normal)),
  ];
  const wire: Record<string, unknown> = {};
  if (frustum.length > 0) wire.frustum = frustum.map(plane);
  if (planes.length > 0) wire.planes = planes.map(plane);
  // Either would do, and the box asks for more.
  if (isovalue) wire.isovalue = isovalue;
  else if (surfaceBoxes)
    wire.box = boundsOfBoxes(surfaceBoxes).map((share, i) => origin[i % 3]! + step * size * share);
  if (point) wire.point = point.map((x, axis) => origin[axis]! + step * x);
  return Object.keys(wire).length > 0 ? wire : null;
}
