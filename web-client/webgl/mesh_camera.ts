// The camera of one mesh: where the mesh lies, and from where it is seen.

import {isEqual} from '../core/protocol/equal';
import {moved, type LatticeChange, type Vector} from '../core/protocol/geometry';
import type {Snapshot} from '../core/session/worker_messages';
import {kFill, OrbitCamera, type CameraState, type Framing} from './camera';
import {checkedDirection, type Direction} from './directions';
import type {Eye, Lens} from './lens';
import {
  difference,
  inverse,
  lengthOf,
  product,
  scaled,
  sum,
  transformed,
  type Matrix,
} from './matrix';
import {OrbitControls} from './orbit_controls';
import {cornersOf, farthestOf, outlineOf, outlineOfLines} from './outline';
import {checkedCamera, type Pose} from './pose';
import type {Part} from './tiles';
import type {Boxed, Frame, Insets} from './view';
import type {ViewCanvas} from './worker_canvas';

/** A camera's lines of sight, in lattice coordinates. */
export interface Sight {
  toCanvas: Matrix;
  fromCanvas: Matrix;
  eye: Vector;
  /** The mesh's diagonal. */
  diagonal: number;
}

/** As View.setInsets, setCovered and setBoxed. */
interface Room {
  insets: Insets;
  covered: Insets | null;
  boxed: Boxed | null;
}

/** Lattice coordinates, scaled and moved, lie in a ball of radius 1 round the origin. */
interface Placing {
  scale: number;
  offset: Vector;
}

type Seen = Pick<Snapshot, 'bounds' | 'surface' | 'warp'>;

/** Cards that cover more of a small page cover the mesh. */
const kLeastFree = 0.1;

const kNoReach = {bounds: [] as number[], scale: 0, isAtRestToo: false};

export class MeshCamera {
  readonly orbit = new OrbitCamera();
  private readonly controls: OrbitControls;
  private placing: Placing = {scale: 1, offset: [0, 0, 0]};
  /** Those of the largest mesh at rest so far, in lattice coordinates; empty: there is no mesh. */
  bounds: number[] = [];
  focus: number[] | null = null;
  /**
   * Bounds of all that was seen under the present warp, its factor (0: there is none), and whether
   * the mesh at rest is seen, too.
   */
  private reach = kNoReach;
  /** Lattice points that the mesh lies between. */
  private outline: Vector[] = [];
  private room: Room = {
    insets: {left: 0, right: 0, top: 0, bottom: 0},
    covered: null,
    boxed: null,
  };
  /** The canvas's. */
  private size = {width: 1, height: 1};
  /** The mesh has followed another one. It may have another size, and the camera stays in place. */
  private isSuccessor = false;
  /** The next mesh is seen from here first; null: its first view. */
  private start: CameraState | Direction | null = null;

  constructor(
    canvas: ViewCanvas,
    private readonly changed: () => void,
  ) {
    this.controls = new OrbitControls(this.orbit, canvas, changed);
  }

  get hasMesh(): boolean {
    return this.bounds.length > 0;
  }

  /**
   * A camera's state is relative to the largest mesh so far, without its warp. A coarse mesh is a
   * little smaller, and the line decides which one comes first. So only the whole mesh gives a
   * state, or a link, the same picture everywhere.
   */
  growTo({bounds: seen, surface, warp}: Seen): void {
    const isFirst = !this.hasMesh;
    const bounds = union(this.bounds, warp?.restBounds ?? seen);
    const scale = warp?.scale ?? 0;
    // A series that moves the mesh keeps the picture wide enough for all that was seen.
    const isAtRestToo = (warp?.restEdges?.length ?? 0) > 0;
    const isSameWarp = scale === this.reach.scale && isAtRestToo === this.reach.isAtRestToo;
    const now = isAtRestToo ? union(seen, warp!.restBounds) : seen;
    const reach = union(isSameWarp ? this.reach.bounds : [], now);
    if (isSame(bounds, this.bounds) && isSameWarp && isSame(reach, this.reach.bounds)) return;
    const lines = outlineOfLines(warp?.restEdges ?? new Float32Array(0));
    const outline = [...outlineOf(surface, reach), ...lines];
    const isMoving = isSameWarp && scale !== 0 && !isFirst;
    this.outline = isMoving ? farthestOf([...this.outline, ...outline]) : outline;
    this.bounds = bounds;
    this.reach = {bounds: reach, scale, isAtRestToo};
    const before = this.placing;
    this.placeLattice();
    if (!isFirst) {
      if (this.isSuccessor) this.stayInPlace(before);
      this.refit();
      return;
    }
    if (Array.isArray(this.start)) this.orbit.state = this.start;
    else this.look(this.start);
    this.start = null;
    this.placePicture();
  }

