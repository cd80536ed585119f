// The arrows of a field of vectors or symmetric tensors: where they stand, and how long they are.

import {kArrowWidth, type ArrowSoup, type ArrowsRequest} from '../picture/arrows';
import {surfaceFaces} from '../picture/cell_surface';
import {kMissing, type FieldScale} from '../picture/field_scale';
import {pointBounds} from '../picture/triangle_soup';
import {dot, sidesOf, type Plane, type Vector} from '../protocol/geometry';
import {cellsAt} from './cells_at';
import {principalAxes} from './principal_axes';
import {planePlaces} from './seeds';
import {placesOnFaces, type CellPlace} from './surface_places';
import {VectorWalk, type Vectors, type WalkMesh} from './vector_walk';
import {isHole} from '../picture/section';

export interface ArrowsMesh extends WalkMesh {
  /** 3 vertices a triangle of the boundary. */
  boundary: Uint32Array;
  kept: Uint8Array | null;
  /** The lattice's, in the mesh's unit. */
  step: number;
  /** The longest side of the mesh at rest, in lattice steps. */
  longest: number;
}

/** The part of a display that says where arrows stand. */
export interface Shown {
  /** The surface is drawn. */
  hasSurface: boolean;
  /** The part above any of them is cut away. */
  cutting: readonly Plane[];
  /** Each has a cut. */
  cuts: readonly Plane[];
}

/** More are no picture any more, and graphics draw so many smoothly. */
export const kMostArrows = 20_000;
/** Points of the grid over the mesh's box. */
const kMostPlaces = 100_000;
/** More than there are points of a grid along an axis. */
const kGrid = 4096;
/** Logarithmic lengths span so many decades. */
const kDecades = 3;
const kTensorComponents = 6;
/** Two along each principal direction. */
const kArrowsOfTensor = 6;
/** Shorter arrows, over the longest one, are left out. */
const kLeastLength = 0.02;

export class Arrows {
  private readonly walk: VectorWalk;
  private readonly isTensor: boolean;
  /** The longest vector, in the field's unit. */
  private readonly longest: number;
  private readonly box: number[];
  private spacing: number;
  private isCut = false;

  constructor(
    private readonly mesh: ArrowsMesh,
    private readonly vectors: Vectors,
    private readonly request: ArrowsRequest,
  ) {
    const {components, range} = vectors.info;
    this.isTensor = components === kTensorComponents;
    this.walk = new VectorWalk(mesh, this.isTensor ? null : vectors, 1);
    this.longest = range[1];
    // a warp may make the mesh larger
    this.box = pointBounds(mesh.points, mesh.boundary);
    this.spacing = Math.max(mesh.longest, ...sidesOf(this.box)) / request.density;
  }

  /** `scale` colours; null: they are plain. */
  all(shown: Shown, scale: FieldScale | null): ArrowSoup {
    const places = this.places(shown);
    const {most} = this;
    if (places.length > most) this.isCut = true;
    const few = places.filter((_, i) => (i * most) % places.length < most);
    const all = few.flatMap((its) => this.arrowsAt(its, scale));
    const arrows = new Float32Array(kArrowWidth * all.length);
    all.forEach(({tail, way, value}, i) => arrows.set([...tail, ...way, value], kArrowWidth * i));
    return {arrows, count: all.length, isCut: this.isCut};
  }

  /** Places at most. */
  private get most(): number {
    return this.isTensor ? Math.floor(kMostArrows / kArrowsOfTensor) : kMostArrows;
  }

  private arrowsAt({cell, place, outward}: CellPlace, scale: FieldScale | null): Arrow[] {
    const {request, walk} = this;
    walk.readAt(cell, place);
    const value = scale && request.isColored ? walk.valueOf(scale) : NaN;
    if (this.isTensor)
      return principalAxes(this.tensorAt(cell)).flatMap(({value: size, direction}) =>
        pairOf(place, this.scaled(direction, size, 0.5), size > 0).map((its) => ({...its, value})),
      );
    const vector: Vector = [walk.vx, walk.vy, walk.vz];
    const way = this.scaled(vector, Math.hypot(...vector), 1);
    if (!way) return [];
    // Arrows into the drawn body end at its surface, so that all of them are seen.
    const back = outward ? Number(dot(way, outward) < 0) : 0.5;
    return [{tail: place.map((x, axis) => x - back * way[axis]!) as Vector, way, value}];
  }

  /** At the place of the walk. */
  private tensorAt(cell: number): number[] {
    const {values, info} = this.vectors;
    const {mesh, shares} = this.walk;
    return info.minimum.map((least, component) => {
      let sum = 0;
      for (let corner = 0; corner < 4; ++corner) {
        const at = kTensorComponents * mesh.tetrahedra[4 * cell + corner]! + component;
        const integer = values[at]!;
        sum += shares[corner]! * (integer === kMissing ? NaN : least + info.step * integer);
      }
      return sum;
    });
  }

  private places(shown: Shown): CellPlace[] {
    switch (this.request.places) {
      case 'shown':
        return this.shownPlaces(shown);
      case 'volume':
        return this.gridPlaces();
      case 'vertices':
        return this.vertices();
    }
  }

  private shownPlaces({hasSurface, cutting, cuts}: Shown): CellPlace[] {
    const {box, mesh, spacing} = this;
    const isBelow = (planes: readonly Plane[], place: Vector): boolean =>
      planes.every(({normal, offset}) => dot(normal, place) <= offset);
    const surface = hasSurface
      ? placesOnFaces(mesh, surfaceFaces(mesh, mesh.boundary), spacing)
      : [];
    const inCuts = cuts.flatMap((plane) => {
      const others = cutting.filter((other) => other !== plane);
      const all = planePlaces(plane, box, spacing).filter((place) => isBelow(others, place));
      const isOpen = cutting.includes(plane);
      return this.inside(all).map((its) => ({...its, ...(isOpen && {outward: plane.normal})}));
    });
    return [...surface.filter(({place}) => isBelow(cutting, place)), ...inCuts];
  }

