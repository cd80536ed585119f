// Where the picture is taken from: orbiting, the six standard views, perspective or parallel. The
// world is a ball of radius 1 round the origin, z up.

import {MathUtils, PerspectiveCamera, Quaternion, Spherical, Vector3} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import type {Direction} from './directions';

const kFieldOfViewDegrees = 32;
/**
 * So narrow that lines are parallel to a pixel: one camera does both, and every control works in
 * both.
 */
const kParallelDegrees = 0.1;
/** From where a mesh is first seen: front right, from above. */
const kFirstDirection = new Vector3(0.62, -1, 0.55).normalize();
const kUp = new Vector3(0, 0, 1);
/** Air round a mesh that has just been fitted. */
const kMargin = 1.16;
/** The near plane comes no nearer to the eye than this, in radii. */
export const kLeastNear = 0.01;
/** Nothing is farther from the middle than this, in radii. */
const kDepth = 2.5;

/** A view as six numbers: from where (at a distance as with perspective), and to where. */
export type CameraState = [number, number, number, number, number, number];

export class OrbitCamera {
  readonly camera = new PerspectiveCamera(kFieldOfViewDegrees, 1, kLeastNear, 100);
  readonly controls: OrbitControls;
  /** Until somebody turns or zooms, the mesh stays fitted to the space that there is. */
  fitted = true;
  /** Keeps the first view's direction, or that of a standard view, while the mesh is fitted. */
  private direction = kFirstDirection;

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
   * Along `direction`, or as a mesh is first seen, at the distance where `distance` says that
   * everything fits.
   */
  look(direction: Direction | null, distance: () => number): void {
    this.direction = kFirstDirection;
    if (direction) {
      const along = new Vector3().setComponent(
        'xyz'.indexOf(direction[1]!),
        direction[0] === '+' ? 1 : -1,
      );
      // From straight above and below, x goes to the right: a grain of tilt tells the controls so.
      this.direction = along.z === 0 ? along : along.add(new Vector3(0, -1e-4, 0)).normalize();
    }
    this.fit(distance);
  }

  fit(distance: () => number): void {
    this.fitted = true;
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(this.direction);
    this.camera.lookAt(0, 0, 0);
    this.moveTo(this.direction.clone().multiplyScalar(distance()));
  }

  /** Turns round the target, in radians. */
  orbit(horizontal: number, vertical: number): void {
    this.fitted = false;
    const toYUp = new Quaternion().setFromUnitVectors(kUp, new Vector3(0, 1, 0));
    const spherical = new Spherical().setFromVector3(this.offset().applyQuaternion(toYUp));
    spherical.theta += horizontal;
    spherical.phi += vertical;
    spherical.makeSafe();
    this.moveTo(new Vector3().setFromSpherical(spherical).applyQuaternion(toYUp.invert()));
  }

  /** Below 1 nearer, above 1 farther. */
  zoom(factor: number): void {
    this.fitted = false;
    this.moveTo(this.offset().multiplyScalar(factor));
  }

  /**
   * How far the turned camera must stand for every corner to fall into the free shares of the
   * picture's width and height.
   */
  fittingDistance(corners: Vector3[], freeWidth: number, freeHeight: number): number {
    const tanHeight = this.tangent() * freeHeight;
    const tanWidth = this.tangent() * this.camera.aspect * freeWidth;
    const right = new Vector3(),
      up = new Vector3(),
      near = new Vector3();
    this.camera.updateMatrixWorld();
    this.camera.matrixWorld.extractBasis(right, up, near);
    const distances = corners.map(
      (corner) =>
        Math.max(Math.abs(corner.dot(right)) / tanWidth, Math.abs(corner.dot(up)) / tanHeight) *
          kMargin +
        corner.dot(near),
    );
    return Math.max(1, ...distances);
  }

  /**
   * To be called before every frame: the depths that there are, and no more, so that the parallel
   * view keeps its digits.
   */
  setDepths(): void {
    const distance = this.camera.position.length();
    this.camera.near = Math.max(kLeastNear, distance - kDepth);
    this.camera.far = distance + kDepth;
    this.camera.updateProjectionMatrix();
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
