// Clip planes cut the mesh open: "x", "-y:0.3", "0.6,-0.8,0:0.4", several with spaces between them.

import {keepBelow} from '../picture/cell_choice';
import type {Ray, Stretch} from '../picture/cell_ray';
import {kMaxPlanes, type Display, type MeshArrays} from '../picture/display';
import {dot, type Plane} from '../protocol/geometry';
import {parseNumbers} from './field_values';
import type {Layer, LayerWork} from './layer';

/**
 * A plane at a share of the mesh's extent along its normal, which is an axis or any direction of
 * the lattice.
 */
export interface ClipSetting {
  normal: [number, number, number];
  share: number;
}

/** The attribute's value if nothing is cut, where a mesh would open with a plane. */
export const kNoClip = 'none';

/** The side that is cut away first faces the first camera: front, right and top. */
const kFirstSides = [1, -1, 1];

export function parseClip(text: string | null): ClipSetting[] {
  const planes = (text ?? '')
    .trim()
    .split(/\s+/)
    .map(parsePlane)
    .filter((plane) => plane !== null);
  return planes.slice(0, kMaxPlanes);
}

function parsePlane(word: string): ClipSetting | null {
  const [direction = '', at = '0.5'] = word.split(':');
  const share = Number(at);
  if (at === '' || !(share >= 0 && share <= 1)) return null;
  const axis = /^(-?)([xyz])$/.exec(direction);
  if (axis) return {normal: axisNormal('xyz'.indexOf(axis[2]!), axis[1] === '-'), share};
  const normal = parseNumbers(direction);
  if (normal.length !== 3 || Math.hypot(...normal) === 0) return null;
  const length = Math.hypot(...normal);
  return {normal: normal.map((x) => x / length) as ClipSetting['normal'], share};
}

/** `flipped`: the side away from the first camera is cut away. */
export function axisNormal(axis: number, flipped: boolean): [number, number, number] {
  const normal: [number, number, number] = [0, 0, 0];
  normal[axis] = kFirstSides[axis]! * (flipped ? -1 : 1);
  return normal;
}

/** The plane's axis, -1 for a free plane, and its side. */
export function axisOf({normal}: ClipSetting): {axis: number; flipped: boolean} {
  const axis = normal.findIndex((x) => Math.abs(x) === 1);
  return {axis, flipped: axis >= 0 && normal[axis] !== kFirstSides[axis]};
}

export const clip = {
  name: 'clip',
  more: [{name: 'clip-mode'}],

  requestOf: ({mode, planes}: Display): Plane[] | null => (mode === 'cells' ? planes : null),
} as const satisfies Layer;

export const clipWork = {
  layer: clip,

  hiding(mesh: MeshArrays, {mode, planes}: Display): ((kept: Uint8Array) => void) | null {
    if (mode !== 'cells' || planes.length === 0) return null;
    return (kept) =>
      planes.forEach((plane) => keepBelow(kept, mesh.points, mesh.tetrahedra, plane));
  },

  /** A slice is seen by itself; other cuts are seen where the body begins. */
  seenFrom(_: MeshArrays, {mode, planes}: Display, ray: Ray, stretch: Stretch): number {
    let t = Infinity;
    if (mode !== 'slice') return t;
    for (const {normal, offset} of planes) {
      const at = (offset - dot(normal, ray.origin)) / dot(normal, ray.direction);
      if (at >= stretch.from && at <= stretch.to) t = Math.min(t, at);
    }
    return t;
  },
} satisfies LayerWork;
