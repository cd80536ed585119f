// Answers the page's questions about the mesh as it is now: what lies under the pointer, and a
// field along a line.

import type {Assembler} from '../decode/assembler';
import type * as Module from '../integrals/integrals';
import type {Integrals} from '../integrals/integrals';
import {labelsOfCells} from '../layers/part_cells';
import {kLayerWork} from '../layers/layer_work';
import {keptCells} from '../layers/shown';
import {
  along,
  barycentric,
  below,
  cellAt,
  placesOf,
  stretches,
  valueAt,
  type Ray,
  type Stretch,
} from '../picture/cell_ray';
import {infoIn} from '../picture/derived_field';
import {cuttingPlanes, type Display, type MeshArrays} from '../picture/display';
import {FieldScale, kMagnitude, scalarRange, type Scalar} from '../picture/field_scale';
import {histogramOf, type Axis, type Histogram} from '../picture/histogram';
import {meshArrays} from '../picture/mesh_arrays';
import {countParts, type PartCount} from '../picture/part_counts';
import type {Cells} from '../picture/section';
import type {LineSoup} from '../picture/streamlines';
import {positionOf, type Vector} from '../protocol/geometry';
import type {FieldInfo} from '../protocol/fields';
import type {Manifest} from '../protocol/manifest';
import {retry} from '../transport/retry';

/** The values of one field at a place, one a component; NaN if missing. */
export interface FieldValue {
  field: number;
  values: number[];
}

export interface Pick {
  cell: number;
  /** Its vertices. */
  corners: number[];
  /** Their places on the lattice, as they are drawn. */
  places: Vector[];
  /** In the mesh's own coordinates; `lattice` is the same place on the lattice. */
  position: Vector;
  lattice: Vector;
  /** The same places of the mesh without its warp; null if it has none. */
  rest: {position: Vector; lattice: Vector} | null;
  /** Only fields that are here. */
  fields: FieldValue[];
}

/**
 * A polyline: ascending positions along the line in the mesh's unit, and the coloured value at
 * each. NaN separates cells that do not touch.
 */
export interface Probe {
  at: number[];
  values: number[];
  length: number;
}

/** A place on a line. It has no fields where no cell is. */
export interface LineValues {
  /** The distance from the line's beginning, in the mesh's unit. */
  at: number;
  position: Vector;
  fields: FieldValue[];
}

export interface Numbers extends Integrals {
  /** The level of the mesh that they are of. */
  level: number;
  color: Scalar | null;
}

/** Places of the mesh at rest, on the lattice. */
export interface KeptPlaces {
  points: Vector[];
  lines: [from: Vector, to: Vector][];
  /** The places of the least and the largest value are wanted, too. */
  hasExtremes: boolean;
}

/** The coloured values along a line; NaN: it has none. */
export interface AlongLine {
  /** By length, of values that are there. */
  mean: number;
  least: number;
  largest: number;
}

export interface KeptLine extends AlongLine {
  /** Where a warp moves them. */
  ends: [Pick, Pick];
  /** In the mesh's own unit. */
  length: number;
}

/** All are of one picture. */
export interface KeptValues {
  level: number;
  color: Scalar | null;
  points: (Pick | null)[];
  lines: (KeptLine | null)[];
  /** Null: there is none. Labels have none: their numbers stand for names. */
  extremes: (Pick | null)[];
}

export class Inspector {
  /** The cells of places that were asked about, in which mesh. */
  private found: {chunks: number; manifest: Manifest | null; cells: Map<string, number>} | null =
    null;

  constructor(private readonly assembler: Assembler) {}

  /** Null while there is no mesh. The integrals are loaded on use. */
  async numbers(display: Display): Promise<Numbers | null> {
    const {ShownIntegrals} = await integralsModule();
    const mesh = meshArrays(this.assembler, display);
    if (!mesh) return null;
    const integrals = new ShownIntegrals(mesh, display, this.assembler.manifest!).all();
    return {...integrals, level: this.level, color: display.color};
  }

