// The part of the mesh that the viewer looks at, and the order in which a log of regions brings its
// packets for it. All places are lattice coordinates; a packet's box is in 256ths of the lattice.

import type {Vector, Plane} from './geometry';
import {kBoxSteps, type Packet, type PacketBox} from './packet';
import {boundsOfBoxes, meets} from './surface_boxes';

export interface ViewRequest {
  /** Up to 6 planes, with the inside at normal . p >= offset. If empty, everything is in sight. */
  frustum: Plane[];
  /** Packets that they cut are wanted. */
  planes: Plane[];
  /** Packets near it come first. */
  point: Vector | null;
  /**
   * Packets that meet these boxes (surface_boxes.ts) are wanted, too: isosurfaces pass there, as
   * far as the worker knows.
   */
  surfaceBoxes?: Uint8Array | null;
  /** The same for a server, which knows better where the isosurfaces will be. */
  isovalue?: Isovalue | null;
}

/** Defined by proto/STREAM.md. */
export interface Isovalue {
  field: string;
  component?: number;
  values: number[];
}

export const kNoViewRequest: ViewRequest = {frustum: [], planes: [], point: null};

/** The least and the largest normal . p over the box. */
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
 * How urgent a packet is: 0 if it is in sight and on a plane or in a surface's box, 3 if it is
 * neither. A box never gets less than the box that contains it, so that parents come before
 * children.
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

/** The squared distance from the point to the box. */
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
 * The packets in the order in which they should come: by urgency, then coarse before fine, then
 * near before far. `size` is the lattice's along an axis.
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

/**
 * The request as proto/STREAM.md defines it, in the mesh's own unit; null if it asks for nothing.
 */
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
  // Either would do. The box would ask for more.
  if (isovalue) wire.isovalue = isovalue;
  else if (surfaceBoxes)
    wire.box = boundsOfBoxes(surfaceBoxes).map((share, i) => origin[i % 3]! + step * size * share);
  if (point) wire.point = point.map((x, axis) => origin[axis]! + step * x);
  return Object.keys(wire).length > 0 ? wire : null;
}
