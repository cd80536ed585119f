// Clip planes as shaders take them.

import {kMaxPlanes} from '../core/picture/display';
import type {Plane} from '../core/protocol/geometry';

/** No point lies above this plane. */
const kNoPlane = [0, 0, 0, 1];

/** Normal and offset of each of kMaxPlanes. */
export function clipValues(planes: readonly Plane[]): number[] {
  return Array.from({length: kMaxPlanes}, (_, i) => {
    const plane = planes[i];
    return plane ? [...plane.normal, plane.offset] : kNoPlane;
  }).flat();
}