  /** Values of one picture: a series that plays shows another one before the next question. */
  async kept(places: KeptPlaces, display: Display): Promise<KeptValues | null> {
    const {color} = display;
    const integrals = places.hasExtremes ? await integralsModule() : null;
    const mesh = meshArrays(this.assembler, display);
    if (!mesh) return null;
    const {manifest} = this.assembler;
    const isLabel = color ? infoIn(display, manifest!, color.field).labels !== undefined : true;
    const all =
      integrals && !isLabel ? new integrals.ShownIntegrals(mesh, display, manifest!).all() : null;
    const extremes = (all ? integrals!.extremesOf(all) : []).map((extreme) => {
      const cell = extreme ? cellAt(mesh, extreme.place) : -1;
      return extreme && cell >= 0 ? this.pickAt(mesh, cell, extreme.place, display) : null;
    });
    return {
      level: this.level,
      color,
      points: places.points.map((place) => this.at(place, display)),
      lines: places.lines.map((ends) => this.keptLine(ends, display)),
      extremes,
    };
  }

  /** A coarse mesh may end before a place. Without a warp the line goes there all the same. */
  private keptLine(places: readonly Vector[], display: Display): KeptLine | null {
    const [from, to] = places.map((lattice) => {
      const pick = this.at(lattice, display);
      const position = this.positionOf(lattice);
      return pick && !pick.rest ? {...pick, lattice, position} : pick;
    });
    const probe = from && to && this.probe(from.lattice, to.lattice, display);
    return probe ? {ends: [from, to], length: probe.length, ...alongLine(probe)} : null;
  }

  private get level(): number {
    return this.assembler.statistics([]).level;
  }

  /** The first visible thing that `ray` (lattice coordinates) meets; null if there is none. */
  pick(ray: Ray, display: Display): Pick | null {
    const mesh = meshArrays(this.assembler, display);
    if (!mesh) return null;
    const cells = {...mesh, kept: keptCells(mesh, display)};
    let best: {cell: number; t: number} | null = null;
    for (const stretch of stretches(cells, ray, 0, Infinity)) {
      const t = firstSeen(mesh, ray, stretch, display);
      if (t < (best?.t ?? Infinity)) best = {cell: stretch.cell, t};
    }
    return best && this.pickAt(cells, best.cell, along(ray, best.t), display);
  }

  /** Null: the place has moved out of the cell, or there are no vectors yet. */
  async trace(
    {cell, place}: {cell: number; place: Vector},
    display: Display,
  ): Promise<LineSoup | null> {
    const lines = await import('../lines/shown_lines').catch(() => null);
    const mesh = meshArrays(this.assembler, display);
    return lines && mesh && lines.makeAt(this.assembler, mesh, display, {cell, place});
  }

  /** The coloured field from one lattice point to another; null while there is none. */
  probe(from: Vector, to: Vector, display: Display): Probe | null {
    const mesh = meshArrays(this.assembler, display);
    if (!mesh) return null;
    const ray = rayBetween(from, to);
    const length = this.lengthOf(ray);
    const scale = display.color && mesh.scale(display.color);
    const probe: Probe = {at: [], values: [], length};
    if (!scale || length === 0) return probe;
    const found = stretches({...mesh, kept: keptCells(mesh, display)}, ray, 0, 1).sort(
      (a, b) => a.from - b.from,
    );
    let end = -1;
    for (const {cell, from: first, to: last} of found) {
      if (end >= 0 && first > end + 1e-6) push(probe, end * length, NaN);
      for (const t of [first, last])
        push(probe, t * length, valueAt(mesh, scale, cell, along(ray, t)));
      end = last;
    }
    return this.unscaled(probe, display);
  }

  /** All fields that are here from one lattice point to another, each place once. */
  line(from: Vector, to: Vector, display: Display): LineValues[] {
    const mesh = meshArrays(this.assembler, display);
    if (!mesh) return [];
    const ray = rayBetween(from, to);
    const cells = {...mesh, kept: keptCells(mesh, display)};
    const length = this.lengthOf(ray);
    return placesOf(stretches(cells, ray, 0, 1)).map(({t, cell}) => {
      const place = along(ray, t);
      const fields = cell === null ? [] : this.fieldsAt(cells, cell, place, display);
      return {at: t * length, position: this.positionOf(place), fields};
    });
  }

