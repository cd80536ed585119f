// A camera with perspective, which may see only a part of its picture.

import {cross, dot, type Vector} from '../core/protocol/geometry';
import {difference, inverse, lengthOf, sum, unit, type Matrix} from './matrix';

/** From where a scene is seen. */
export interface Eye {
  /** Maps coordinates of the scene to the camera's: to the right, up, and to the eye. */
  toEye: Matrix;
  /** Maps those to the canvas's cube [-1, 1]^3. */
  toCube: Matrix;
}

/** The part of a picture of full size that is seen, in pixels from its upper left corner. */
export interface Part {
  fullWidth: number;
  fullHeight: number;
  x: number;
  y: number;
  width: number;
  height: number;
}

/** Unit vectors to the right, up, and to the eye. */
export type Axes = [Vector, Vector, Vector];

/** An eye so near to a box, as a share of its diagonal, may see into it: near parts are cut off. */
const kNearBox = 0.01;

const kUp: Vector = [0, 0, 1];
/** An eye straight above or below looks so far aside, so that it knows where up is. */
const kAside = 1e-4;

export class Lens implements Eye {
  eye: Vector = [0, 0, 1];
  axes: Axes = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  aspect = 1;
  near = 0.01;
  far = 100;
  part: Part | null = null;

  /** `degrees`: the vertical angle of view. */
  constructor(public degrees: number) {}

  clone(): Lens {
    return Object.assign(new Lens(this.degrees), this);
  }

  /** The tangent of half of the angle of view. */
  get tangent(): number {
    return tangentOf(this.degrees);
  }

  /** Sees this part only. The aspect becomes that of the full picture. */
  setPart(part: Part): void {
    this.part = part;
    this.aspect = part.fullWidth / part.fullHeight;
  }

  lookAt(target: Vector): void {
    const to = difference(this.eye, target);
    let back: Vector = lengthOf(to) > 0 ? unit(to) : kUp;
    let right = cross(kUp, back);
    if (lengthOf(right) === 0) {
      back = unit(sum(back, [kAside, 0, 0]));
      right = cross(kUp, back);
    }
    right = unit(right);
    this.axes = [right, cross(back, right), back];
  }

  get toEye(): number[] {
    const {axes, eye} = this;
    const columns = [0, 1, 2].flatMap((k) => [...axes.map((axis) => axis[k]!), 0]);
    return [...columns, ...axes.map((axis) => -dot(axis, eye)), 1];
  }

  get toCube(): number[] {
    const {near, far, aspect, part} = this;
    let top = near * this.tangent;
    let height = 2 * top;
    let width = aspect * height;
    let left = -width / 2;
    if (part) {
      left += (part.x * width) / part.fullWidth;
      top -= (part.y * height) / part.fullHeight;
      width *= part.width / part.fullWidth;
      height *= part.height / part.fullHeight;
    }
    const right = left + width,
      bottom = top - height;
    return [
      ...[(2 * near) / width, 0, 0, 0],
      ...[0, (2 * near) / height, 0, 0],
      ...[(right + left) / width, (top + bottom) / height, -(far + near) / (far - near), -1],
      ...[0, 0, (-2 * far * near) / (far - near), 0],
    ];
  }
}

/** The tangent of half of an angle. */
export function tangentOf(degrees: number): number {
  return Math.tan((degrees * Math.PI) / 360);
}

/** Whether the eye is outside a box of the scene, and not near it. No bounds: false. */
export function isOutside(bounds: readonly number[], toEye: Matrix): boolean {
  if (bounds.length === 0) return false;
  const place = inverse(toEye).slice(12, 15);
  const [low, high] = [bounds.slice(0, 3), bounds.slice(3, 6)];
  const margin = kNearBox * Math.hypot(...high.map((end, axis) => end - low[axis]!));
  return place.some((at, axis) => at < low[axis]! - margin || at > high[axis]! + margin);
}