  /** The mesh lies on another lattice from now on, in the same place. */
  changeLattice(change: LatticeChange): void {
    if (!this.hasMesh) return;
    const ends = (bounds: readonly number[]): number[] => [
      ...moved(change, bounds.slice(0, 3)),
      ...moved(change, bounds.slice(3)),
    ];
    this.bounds = ends(this.bounds);
    this.focus &&= ends(this.focus);
    this.reach = {...this.reach, bounds: ends(this.reach.bounds)};
    this.outline = this.outline.map((point) => moved(change, point));
    this.isSuccessor = true;
    this.placeLattice();
  }

  /** Forgets the mesh; the next one is fitted again. */
  clear(): void {
    this.bounds = [];
    this.reach = kNoReach;
    this.isSuccessor = false;
  }

  /** Returns false if it is the same as before. */
  setRoom(part: Partial<Room>): boolean {
    const next = {...this.room, ...part};
    if (isEqual(next, this.room)) return false;
    this.room = next;
    return true;
  }

  /** Cards cover the picture for a while. */
  get isCovered(): boolean {
    return this.room.covered !== null;
  }

  /** Shifts the picture's centre into the middle of the free area of a canvas of this size. */
  resize(width: number, height: number): void {
    this.size = {width, height};
    this.placePicture();
    this.refit();
    if (this.room.covered) this.placePicture();
  }