  /** The cell at a lattice place of the mesh at rest, and where that is drawn; null: no mesh. */
  at(place: Vector, display: Display): Pick | null {
    const rest = meshArrays(this.assembler);
    const mesh = meshArrays(this.assembler, display);
    const cell = rest ? this.cellOf(rest, place) : -1;
    if (!rest || !mesh || cell < 0) return null;
    const shares = this.sharesIn(rest, cell, place);
    return this.pickAt(mesh, cell, placeIn(mesh, cell, shares), display);
  }

  /**
   * By field its values at a lattice place of the mesh at rest, one a component. There are none if
   * the field is not here for all of the mesh. A place beside the mesh has those of the cell next
   * to it.
   */
  values(place: Vector, fields: readonly number[]): number[][] {
    const mesh = meshArrays(this.assembler);
    const cell = mesh ? this.cellOf(mesh, place) : -1;
    if (!mesh || cell < 0) return fields.map(() => []);
    const shares = this.sharesIn(mesh, cell, place);
    const whole = new Set(this.assembler.wholeFields);
    return fields.map((field) =>
      whole.has(field) ? (this.valuesOf(mesh, cell, shares, field) ?? []) : [],
    );
  }

  /** Looks through all cells once for a place and a mesh. */
  private cellOf(cells: Cells, place: Vector): number {
    const {codec, manifest} = this.assembler;
    const chunks = codec.chunksApplied;
    if (this.found?.chunks !== chunks || this.found.manifest !== manifest)
      this.found = {chunks, manifest, cells: new Map()};
    const known = this.found.cells;
    const key = place.join();
    if (!known.has(key)) known.set(key, cellAt(cells, place));
    return known.get(key)!;
  }

  /** Shares of the corners of a cell. A place beside the cell has those of a place in it. */
  private sharesIn(mesh: Cells, cell: number, place: Vector): number[] {
    const inside = barycentric(mesh, cell, place).map((share) => Math.max(0, share));
    const sum = inside.reduce((a, b) => a + b);
    return inside.map((share) => share / sum);
  }

  /** Counts the values of the coloured field; null while there are none. */
  histogram(axis: Axis, display: Display): Histogram | null {
    const {color} = display;
    const mesh = meshArrays(this.assembler, {derived: display.derived});
    const info = color && mesh && infoIn(display, this.assembler.manifest!, color.field);
    const scale = color && mesh?.scale(color);
    return mesh && info && scale ? histogramOf(scale, mesh.tetrahedra, info, color, axis) : null;
  }

  /** The parts of the whole mesh at rest; null while the label has no values. */
  parts(field: number): PartCount[] | null {
    const mesh = meshArrays(this.assembler);
    const info = this.assembler.manifest?.fields[field];
    const scalar = {field, component: kMagnitude};
    const labelOf = mesh && info && labelsOfCells(mesh, {scalar, range: info.range});
    return labelOf ? countParts(mesh, labelOf) : null;
  }

  private unscaled(probe: Probe, display: Display): Probe {
    const info = infoIn(display, this.assembler.manifest!, display.color!.field);
    const [low, high] = scalarRange(info, display.color!.component);
    return {...probe, values: probe.values.map((value) => low + value * (high - low))};
  }

  private pickAt(cells: MeshArrays, cell: number, lattice: Vector, display: Display): Pick {
    const rest = display.warp ? this.restOf(cells, cell, lattice) : null;
    return {
      cell,
      corners: cornersOf(cells, cell),
      places: cornersOf(cells, cell).map(
        (corner) => [...cells.points.subarray(3 * corner, 3 * corner + 3)] as Vector,
      ),
      lattice,
      position: this.positionOf(lattice),
      rest: rest && {lattice: rest, position: this.positionOf(rest)},
      fields: this.fieldsAt(cells, cell, lattice, display),
    };
  }

  /** Where a place of a moved cell was before. */
  private restOf(cells: Cells, cell: number, place: Vector): Vector {
    const points = this.assembler.codec.points();
    return placeIn({...cells, points}, cell, barycentric(cells, cell, place));
  }

  /** In the mesh's own coordinates. */
  private positionOf(lattice: Vector): Vector {
    return positionOf(this.assembler.manifest!.lattice, lattice);
  }

  /** In the mesh's own unit. */
  private lengthOf({direction}: Ray): number {
    return this.assembler.manifest!.lattice.step * Math.hypot(...direction);
  }

