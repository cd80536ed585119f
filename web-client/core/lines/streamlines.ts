// The streamlines of a field of vectors, from all seeds.

import type {FieldScale} from '../picture/field_scale';
import type {LineLimits, LineSoup, Seeds} from '../picture/streamlines';
import {pointBounds} from '../picture/triangle_soup';
import {sidesOf, type Vector} from '../protocol/geometry';
import {cellsAt} from './cells_at';
import {chooseEven} from './even_lines';
import {InstantsClock, type TimedVectors} from './instants_clock';
import {LineBuilder} from './line_builder';
import {placesOf} from './seeds';
import {Tracer, type TraceLimits} from './trace';
import {VectorWalk, type Vectors, type WalkMesh} from './vector_walk';

/** Steps of all lines: a second or two of work. */
export const kMostSteps = 1_000_000;
/** Cells that all walks go through: as much work as kMostSteps. */
const kMostTurns = 10_000_000;
/** Vectors below this share of the longest one end a line. */
const kStillShare = 1e-6;

export interface LinesMesh extends WalkMesh {
  /** 3 vertices a triangle of the boundary. */
  boundary: Uint32Array;
  /** The lattice's, in the mesh's unit. */
  step: number;
}

export class Streamlines {
  private readonly walk: VectorWalk;
  private readonly tracer: Tracer;
  private readonly lines: LineBuilder;
  private readonly box: number[];
  private readonly limits: TraceLimits;
  private readonly crossing: number;

  /**
   * `scale` colours; null: the lines are plain. With `instants` the vectors change in time, and are
   * those of `begin` at the seeds.
   */
  constructor(
    mesh: LinesMesh,
    {values, info}: Vectors,
    {steps, length, time}: LineLimits,
    scale: FieldScale | null,
    changes: {instants: readonly TimedVectors[]; begin: number} | null = null,
  ) {
    this.box = pointBounds(mesh.points, mesh.boundary);
    const diagonal = Math.hypot(...sidesOf(this.box));
    const fastest = info.range[1] / mesh.step;
    this.crossing = fastest > 0 ? diagonal / fastest : 1;
    this.limits = {steps, time, length: length * diagonal, stillSpeed: kStillShare * fastest};
    this.walk = new VectorWalk(mesh, {values, info}, mesh.step);
    const clock = changes && new InstantsClock(this.walk, changes.instants, changes.begin);
    this.tracer = new Tracer(this.walk, clock);
    this.lines = new LineBuilder(scale);
  }

  all(seeds: readonly Seeds[]): LineSoup {
    const isIn = (some: readonly Vector[]): boolean[] =>
      Array.from(cellsAt(this.walk, some), (cell) => cell >= 0);
    const byKind = seeds.map((its) => ({its, places: placesOf(its, this.box, isIn)}));
    // one pass over the cells for all
    const cells = cellsAt(
      this.walk,
      byKind.flatMap(({places}) => places),
    );
    let first = 0;
    for (const {its, places} of byKind) {
      const from = first;
      first += places.length;
      const trace = (i: number): Float32Array | null => this.trace(cells[from + i]!, places[i]!);
      if (its.kind === 'even') chooseEven(this.box, places, its.count, trace);
      else places.forEach((_, i) => trace(i));
      if (this.isEnough) break;
    }
    return this.lines.take(this.crossing, this.isEnough);
  }

  /** The line through one place; null: the cell does not have it. */
  at(cell: number, place: Vector): LineSoup | null {
    const isThere = cell < this.walk.mesh.tetrahedra.length / 4 && this.walk.holds(cell, place);
    if (!isThere || !this.trace(cell, place)) return null;
    return this.lines.take(this.crossing, false);
  }

  private get isEnough(): boolean {
    const isLong = this.tracer.steps >= kMostSteps || this.walk.turns >= kMostTurns;
    return isLong || this.lines.isFull;
  }

  private trace(cell: number, place: Vector): Float32Array | null {
    const {limits, lines, tracer, walk} = this;
    if (cell < 0 || this.isEnough) return null;
    tracer.follow(cell, place, -1, limits, lines);
    lines.turn();
    walk.enter(cell);
    if (walk.find(...place)) lines.add(place, 0, walk);
    tracer.follow(cell, place, 1, limits, lines);
    return lines.end();
  }
}