  /** The canvas's camera as if no card covered it for a while. */
  uncovered(): Lens {
    const lens = this.orbit.lens.clone();
    placeBetween(this.room.insets, lens, this.size);
    return lens;
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
    this.placePicture();
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

  /**
   * A camera for a part of another picture, as View.render says. A moved camera stays, and its
   * picture is enlarged. REQUIRES: hasMesh.
   */
  lensFor({width, height, insets, boxed = null}: Frame, part: Part): Lens {
    const {orbit, size} = this;
    const lens = orbit.fitted ? orbit.lens.clone() : this.uncovered();
    const [freeWidth, freeHeight] = freeOf(insets, boxed);
    const middle = middleOf(insets, width, height);
    let scale = 1;
    let full = {width, height};
    let from = [width / 2, height / 2];
    if (orbit.fitted) {
      const {distance, target} = this.framing({insets, boxed}, width / height);
      lens.eye = sum(scaled(orbit.direction, distance), target);
    } else {
      const area = this.shownArea(lens, boxed);
      scale = Math.min((width * freeWidth) / area.width, (height * freeHeight) / area.height);
      full = {width: scale * size.width, height: scale * size.height};
      from = [area.x + lens.part!.x, area.y + lens.part!.y];
    }
    lens.setPart({
      fullWidth: full.width,
      fullHeight: full.height,
      x: scale * from[0]! - middle[0] + part.x,
      y: scale * from[1]! - middle[1] + part.y,
      width: part.width,
      height: part.height,
    });
    orbit.setDepths(lens);
    return lens;
  }

  /**
   * The part of the canvas that another picture shows, in pixels. `x` and `y` are its middle. It is
   * the mesh's if all of it lies between the insets, else all between them. REQUIRES: `lens` is
   * uncovered().
   */
  private shownArea(
    lens: Lens,
    boxed: Boxed | null,
  ): {x: number; y: number; width: number; height: number} {
    const {width, height} = this.size;
    const {insets} = this.room;
    const [freeWidth, freeHeight] = freeOf(insets);
    const [x, y] = middleOf(insets, width, height);
    const free = {x, y, width: freeWidth * width, height: freeHeight * height};
    this.orbit.setDepths(lens);
    const {toCanvas} = this.sightOf(lens);
    const places = this.framed(boxed).map((point) => transformed(toCanvas, point));
    const isSeen = places.every(
      ([across, up, depth]) =>
        Math.abs(((across + 1) / 2) * width - x) <= free.width / 2 &&
        Math.abs(((1 - up) / 2) * height - y) <= free.height / 2 &&
        Math.abs(depth) <= 1,
    );
    if (!isSeen) return free;
    const [left, right] = endsOf(places.map(([across]) => ((across + 1) / 2) * width));
    const [top, bottom] = endsOf(places.map(([, up]) => ((1 - up) / 2) * height));
    return {
      x: (left + right) / 2,
      y: (top + bottom) / 2,
      width: Math.max(1, right - left) / kFill,
      height: Math.max(1, bottom - top) / kFill,
    };
  }

  /** From where a camera sees lattice coordinates. */
  eyeOf({toEye, toCube}: Lens): Eye {
    const {scale, offset} = this.placing;
    const placed = [scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, ...offset, 1];
    return {toEye: product(toEye, placed), toCube};
  }

  /** The lines of sight of a camera in this scene. */
  sightOf(lens: Lens): Sight {
    const {toEye, toCube} = this.eyeOf(lens);
    const {scale, offset} = this.placing;
    const toCanvas = product(toCube, toEye);
    return {
      toCanvas,
      fromCanvas: inverse(toCanvas),
      eye: scaled(difference(lens.eye, offset), 1 / scale),
      // the length of the bounds' diagonal, in lattice steps
      diagonal: 2 / scale,
    };
  }

  /** The pose of now, drawn or not. `frameMs` is the time of the last frame. */
  pose(frameMs: number): Pose {
    const {lens, fitted, state} = this.orbit;
    const {toCanvas, fromCanvas} = this.sightOf(lens);
    return {
      toCanvas,
      fromCanvas,
      axes: lens.axes,
      camera: state,
      fitted,
      outline: fitted ? this.outline : [],
      reach: this.hasMesh ? this.reach.bounds : [],
      direction: scaled(lens.axes[2], -1),
      frameMs,
    };
  }

  dispose(): void {
    this.controls.dispose();
  }

  private stayInPlace(before: Placing): void {
    const {scale, offset} = this.placing;
    const factor = scale / before.scale;
    this.orbit.goWith(factor, difference(offset, scaled(before.offset, factor)));
  }

  private placePicture(): void {
    const {size} = this;
    const {lens} = this.orbit;
    const {covered, insets} = this.room;
    placeBetween(insets, lens, size);
    if (covered) placeBetween(covered, lens, size, this.shrunkBy(covered));
  }

  /**
   * At most 1: with this scale the area between `covered` shows of the mesh what that between the
   * insets shows. REQUIRES: the lens is placed between the insets.
   */
  private shrunkBy(covered: Insets): number {
    if (!this.hasMesh) return 1;
    this.orbit.setDepths();
    const {toCanvas} = this.sightOf(this.orbit.lens);
    const {boxed, insets} = this.room;
    const places = this.framed(boxed).map((point) => transformed(toCanvas, point));
    const isInFront = places.every(([, , depth]) => Math.abs(depth) <= 1);
    const before = freeOf(insets, boxed);
    const shares = freeOf(covered, boxed).map((free, axis) => {
      const along = places.map((place) => place[axis]!);
      const span = isInFront ? (Math.max(...along) - Math.min(...along)) / 2 : Infinity;
      return (kFill * free) / Math.min(span, kFill * before[axis]!);
    });
    return Math.min(1, ...shares);
  }

  private refit(): void {
    if (this.orbit.fitted && this.hasMesh) this.orbit.fit(() => this.framing());
  }

  private placeLattice(): void {
    const low = this.bounds.slice(0, 3) as Vector;
    const high = this.bounds.slice(3, 6) as Vector;
    const scale = 2 / Math.max(lengthOf(difference(high, low)), 1);
    this.placing = {scale, offset: scaled(sum(low, high), -scale / 2)};
    const corners = cornersOf(this.reach.bounds).map((corner) => this.placed(corner));
    this.orbit.reachTo(Math.max(...corners.map(lengthOf)));
  }

  /** A lattice point's place in the scene. */
  private placed(point: Vector): Vector {
    const {scale, offset} = this.placing;
    return sum(scaled(point, scale), offset);
  }

  /**
   * Frames the mesh itself, not its box: a box leaves its corners empty. `aspect` may be that of
   * another picture than the canvas.
   */
  private framing(
    {insets, boxed}: Pick<Room, 'insets' | 'boxed'> = this.room,
    aspect = this.orbit.lens.aspect,
  ): Framing {
    const isWhole =
      !this.focus || boxed !== null || this.orbit.isStandard || this.reach.scale !== 0;
    const seen = isWhole ? null : seenPart(this.focus!, this.bounds, this.orbit.direction);
    const points = (seen ? cornersOf(seen) : this.framed(boxed)).map((corner) =>
      this.placed(corner),
    );
    const wider = aspect / this.orbit.lens.aspect;
    const [freeWidth, freeHeight] = freeOf(insets, boxed);
    return this.orbit.framing(points, freeWidth * wider, freeHeight);
  }

  /** Lattice points that are fitted together. */
  private framed(boxed: Boxed | null): Vector[] {
    return boxed ? cornersOf(this.reach.bounds) : this.outline;
  }
}

/** The shares of the width and of the height that are free: never none, however small a page is. */
const freeOf = (
  {left, right, top, bottom}: Insets,
  boxed: Boxed | null = null,
): [number, number] => {
  const [across, down] = boxed ?? [0, 0];
  const besides = (covered: number, room: number): number => {
    const free = Math.max(kLeastFree, 1 - covered);
    return free - Math.min(2 * room, free / 2);
  };
  return [besides(left + right, across), besides(top + bottom, down)];
};

/** The middle of the free area, in pixels. */
const middleOf = (
  {left, right, top, bottom}: Insets,
  width: number,
  height: number,
): [number, number] => [((1 + left - right) / 2) * width, ((1 + top - bottom) / 2) * height];

/** Puts the centre of a picture of `scale` times the canvas's size between the insets. */
function placeBetween(
  {left, right, top, bottom}: Insets,
  lens: Lens,
  {width, height}: {width: number; height: number},
  scale = 1,
): void {
  lens.setPart({
    fullWidth: scale * width,
    fullHeight: scale * height,
    x: ((scale - 1 + right - left) / 2) * width,
    y: ((scale - 1 + bottom - top) / 2) * height,
    width,
    height,
  });
}

const endsOf = (places: number[]): [number, number] => [Math.min(...places), Math.max(...places)];

/** The bounds round both; the first may be empty. */
function union(a: readonly number[], b: readonly number[]): number[] {
  if (a.length === 0) return [...b];
  return a.map((end, i) => (i < 3 ? Math.min : Math.max)(end, b[i]!));
}

const isSame = (a: readonly number[], b: readonly number[]): boolean =>
  a.length === b.length && a.every((end, i) => end === b[i]);

/**
 * The part of the focus that is seen from outside: its side at a face of the bounds that faces the
 * eye. Null if no such face is near: walls would hide the focus.
 */
function seenPart(focus: number[], bounds: number[], direction: Vector): number[] | null {
  const sides = direction.map((towardsEye, axis) => (towardsEye > 0 ? axis + 3 : axis));
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
