// The camera: orbiting, six standard views, perspective or parallel projection. The world is a ball
// of radius 1 round the origin, z up.

import {MathUtils, PerspectiveCamera, Quaternion, Spherical, Vector3} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import type {Direction} from './directions';

const kFieldOfViewDegrees = 32;
/**
 * So narrow that parallel lines look parallel, to a pixel. One camera serves both projections, and
 * every control works in both.
 */
const kParallelDegrees = 0.1;
/** The first direction to a mesh: front right, from above. */
const kFirstDirection = new Vector3(0.62, -1, 0.55).normalize();
const kUp = new Vector3(0, 0, 1);
/** The share of the free width or height that a fitted mesh fills. */
const kFill = 0.88;
/** The least distance of the eye from the target of a fitted view, in radii. */
const kMinDistance = 0.05;
/** The least distance of the near plane from the eye, in radii. */
export const kMinNear = 0.01;
/** The largest distance of anything from the middle, in radii. */
const kDepth = 2.5;

/** A view as six numbers: the eye (at the distance of a perspective view) and the target. */
export type CameraState = [number, number, number, number, number, number];

/** Where a camera stands: at `distance` from `target`, against its direction. */
export interface Framing {
  distance: number;
  target: Vector3;
}

export class OrbitCamera {
  readonly camera = new PerspectiveCamera(kFieldOfViewDegrees, 1, kMinNear, 100);
  readonly controls: OrbitControls;
  /** Until the user turns or zooms, the mesh stays fitted to the free space. */
  fitted = true;
  /** From the mesh to the eye of a fitted view: the first one's, or a standard view's. */
  direction = kFirstDirection;

  constructor(canvas: HTMLCanvasElement, changed: () => void) {
    this.camera.up.copy(kUp);
    this.camera.position.copy(kFirstDirection).multiplyScalar(4);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    let held = false;
    this.controls.addEventListener('start', () => void (held = true));
    this.controls.addEventListener('end', () => void (held = false));
    this.controls.addEventListener('change', () => {
      if (held) this.fitted = false; // a tap alone moves nothing
      changed();
    });
  }

  /** A fitted view looks along an axis. */
  get isStandard(): boolean {
    return this.direction !== kFirstDirection;
  }

  get parallel(): boolean {
    return this.camera.fov === kParallelDegrees;
  }
  set parallel(on: boolean) {
    if (on === this.parallel) return;
    const before = this.tangent();
    this.camera.fov = on ? kParallelDegrees : kFieldOfViewDegrees;
    this.moveTo(this.offset().multiplyScalar(before / this.tangent()));
    this.camera.updateProjectionMatrix();
  }

  get state(): CameraState {
    const from = this.offset().multiplyScalar(this.tangent() / tangentOf(kFieldOfViewDegrees));
    return [...from.toArray(), ...this.controls.target.toArray()].map((value) =>
      Number(value.toFixed(4)),
    ) as CameraState;
  }
  set state([x, y, z, ...target]: CameraState) {
    this.fitted = false;
    this.controls.target.set(...target);
    this.moveTo(
      new Vector3(x, y, z).multiplyScalar(tangentOf(kFieldOfViewDegrees) / this.tangent()),
    );
  }

  /**
   * Looks along `direction`, or as a mesh is first seen. `framing` is called once the camera has
   * turned.
   */
  look(direction: Direction | null, framing: () => Framing): void {
    this.direction = kFirstDirection;
    if (direction) {
      const along = new Vector3().setComponent(
        'xyz'.indexOf(direction[1]!),
        direction[0] === '+' ? 1 : -1,
      );
      // From straight above or below, a little tilt lets the controls know that x points right.
      this.direction = along.z === 0 ? along : along.add(new Vector3(0, -1e-4, 0)).normalize();
    }
    this.fit(framing);
  }

