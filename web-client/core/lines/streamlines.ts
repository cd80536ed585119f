// The streamlines of a field of vectors, from all seeds.

import type {FieldScale} from '../picture/field_scale';
import type {LineSoup, StreamlinesRequest} from '../picture/streamlines';
import {pointBounds} from '../picture/triangle_soup';
import type {Vector} from '../protocol/geometry';
import {cellsAt} from './cells_at';
import {EvenLines} from './even_lines';
import {LineBuilder} from './line_builder';
import {placesOf} from './seeds';
import {Tracer, type TraceLimits} from './trace';
import {VectorWalk, type Vectors, type WalkMesh} from './vector_walk';

/** Steps of all lines: a second or two of work. */
export const kMostSteps = 1_000_000;
/** Vectors below this share of the longest one end a line. */
const kStillShare = 1e-6;

export interface LinesMesh extends WalkMesh {
  /** 3 vertices a triangle of the boundary. */
  boundary: Uint32Array;
  /** The lattice's, in the mesh's unit. */
  step: number;
}

/** `scale` colours; null: the lines are plain. */
export function streamlinesOf(
  mesh: LinesMesh,
  vectors: Vectors,
  request: StreamlinesRequest,
  scale: FieldScale | null,
): LineSoup {
  const box = pointBounds(mesh.points, mesh.boundary);
  const diagonal = Math.hypot(...[0, 1, 2].map((i) => box[i + 3]! - box[i]!));
  const walk = new VectorWalk(mesh, vectors, mesh.step);
  const tracer = new Tracer(walk);
  const lines = new LineBuilder(scale);
  const {steps, length, time} = request.limits;
  const fastest = vectors.info.range[1] / mesh.step;
  const limits: TraceLimits = {
    steps,
    time,
    length: length * diagonal,
    stillSpeed: kStillShare * fastest,
  };
  const isEnough = (): boolean => tracer.steps >= kMostSteps || lines.isFull;

  const trace = (cell: number, place: Vector): Float32Array | null => {
    if (cell < 0 || isEnough()) return null;
    tracer.follow(cell, place, -1, limits, lines);
    lines.turn();
    walk.enter(cell);
    if (walk.find(...place)) lines.add(place, 0, walk);
    tracer.follow(cell, place, 1, limits, lines);
    return lines.end();
  };

  for (const seeds of request.seeds) {
    const places = placesOf(seeds, box);
    const cells = cellsAt(walk, places);
    if (seeds.kind === 'even')
      new EvenLines(box).choose(places, seeds.count, (i) => trace(cells[i]!, places[i]!));
    else places.forEach((place, i) => trace(cells[i]!, place));
  }
  return lines.take(fastest > 0 ? diagonal / fastest : 1, isEnough());
}
