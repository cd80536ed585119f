// The camera of one mesh: where the mesh lies, and from where it is seen.

import {Frustum, Group, Matrix4, Vector3, type PerspectiveCamera} from 'three';
import type {TriangleSoup} from '../core/picture/triangle_soup';
import type {Vector} from '../core/protocol/geometry';
import {OrbitCamera, type CameraState, type Framing} from './camera';
import {checkedDirection, type Direction} from './directions';
import {cornersOf, outlineOf} from './outline';
import {checkedCamera, type Pose} from './pose';
import type {Sight} from './ray_caster';
import type {Part} from './tiles';
import type {Frame, Insets} from './view';
import type {ViewCanvas} from './worker_canvas';

export class MeshCamera {
  readonly orbit: OrbitCamera;
  /** Maps lattice coordinates to a ball of radius 1 round the origin. */
  readonly lattice = new Group();
  /** Bounds of the largest mesh so far, in lattice coordinates; empty: there is no mesh. */
  bounds: number[] = [];
  focus: number[] | null = null;
  /** Lattice points that the mesh lies between. */
  private outline: Vector[] = [];
  private insets: Insets = {left: 0, right: 0, top: 0, bottom: 0};
  /** The next mesh is seen from here first; null: its first view. */
  private start: CameraState | Direction | null = null;

  constructor(
    canvas: ViewCanvas,
    private readonly changed: () => void,
  ) {
    this.orbit = new OrbitCamera(canvas as HTMLCanvasElement, changed);
  }

  get hasMesh(): boolean {
    return this.bounds.length > 0;
  }

  /**
   * A camera's state is relative to the largest mesh so far. A coarse mesh is a little smaller, and
   * the line decides which one comes first. So only the whole mesh gives a state, or a link, the
   * same picture everywhere.
   */
  growTo(seen: number[], surface: TriangleSoup | undefined): void {
    const isFirst = !this.hasMesh;
    const bounds = isFirst
      ? seen
      : this.bounds.map((end, i) => (i < 3 ? Math.min : Math.max)(end, seen[i]!));
    if (!isFirst && bounds.every((end, i) => end === this.bounds[i])) return;
    this.bounds = bounds;
    this.outline = outlineOf(surface, bounds);
    this.placeLattice();
    if (!isFirst) {
      this.refit();
      return;
    }
    if (Array.isArray(this.start)) this.orbit.state = this.start;
    else this.look(this.start);
    this.start = null;
  }

  /** Forgets the mesh; the next one is fitted again. */
  clear(): void {
    this.bounds = [];
  }

  /** Returns false if they are the same as before. */
  setInsets(insets: Insets): boolean {
    const sides = Object.keys(insets) as (keyof Insets)[];
    if (sides.every((side) => insets[side] === this.insets[side])) return false;
    this.insets = insets;
    return true;
  }

  /** Shifts the picture's centre into the middle of the free area of a canvas of this size. */
  resize(width: number, height: number): void {
    const {camera} = this.orbit;
    camera.aspect = width / height;
    const right = ((this.insets.right - this.insets.left) / 2) * width;
    const down = ((this.insets.bottom - this.insets.top) / 2) * height;
    camera.setViewOffset(width, height, right, down, width, height);
    this.refit();
  }

  /**
   * Shows a standard view, or (null) the first view of a mesh, as near as its bounding box allows.
   * Waits for a mesh if there is none.
   */
  look(direction: Direction | null): void {
    checkedDirection(direction);
    if (!this.hasMesh) {
      this.start = direction;
      return;
    }
    this.orbit.look(direction, () => this.framing());
    this.changed();
  }

  /** Waits for a mesh if there is none. */
  moveTo(state: CameraState): void {
    checkedCamera(state);
    if (this.hasMesh) this.orbit.state = state;
    else this.start = state;
    this.changed();
  }

  /** Moves the camera so that this lattice point is in the middle of the free area. */
  centre(point: Vector): void {
    this.orbit.aimAt(this.placed(point));
    this.changed();
  }

  /** A camera for a part of another picture, as View.render says. REQUIRES: hasMesh. */
  cameraFor({width, height, margin}: Frame, part: Part): PerspectiveCamera {
    const {camera: seen, direction, fitted} = this.orbit;
    const camera = seen.clone();
    let full = {width, height};
    if (fitted) {
      const insets = {left: 0, right: 0, top: margin, bottom: margin};
      const {distance, target} = this.framing(insets, width / height);
      camera.position.copy(direction).multiplyScalar(distance).add(target);
    } else {
      const {left, right, top, bottom} = this.insets;
      const {fullWidth, fullHeight} = seen.view!;
      const scale = Math.min(
        width / (fullWidth * (1 - left - right)),
        (height * (1 - 2 * margin)) / (fullHeight * (1 - top - bottom)),
      );
      full = {width: scale * fullWidth, height: scale * fullHeight};
    }
    camera.setViewOffset(
      full.width,
      full.height,
      (full.width - width) / 2 + part.x,
      (full.height - height) / 2 + part.y,
      part.width,
      part.height,
    );
    this.orbit.setDepths(camera);
    return camera;
  }

