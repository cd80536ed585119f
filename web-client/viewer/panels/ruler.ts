// A box round the mesh with numbers on its edges, as lines and texts. All of it lies behind the
// mesh: it has the edges at the silhouette, and those that the mesh may hide.

import {niceTicks} from '../../core/picture/ticks';
import type {Vector} from '../../core/protocol/geometry';
import type {Matrix} from '../../webgl/matrix';
import type {Scale} from '../settings/length_unit';

/** Each number has this length of an edge, in units. */
const kPerTick = 48;
const kMaxTicks = 9;
const kTickLength = 5;
/** Between an edge and its numbers, and between those and the axis' name. */
const kGap = 9;
const kNameGap = 8;
/** The size of texts, and the width of a letter. */
export const kRulerText = 12;
const kLetter = 6.8;
/** Texts this near to each other cannot be told apart. */
const kApart = 3;
/** A face that takes a smaller part of the picture is turned away. */
const kMinFacing = 1e-4;
/** Nothing nearer to the eye is drawn, as a share of its distance. */
const kNear = 1e-3;
/** Against lying low. */
const kLeftCounts = 0.5;
/** The room for numbers and names on each side, in units. */
export const kRulerRoom = [52, 36] as const;

const kAxes = [0, 1, 2] as const;
type Axis = (typeof kAxes)[number];

export interface Canvas {
  toCanvas: Matrix;
  /** In units: CSS pixels, or those of a figure. */
  width: number;
  height: number;
}

export type Line = readonly [x1: number, y1: number, x2: number, y2: number];

export interface RulerText {
  /** Its middle. */
  x: number;
  y: number;
  text: string;
}

export interface Ruler {
  box: Line[];
  /** Lines at the numbers, on the faces behind the mesh. */
  grid: Line[];
  ticks: Line[];
  numbers: RulerText[];
  names: RulerText[];
}

/** A corner of the box: bit `axis` is set at the high end. An edge is its corner at the low end. */
type Corner = number;
type Point = readonly [x: number, y: number];

/** `bounds` are in lattice coordinates. */
export function rulerOf(bounds: readonly number[], scale: Scale, canvas: Canvas): Ruler {
  const box = new Box(bounds, canvas);
  const ruler: Ruler = {box: [], grid: [], ticks: [], numbers: [], names: []};
  for (const axis of kAxes) {
    const edges = [...Array(8).keys()].filter((corner) => !(corner & (1 << axis)));
    for (const edge of edges)
      if (box.facing(edge, axis) < 2) ruler.box.push(...box.edge(edge, axis));
    addNumbers(ruler, box, edges, axis, scale);
  }
  ruler.numbers = apart(ruler.names, ruler.numbers);
  return ruler;
}

/** On the edge at the silhouette of the highest rank. */
function addNumbers(
  ruler: Ruler,
  box: Box,
  edges: readonly Corner[],
  axis: Axis,
  {origin, step, unit}: Scale,
): void {
  const [outer] = edges
    .filter((edge) => box.facing(edge, axis) === 1)
    .flatMap((edge) => box.edge(edge, axis).map((line) => ({edge, line})))
    .sort((a, b) => rank(b.line) - rank(a.line));
  const [low, high] = [0, 3].map((end) => origin[axis]! + step * box.bounds[axis + end]!);
  if (!outer || !(low! < high!)) return;
  const [x1, y1, x2, y2] = outer.line;
  const count = Math.min(kMaxTicks, Math.floor(Math.hypot(x2 - x1, y2 - y1) / kPerTick));
  const {ticks, factor} = niceTicks(low!, high!, Math.max(2, count));
  const away = awayFrom(box.middle, outer.line);
  const beside = (at: Point, text: string, reach: number): RulerText => ({
    x: at[0] + (reach + halfOf(text, away)) * away[0],
    y: at[1] + (reach + halfOf(text, away)) * away[1],
    text,
  });
  for (const {at, label} of ticks) {
    ruler.grid.push(...box.behind(edges, axis, at));
    const place = box.project(box.along(outer.edge, axis, at));
    if (!place) continue;
    const [x, y] = place;
    ruler.ticks.push([x, y, x + kTickLength * away[0], y + kTickLength * away[1]]);
    ruler.numbers.push(beside(place, label, kGap));
  }
  const widest = Math.max(0, ...ticks.map(({label}) => 2 * halfOf(label, away)));
  const more = [factor, unit].filter(Boolean).join(' ');
  const name = 'xyz'[axis]! + (more && ` [${more}]`);
  ruler.names.push(beside([(x1 + x2) / 2, (y1 + y2) / 2], name, kGap + widest + kNameGap));
}

/** Higher for edges that lie low, and rather to the left. */
const rank = ([x1, y1, x2, y2]: Line): number => y1 + y2 - kLeftCounts * (x1 + x2);

/** The direction across a line, away from a point. */
function awayFrom([x, y]: Point, [x1, y1, x2, y2]: Line): Point {
  const [across, down] = [y2 - y1, x1 - x2];
  const side = across * ((x1 + x2) / 2 - x) + down * ((y1 + y2) / 2 - y);
  const length = Math.sign(side || 1) * (Math.hypot(across, down) || 1);
  return [across / length, down / length];
}