  private inside(places: readonly Vector[]): CellPlace[] {
    const few = places.slice(0, kMostPlaces);
    this.isCut ||= few.length < places.length;
    const cells = cellsAt(this.walk, few);
    return few.flatMap((place, i) => {
      const cell = cells[i]!;
      return cell >= 0 && this.mesh.kept?.[cell] !== 0 ? [{cell, place}] : [];
    });
  }

  /**
   * The points of a grid that lie in cells. Each cell looks at the points in its box: there are far
   * fewer than cells.
   */
  private gridPlaces(): CellPlace[] {
    const {box, mesh, walk} = this;
    const pointsIn = (spacing: number): number =>
      sidesOf(box).reduce((all, side) => all * (1 + side / spacing), 1);
    while (pointsIn(this.spacing) > kMostPlaces) {
      this.spacing *= 1.25;
      this.isCut = true;
    }
    const found = new Map<number, CellPlace>();
    const [low, high] = [
      [0, 0, 0],
      [0, 0, 0],
    ];
    for (let cell = 0; cell < mesh.tetrahedra.length / 4; ++cell) {
      if (mesh.kept?.[cell] === 0 || isHole(mesh.tetrahedra, cell)) continue;
      boxOf(mesh, cell, low, high);
      this.eachInBox(low, high, (key, place) => {
        if (!found.has(key) && walk.holds(cell, place)) found.set(key, {cell, place});
      });
    }
    return [...found.keys()].sort((p, q) => p - q).map((key) => found.get(key)!);
  }

  /** Every other layer of the grid lies between the places of the last. */
  private eachInBox(
    low: readonly number[],
    high: readonly number[],
    use: (key: number, place: Vector) => void,
  ): void {
    const {spacing} = this;
    for (let z = Math.ceil(low[2]! / spacing); z * spacing <= high[2]!; ++z) {
      const aside = z & 1 ? 0.5 : 0;
      const fromX = Math.ceil(low[0]! / spacing - aside);
      const fromY = Math.ceil(low[1]! / spacing - aside);
      const columns = Math.floor(high[0]! / spacing - aside) - fromX + 1;
      const count = columns * Math.max(0, Math.floor(high[1]! / spacing - aside) - fromY + 1);
      for (let i = 0; i < count; ++i) {
        const [x, y] = [fromX + (i % columns), fromY + Math.floor(i / columns)];
        const place: Vector = [(x + aside) * spacing, (y + aside) * spacing, z * spacing];
        use((z * kGrid + y) * kGrid + x, place);
      }
    }
  }

  private vertices(): CellPlace[] {
    const {points, tetrahedra, kept} = this.mesh;
    const cellOf = new Int32Array(points.length / 3).fill(-1);
    for (let at = 0; at < tetrahedra.length; ++at) {
      const cell = at >> 2;
      if (kept?.[cell] !== 0 && !isHole(tetrahedra, cell)) cellOf[tetrahedra[at]!] = cell;
    }
    const all = cellOf.reduce((count, cell) => count + Number(cell >= 0), 0);
    this.isCut = all > this.most;
    const places: CellPlace[] = [];
    let i = 0;
    cellOf.forEach((cell, vertex) => {
      if (cell < 0 || (i++ * this.most) % all >= this.most) return;
      const at = 3 * vertex;
      places.push({cell, place: [points[at]!, points[at + 1]!, points[at + 2]!]});
    });
    return places;
  }

  /**
   * The way of an arrow along a direction, for a vector of this length; `share` of the length is
   * drawn. Null: there is no vector, or it is too short to be seen.
   */
  private scaled(direction: Vector, size: number, share: number): Vector | null {
    const {longest, request, spacing} = this;
    const length = Math.hypot(...direction);
    const part = Math.abs(size) / longest;
    if (!(length > 0 && part > 0)) return null;
    const parts = {magnitude: part, log: 1 + Math.log10(part) / kDecades, equal: 1};
    const its = parts[request.length];
    if (!(its >= kLeastLength)) return null;
    const factor = (share * its * request.size * spacing) / length;
    return direction.map((x) => x * factor) as Vector;
  }
}

function boxOf({points, tetrahedra}: WalkMesh, cell: number, low: number[], high: number[]): void {
  const a = 3 * tetrahedra[4 * cell]!;
  const b = 3 * tetrahedra[4 * cell + 1]!;
  const c = 3 * tetrahedra[4 * cell + 2]!;
  const d = 3 * tetrahedra[4 * cell + 3]!;
  for (let axis = 0; axis < 3; ++axis) {
    const [p, q] = [points[a + axis]!, points[b + axis]!];
    const [r, s] = [points[c + axis]!, points[d + axis]!];
    low[axis] = Math.min(p, q, r, s);
    high[axis] = Math.max(p, q, r, s);
  }
}

interface Arrow {
  tail: Vector;
  way: Vector;
  /** NaN: it is plain. */
  value: number;
}

/** Two arrows apart from a place, or (in compression) towards it. */
function pairOf(place: Vector, way: Vector | null, isApart: boolean): Omit<Arrow, 'value'>[] {
  if (!way) return [];
  return [1, -1].map((sign) => {
    const own = way.map((x) => sign * x) as Vector;
    const end = place.map((x, axis) => x + own[axis]!) as Vector;
    return isApart ? {tail: place, way: own} : {tail: end, way: own.map((x) => -x) as Vector};
  });
}