  /** The lines of sight of a camera in this scene. */
  sightOf(camera: PerspectiveCamera): Sight {
    camera.updateMatrixWorld();
    this.lattice.updateMatrixWorld();
    const {position, scale, matrixWorld} = this.lattice;
    const toCanvas = new Matrix4()
      .multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse)
      .multiply(matrixWorld);
    return {
      toCanvas: toCanvas.toArray(),
      fromCanvas: toCanvas.clone().invert().toArray(),
      eye: camera.position.clone().sub(position).divide(scale).toArray(),
      // the length of the bounds' diagonal, in lattice steps
      diagonal: 2 / scale.x,
    };
  }

  /** The pose of now, drawn or not. `frameMs` is the time of the last frame. */
  pose(frameMs: number): Pose {
    const {camera, fitted} = this.orbit;
    camera.updateMatrixWorld();
    const toCube = new Matrix4().multiplyMatrices(
      camera.projectionMatrix,
      camera.matrixWorldInverse,
    );
    // A point is in sight if normal . (scale p + position) + constant >= 0.
    const scale = this.lattice.scale.x;
    const frustum =
      fitted || !this.hasMesh
        ? []
        : new Frustum().setFromProjectionMatrix(toCube).planes.map(({normal, constant}) => ({
            normal: normal.toArray(),
            offset: -(constant + normal.dot(this.lattice.position)) / scale,
          }));
    const {x, y, z, w} = camera.quaternion;
    const {toCanvas, fromCanvas} = this.sightOf(camera);
    return {
      toCanvas,
      fromCanvas,
      rotation: {x, y, z, w},
      camera: this.orbit.state,
      fitted,
      direction: camera.getWorldDirection(new Vector3()).toArray(),
      frustum,
      frameMs,
    };
  }

  private refit(): void {
    if (this.orbit.fitted && this.hasMesh) this.orbit.fit(() => this.framing());
  }

  private placeLattice(): void {
    const low = new Vector3(...(this.bounds.slice(0, 3) as Vector));
    const high = new Vector3(...(this.bounds.slice(3, 6) as Vector));
    const scale = 2 / Math.max(low.distanceTo(high), 1);
    this.lattice.scale.setScalar(scale);
    this.lattice.position.copy(low.add(high)).multiplyScalar(-0.5 * scale);
  }

  /** A lattice point's place in the scene. */
  private placed([x, y, z]: Vector): Vector3 {
    return new Vector3(x, y, z).multiply(this.lattice.scale).add(this.lattice.position);
  }

  /**
   * Frames the mesh itself, not its box: a box leaves its corners empty. `aspect` may be that of
   * another picture than the canvas.
   */
  private framing(
    {left, right, top, bottom} = this.insets,
    aspect = this.orbit.camera.aspect,
  ): Framing {
    const isWhole = !this.focus || this.orbit.isStandard;
    const seen = isWhole ? null : seenPart(this.focus!, this.bounds, this.orbit.direction);
    const points = (seen ? cornersOf(seen) : this.outline).map((corner) => this.placed(corner));
    const wider = aspect / this.orbit.camera.aspect;
    return this.orbit.framing(points, (1 - left - right) * wider, 1 - top - bottom);
  }
}

/**
 * The part of the focus that is seen from outside: its side at a face of the bounds that faces the
 * eye. Null if no such face is near: walls would hide the focus.
 */
function seenPart(focus: number[], bounds: number[], {x, y, z}: Vector3): number[] | null {
  const sides = [x, y, z].map((towardsEye, axis) => (towardsEye > 0 ? axis + 3 : axis));
  const gaps = sides.map((side, axis) => {
    const extent = focus[axis + 3]! - focus[axis]!;
    return Math.abs(bounds[side]! - focus[side]!) / extent;
  });
  const axis = gaps.indexOf(Math.min(...gaps));
  if (gaps[axis]! >= 1) return null;
  const seen = [...focus];
  seen[axis] = seen[axis + 3] = bounds[sides[axis]!]!;
  return seen;
}