  fit(framing: () => Framing): void {
    this.fitted = true;
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(this.direction);
    this.camera.lookAt(0, 0, 0);
    const {distance, target} = framing();
    this.controls.target.copy(target);
    this.moveTo(this.direction.clone().multiplyScalar(distance));
  }

  /** Turns round the target by these radians. */
  orbit(horizontal: number, vertical: number): void {
    this.fitted = false;
    const toYUp = new Quaternion().setFromUnitVectors(kUp, new Vector3(0, 1, 0));
    const spherical = new Spherical().setFromVector3(this.offset().applyQuaternion(toYUp));
    spherical.theta += horizontal;
    spherical.phi += vertical;
    spherical.makeSafe();
    this.moveTo(new Vector3().setFromSpherical(spherical).applyQuaternion(toYUp.invert()));
  }

  /** Moves by shares of the picture's height at the target: what is seen goes right and up. */
  pan(right: number, up: number): void {
    this.camera.updateMatrixWorld();
    const along = new Vector3(),
      above = new Vector3();
    this.camera.matrixWorld.extractBasis(along, above, new Vector3());
    const height = 2 * this.offset().length() * this.tangent();
    const {target} = this.controls;
    this.aimAt(
      target
        .clone()
        .addScaledVector(along, -right * height)
        .addScaledVector(above, -up * height),
    );
  }

  /** Moves without turning, so that the target is here. */
  aimAt(point: Vector3): void {
    this.fitted = false;
    const offset = this.offset();
    this.controls.target.copy(point);
    this.moveTo(offset);
  }

  /** A factor below 1 moves nearer, above 1 farther. */
  zoom(factor: number): void {
    this.fitted = false;
    this.moveTo(this.offset().multiplyScalar(factor));
  }

  /**
   * The place of the camera so that all points lie in the free shares of the picture's width and
   * height. They fill them in one direction, and are centred in both.
   *
   * A point has the coordinates a (to the right) and c (to the eye). An eye at distance D, above t,
   * sees it if |a - t| <= k (D - c). Here k is the tangent of half the angle of view. So D is at
   * least (max(a + k c) - min(a - k c)) / 2k, and t lies in the middle of the two.
   */
  framing(points: Vector3[], freeWidth: number, freeHeight: number): Framing {
    const right = new Vector3(),
      up = new Vector3(),
      near = new Vector3();
    this.camera.updateMatrixWorld();
    this.camera.matrixWorld.extractBasis(right, up, near);
    const target = new Vector3();
    let distance = (kMinDistance * tangentOf(kFieldOfViewDegrees)) / this.tangent();
    for (const [axis, free] of [
      [right, freeWidth * this.camera.aspect],
      [up, freeHeight],
    ] as const) {
      const k = kFill * this.tangent() * free;
      let low = Infinity,
        high = -Infinity;
      for (const point of points) {
        const a = point.dot(axis),
          c = k * point.dot(near);
        low = Math.min(low, a - c);
        high = Math.max(high, a + c);
      }
      if (!(low <= high)) continue;
      distance = Math.max(distance, (high - low) / (2 * k));
      target.addScaledVector(axis, (low + high) / 2);
    }
    return {distance, target};
  }

  /**
   * Must be called before every frame, and for a camera of another picture. Tight depths keep the
   * digits of a parallel view.
   */
  setDepths(camera = this.camera): void {
    const distance = camera.position.length();
    camera.near = Math.max(kMinNear, distance - kDepth);
    camera.far = distance + kDepth;
    camera.updateProjectionMatrix();
  }

  dispose(): void {
    this.controls.dispose();
  }

  private offset(): Vector3 {
    return this.camera.position.clone().sub(this.controls.target);
  }
  private moveTo(offset: Vector3): void {
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }
  private tangent(): number {
    return tangentOf(this.camera.fov);
  }
}

function tangentOf(degrees: number): number {
  return Math.tan(MathUtils.degToRad(degrees) / 2);
}
