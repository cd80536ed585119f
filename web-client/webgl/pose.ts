// The pose of a view: it turns points of the lattice into places on the canvas and back. It is
// plain data, so that it can pass between threads.

import type {Vector} from '../core/protocol/geometry';
import type {Ray} from '../core/picture/cell_ray';
import type {CameraState} from './camera';
import type {Axes} from './lens';
import {transformed, type Matrix} from './matrix';

export interface Pose {
  /** Maps lattice coordinates to the canvas's cube [-1, 1]^3, and back. */
  toCanvas: Matrix;
  fromCanvas: Matrix;
  /** The camera's. */
  axes: Axes;
  camera: CameraState;
  /** The user has not turned or zoomed: the whole mesh is in the picture. */
  fitted: boolean;
  /** Lattice points between which lies all that was seen of a fitted mesh; else none. */
  outline: readonly Vector[];
  /**
   * Bounds of all that was seen under the present warp, in lattice coordinates; empty: there is no
   * mesh.
   */
  reach: readonly number[];
  /** The direction of the camera, as a unit normal in lattice coordinates. */
  direction: Vector;
  /** The time of the last frame on the thread that draws. */
  frameMs: number;
}

export interface Size {
  clientWidth: number;
  clientHeight: number;
}

/** Throws a TypeError unless it is an array of six finite numbers. */
export function checkedCamera(state: unknown): CameraState {
  if (Array.isArray(state) && state.length === 6 && state.every(Number.isFinite))
    return state as CameraState;
  throw new TypeError(
    'A camera is an array of six finite numbers, from where and to where; not ' +
      `${JSON.stringify(state)}.`,
  );
}

/** The place of a lattice point on the canvas, in CSS pixels. */
export function project(
  {toCanvas}: Pose,
  {clientWidth, clientHeight}: Size,
  point: Vector,
): {x: number; y: number} {
  const [x, y] = transformed(toCanvas, point);
  return {x: ((x + 1) / 2) * clientWidth, y: ((1 - y) / 2) * clientHeight};
}

/** The line of sight through a point of the canvas, in CSS pixels from its corner. */
export function rayAt(
  {fromCanvas}: Pose,
  {clientWidth, clientHeight}: Size,
  x: number,
  y: number,
): Ray {
  const at = [(2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight] as const;
  const origin = transformed(fromCanvas, [...at, -1]);
  const far = transformed(fromCanvas, [...at, 1]);
  const along = far.map((value, axis) => value - origin[axis]!);
  const length = Math.hypot(...along);
  return {origin, direction: along.map((value) => value / length) as Vector};
}