/** How far a text reaches from its middle in this direction. */
const halfOf = (text: string, [x, y]: Point): number =>
  (kLetter * text.length * Math.abs(x) + kRulerText * Math.abs(y)) / 2;

/** The numbers that hide neither a name nor a number before them. */
function apart(names: readonly RulerText[], numbers: readonly RulerText[]): RulerText[] {
  const shown: RulerText[] = [];
  for (const its of numbers) {
    const hides = (other: RulerText): boolean =>
      Math.abs(its.y - other.y) < kRulerText &&
      Math.abs(its.x - other.x) < (kLetter * (its.text.length + other.text.length)) / 2 + kApart;
    if (![...names, ...shown].some(hides)) shown.push(its);
  }
  return shown;
}

/** A box of the lattice on a canvas. Faces are 0 to 2 at the low ends, 3 to 5 at the high ones. */
class Box {
  readonly middle: Point;
  private readonly fronts: readonly boolean[];

  constructor(
    readonly bounds: readonly number[],
    private readonly canvas: Canvas,
  ) {
    const corners = [0, 7].map((corner) => this.corner(corner)) as [Vector, Vector];
    const middle = kAxes.map((axis) => (corners[0][axis] + corners[1][axis]) / 2) as Vector;
    this.middle = this.project(middle) ?? [canvas.width / 2, canvas.height / 2];
    this.fronts = [0, 1, 2, 3, 4, 5].map((face) => this.seenArea(face) > kMinFacing);
  }

  isFront(face: number): boolean {
    return this.fronts[face]!;
  }

  /** How many of the two faces at an edge face the eye. */
  facing(edge: Corner, axis: Axis): number {
    const faces = kAxes
      .filter((other) => other !== axis)
      .map((other) => other + (edge & (1 << other) ? 3 : 0));
    return faces.filter((face) => this.isFront(face)).length;
  }

  /** A place on an edge, at a share of it. */
  along(edge: Corner, axis: Axis, share: number): Vector {
    const place = this.corner(edge);
    place[axis] += share * (this.bounds[axis + 3]! - this.bounds[axis]!);
    return place;
  }

  edge(edge: Corner, axis: Axis): Line[] {
    return this.line(this.along(edge, axis, 0), this.along(edge, axis, 1));
  }

  /** Lines across the faces that are turned away, at a share of the edges along `axis`. */
  behind(edges: readonly Corner[], axis: Axis, share: number): Line[] {
    const others = kAxes.filter((other) => other !== axis);
    return edges.flatMap((edge) =>
      others
        .filter((other) => !(edge & (1 << other)))
        .filter((other) => {
          const third = 3 - axis - other;
          return !this.isFront(third + (edge & (1 << third) ? 3 : 0));
        })
        .flatMap((other) => {
          const ends = [edge, edge | (1 << other)].map((its) => this.along(its, axis, share));
          return this.line(ends[0]!, ends[1]!);
        }),
    );
  }

  /** Its part before the eye; none may be. */
  line(from: Vector, to: Vector): Line[] {
    const [a, b] = [this.seen(from), this.seen(to)];
    const near = kNear * Math.max(a[2]!, b[2]!);
    if (near <= 0) return [];
    const cut = (behind: number[], before: number[]): number[] => {
      const share = (near - behind[2]!) / (before[2]! - behind[2]!);
      return behind[2]! >= near ? behind : behind.map((x, i) => x + share * (before[i]! - x));
    };
    return [[...this.place(cut(a, b)), ...this.place(cut(b, a))]];
  }

  /** Null: the point lies behind the eye. */
  project(point: Vector): Point | null {
    const seen = this.seen(point);
    return seen[2]! > 0 ? this.place(seen) : null;
  }

  private corner(corner: Corner): Vector {
    return kAxes.map((axis) => this.bounds[axis + (corner & (1 << axis) ? 3 : 0)]!) as Vector;
  }

  /** Homogeneous: across, up, and before the eye. */
  private seen([x, y, z]: Vector): number[] {
    const m = this.canvas.toCanvas;
    return [0, 1, 3].map((row) => m[row]! * x + m[row + 4]! * y + m[row + 8]! * z + m[row + 12]!);
  }

  private place([x, y, w]: readonly number[]): Point {
    const {width, height} = this.canvas;
    return [((x! / w! + 1) / 2) * width, ((1 - y! / w!) / 2) * height];
  }

  /** Positive if the face is seen from outside. Also right if a part lies behind the eye. */
  private seenArea(face: number): number {
    const axis = face % 3;
    const at = face < 3 ? 0 : 1 << axis;
    const [next, last] = [(axis + 1) % 3, (axis + 2) % 3].map((other) => at | (1 << other));
    const order = face < 3 ? [at, last!, next!] : [at, next!, last!];
    const [a, b, c] = order.map((corner) => this.seen(this.corner(corner))) as [
      number[],
      number[],
      number[],
    ];
    const minor = (i: number, j: number): number => b[i]! * c[j]! - b[j]! * c[i]!;
    const volume = a[0]! * minor(1, 2) - a[1]! * minor(0, 2) + a[2]! * minor(0, 1);
    return volume / Math.abs(a[2]! * b[2]! * c[2]! || 1);
  }
}
