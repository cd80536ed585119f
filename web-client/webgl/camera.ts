// The camera: orbiting, six standard views, perspective or parallel projection. The world is a ball
// of radius 1 round the origin, z up.

import {dot, type Vector} from '../core/protocol/geometry';
import type {Direction} from './directions';
import {Lens, tangentOf} from './lens';
import {difference, lengthOf, scaled, sum, unit} from './matrix';

const kFieldOfViewDegrees = 32;
/**
 * So narrow that parallel lines look parallel, to a pixel. One camera serves both projections, and
 * every control works in both.
 */
const kParallelDegrees = 0.1;
/** The first direction to a mesh: front right, from above. */
const kFirstDirection = unit([0.62, -1, 0.55]);
/** The share of the free width or height that a fitted mesh fills. */
export const kFill = 0.88;
/** The least distance of the eye from the target of a fitted view, in radii. */
const kMinDistance = 0.05;
/** The least distance of the near plane from the eye, in radii. */
export const kMinNear = 0.01;
/** The least of OrbitCamera.depth, in radii. */
const kDepth = 2.5;
/** So near to straight above or below an eye may get, in radians: it must know where up is. */
const kMinTilt = 1e-6;

/** A view as six numbers: the eye (at the distance of a perspective view) and the target. */
export type CameraState = [number, number, number, number, number, number];

/** Where a camera stands: at `distance` from `target`, against its direction. */
export interface Framing {
  distance: number;
  target: Vector;
}

export class OrbitCamera {
  readonly lens = new Lens(kFieldOfViewDegrees);
  target: Vector = [0, 0, 0];
  /** Until the user turns or zooms, the mesh stays fitted to the free space. */
  fitted = true;
  /** From the mesh to the eye of a fitted view: the first one's, or a standard view's. */
  direction = kFirstDirection;
  /** The largest distance of anything from the middle, in radii. */
  private depth = kDepth;

  constructor() {
    this.moveTo(scaled(kFirstDirection, 4));
  }

  /** A fitted view looks along an axis. */
  get isStandard(): boolean {
    return this.direction !== kFirstDirection;
  }

  get parallel(): boolean {
    return this.lens.degrees === kParallelDegrees;
  }
  set parallel(on: boolean) {
    if (on === this.parallel) return;
    const before = this.lens.tangent;
    this.lens.degrees = on ? kParallelDegrees : kFieldOfViewDegrees;
    this.moveTo(scaled(this.offset, before / this.lens.tangent));
  }

  get state(): CameraState {
    const from = scaled(this.offset, this.lens.tangent / tangentOf(kFieldOfViewDegrees));
    return [...from, ...this.target].map((value) => Number(value.toFixed(4))) as CameraState;
  }
  set state([x, y, z, ...target]: CameraState) {
    this.fitted = false;
    this.target = target;
    this.moveTo(scaled([x, y, z], tangentOf(kFieldOfViewDegrees) / this.lens.tangent));
  }

  /**
   * Looks along `direction`, or as a mesh is first seen. `framing` is called once the camera has
   * turned.
   */
  look(direction: Direction | null, framing: () => Framing): void {
    this.direction = kFirstDirection;
    if (direction) {
      const sign = direction[0] === '+' ? 1 : -1;
      const along = ['x', 'y', 'z'].map((axis) => (axis === direction[1] ? sign : 0)) as Vector;
      // From straight above or below, a little tilt says that x points right.
      this.direction = along[2] === 0 ? along : unit(sum(along, [0, -1e-4, 0]));
    }
    this.fit(framing);
  }

  fit(framing: () => Framing): void {
    this.fitted = true;
    this.lens.eye = this.direction;
    this.lens.lookAt([0, 0, 0]);
    const {distance, target} = framing();
    this.target = target;
    this.moveTo(scaled(this.direction, distance));
  }

  /** Turns round the target by these radians. */
  orbit(horizontal: number, vertical: number): void {
    this.fitted = false;
    const [x, y, z] = this.offset;
    const radius = Math.hypot(x, y, z);
    const angle = Math.atan2(y, x) + horizontal;
    const fromUp = Math.acos(Math.max(-1, Math.min(1, z / radius))) + vertical;
    const tilt = Math.max(kMinTilt, Math.min(Math.PI - kMinTilt, fromUp));
    const across = radius * Math.sin(tilt);
    this.moveTo([across * Math.cos(angle), across * Math.sin(angle), radius * Math.cos(tilt)]);
  }

