// Clip planes that a user has moved, as their attribute has them.

import {axisOf, kNoClip, type ClipSetting} from './clip';

/** The planes with plane `i` at a share of the extent. */
export function movedPlane(planes: ClipSetting[], i: number, share: number): ClipSetting[] {
  const within = Math.min(1, Math.max(0, share));
  return planes.map((plane, k) => (k === i ? {...plane, share: within} : plane));
}

/** The attribute's value. With `hasFirstCut` the mesh opens with a plane if there is none. */
export function clipText(planes: ClipSetting[], hasFirstCut: boolean): string | null {
  if (planes.length === 0) return hasFirstCut ? kNoClip : null;
  return planes
    .map((plane) => {
      const {axis, flipped} = axisOf(plane);
      const direction =
        axis >= 0
          ? `${flipped ? '-' : ''}${'xyz'[axis]}`
          : plane.normal.map((x) => Number(x.toFixed(4))).join(',');
      return `${direction}:${Number(plane.share.toFixed(4))}`;
    })
    .join(' ');
}