  private fieldsAt(
    cells: MeshArrays,
    cell: number,
    lattice: Vector,
    {derived}: Display,
  ): FieldValue[] {
    const shares = barycentric(cells, cell, lattice);
    const own = this.assembler.manifest!.fields.flatMap((_, field) => {
      const values = this.valuesOf(cells, cell, shares, field);
      return values ? [{field, values}] : [];
    });
    const made = (derived?.fields ?? []).flatMap(({info, inputs}, i) => {
      const field = derived!.first + i;
      const scale = inputs.length > 0 ? cells.scale({field, component: kMagnitude}) : null;
      if (!scale) return [];
      const [low, high] = info.range;
      const share = valueIn(scale, tuplesOf(cells, cell, info), shares);
      return [{field, values: [low + share * (high - low)]}];
    });
    return [...own, ...made];
  }

  /** One a component; null while the field has no values. */
  private valuesOf(cells: Cells, cell: number, shares: number[], field: number): number[] | null {
    const {codec, manifest} = this.assembler;
    const info = manifest!.fields[field]!;
    const values = codec.field(field, info.components);
    return values && components(info, values, tuplesOf(cells, cell, info), shares);
  }
}

const integralsModule = (): Promise<typeof Module> => retry(() => import('../integrals/integrals'));

const cornersOf = ({tetrahedra}: Cells, cell: number): number[] => [
  ...tetrahedra.subarray(4 * cell, 4 * cell + 4),
];

/** The places of its values for a cell. */
const tuplesOf = (cells: Cells, cell: number, {association}: FieldInfo): number[] =>
  association === 'cell' ? [cell] : cornersOf(cells, cell);

/** The place of the shares of a cell's corners. */
function placeIn(cells: Cells, cell: number, shares: readonly number[]): Vector {
  const corners = cornersOf(cells, cell);
  return [0, 1, 2].map((axis) =>
    corners.reduce((sum, corner, i) => sum + shares[i]! * cells.points[3 * corner + axis]!, 0),
  ) as Vector;
}

function rayBetween(from: Vector, to: Vector): Ray {
  return {origin: from, direction: to.map((x, axis) => x - from[axis]!) as Vector};
}

/** The t at which the ray first sees something of this stretch; Infinity if it never does. */
function firstSeen(mesh: MeshArrays, ray: Ray, stretch: Stretch, display: Display): number {
  const visible = below(cuttingPlanes(display), ray, stretch);
  if (!visible) return Infinity;
  return Math.min(
    display.body && display.mode !== 'slice' ? visible.from : Infinity,
    ...kLayerWork.map((work) => work.seenFrom?.(mesh, display, ray, visible) ?? Infinity),
  );
}

/** `tuples` is one cell, or the four corners that `shares` weigh. */
function valueIn(scale: FieldScale, tuples: number[], shares: readonly number[]): number {
  if (tuples.length === 1) return scale.at(tuples[0]!);
  return tuples.reduce((sum, tuple, i) => sum + shares[i]! * scale.at(tuple), 0);
}

function components(
  info: FieldInfo,
  values: Int32Array,
  tuples: number[],
  shares: number[],
): number[] {
  return Array.from({length: info.components}, (_, c) => {
    const scale = new FieldScale(values, info, c);
    const [low, high] = scalarRange(info, info.components > 1 ? c : kMagnitude);
    return low + valueIn(scale, tuples, shares) * (high - low);
  });
}

function push(probe: Probe, at: number, value: number): void {
  probe.at.push(at);
  probe.values.push(value);
}

/** Values are linear between the places of a probe. Where cells share a place, parts cancel. */
export function alongLine({at, values}: Omit<Probe, 'length'>): AlongLine {
  const known = values.filter((value) => !Number.isNaN(value));
  if (known.length === 0) return {mean: NaN, least: NaN, largest: NaN};
  let [sum, length] = [0, 0];
  for (let i = 1; i < at.length; ++i) {
    const middle = (values[i]! + values[i - 1]!) / 2;
    if (Number.isNaN(middle)) continue;
    const part = at[i]! - at[i - 1]!;
    sum += part * middle;
    length += part;
  }
  return {
    mean: length > 0 ? sum / length : known[0]!,
    least: known.reduce((a, b) => Math.min(a, b)),
    largest: known.reduce((a, b) => Math.max(a, b)),
  };
}