  /** Moves by shares of the canvas's height at the target: what is seen goes right and up. */
  pan(right: number, up: number): void {
    const {axes, part, tangent} = this.lens;
    const share = part ? part.height / part.fullHeight : 1;
    const height = 2 * lengthOf(this.offset) * tangent * share;
    const [along, above] = axes;
    this.aimAt(sum(this.target, sum(scaled(along, -right * height), scaled(above, -up * height))));
  }

  /** The world is scaled, then moved; the camera goes with it. */
  goWith(factor: number, shift: Vector): void {
    const {offset} = this;
    this.target = sum(scaled(this.target, factor), shift);
    this.moveTo(scaled(offset, factor));
  }

  /** Moves without turning, so that the target is here. */
  aimAt(point: Vector): void {
    this.fitted = false;
    const {offset} = this;
    this.target = point;
    this.moveTo(offset);
  }

  /** A factor below 1 moves nearer, above 1 farther. */
  zoom(factor: number): void {
    this.fitted = false;
    this.moveTo(scaled(this.offset, factor));
  }

  /** The same along the line of sight through a place of the canvas's cube, which stays there. */
  zoomAt(factor: number, place: readonly [number, number]): void {
    this.fitted = false;
    const distance = lengthOf(this.offset);
    const along = this.sightThrough(place);
    this.lens.eye = sum(this.lens.eye, scaled(along, distance * (1 - factor)));
    this.target = sum(this.lens.eye, scaled(this.lens.axes[2], -distance * factor));
  }

  /**
   * The place of the camera so that all points lie in the free shares of the picture's width and
   * height. They fill them in one direction, and are centred in both.
   *
   * A point has the coordinates a (to the right) and c (to the eye). An eye at distance D, above t,
   * sees it if |a - t| <= k (D - c). Here k is the tangent of half the angle of view. So D is at
   * least (max(a + k c) - min(a - k c)) / 2k, and t lies in the middle of the two.
   */
  framing(points: Vector[], freeWidth: number, freeHeight: number): Framing {
    const {axes, aspect, tangent} = this.lens;
    const [right, up, near] = axes;
    let target: Vector = [0, 0, 0];
    let distance = (kMinDistance * tangentOf(kFieldOfViewDegrees)) / tangent;
    for (const [axis, free] of [
      [right, freeWidth * aspect],
      [up, freeHeight],
    ] as const) {
      const k = kFill * tangent * free;
      let low = Infinity,
        high = -Infinity;
      for (const point of points) {
        const a = dot(point, axis),
          c = k * dot(point, near);
        low = Math.min(low, a - c);
        high = Math.max(high, a + c);
      }
      if (!(low <= high)) continue;
      distance = Math.max(distance, (high - low) / (2 * k));
      target = sum(target, scaled(axis, (low + high) / 2));
    }
    return {distance, target};
  }

  /** Everything lies within this distance of the middle. */
  reachTo(radius: number): void {
    this.depth = Math.max(kDepth, radius);
  }

  /**
   * Must be called before every frame, and for a camera of another picture. Tight depths keep the
   * digits of a parallel view.
   */
  setDepths(lens = this.lens): void {
    const distance = lengthOf(lens.eye);
    lens.near = Math.max(kMinNear, distance - this.depth);
    lens.far = distance + this.depth;
  }

  private get offset(): Vector {
    return difference(this.lens.eye, this.target);
  }

  private moveTo(offset: Vector): void {
    this.lens.eye = sum(this.target, offset);
    this.lens.lookAt(this.target);
  }

  /** A unit vector. */
  private sightThrough([x, y]: readonly [number, number]): Vector {
    const {axes, toCube} = this.lens;
    const [right, up, back] = axes;
    return unit(
      sum(
        sum(
          scaled(right, (x + toCube[8]!) / toCube[0]!),
          scaled(up, (y + toCube[9]!) / toCube[5]!),
        ),
        scaled(back, -1),
      ),
    );
  }
}
