// Follows a field of vectors through a mesh, by a Runge-Kutta method of order 5 with an error of
// order 4 (Dormand & Prince, "A family of embedded Runge-Kutta formulae", 1980).

import type {Vector} from '../protocol/geometry';
import type {VectorWalk} from './vector_walk';

/** Why a line ends. */
export type LineEnd = 'boundary' | 'still' | 'missing' | 'steps' | 'length' | 'time';

export interface TraceLimits {
  /** In each direction. */
  steps: number;
  /** In lattice steps. */
  length: number;
  /** In the unit of the vectors; Infinity: none. */
  time: number;
  /** A slower place ends the line, in lattice steps a unit of time. */
  stillSpeed: number;
}

/** Takes the points of a line, in order. */
export interface LinePoints {
  /** The walk has found the place. */
  add(place: Vector, time: number, walk: VectorWalk): void;
}

/** The time of vectors that change. Times count from where the lines begin. */
export interface LineClock {
  /**
   * Prepares steps from this time, forwards (1) or backwards (-1). Gives the time in which they may
   * end; 0: there are no vectors.
   */
  prepare(time: number, sign: number): number;
  /** The walk has the vectors of this time. REQUIRES: a time that was prepared. */
  set(time: number): void;
  /** The time between two instants, of those that are prepared. */
  readonly spacing: number;
}

/** A place without motion waits for this share of the time between two instants. */
const kWaits = 1 / 64;
/** The shares of a step at which its slopes are taken. */
const kNodes = [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1];
/** Steps are shares of the size of a cell. */
const kFirstStep = 0.25;
const kLongestStep = 0.5;
const kShortestStep = 1 / 128;
/** A step may be off by this share of the size of its cell. */
const kTolerance = 1e-3;
/** A step that is off by this share of itself leads nowhere. */
const kTurned = 0.5;
/** The next step is this much shorter than its error allows. */
const kSafety = 0.9;
const kMostGrowth = 3;
const kMostShrink = 0.2;

export class Tracer {
  /** Steps that were taken, by all lines. */
  steps = 0;
  // the seven slopes
  private readonly k = new Float64Array(21);

  /** `clock`: null, or absent: the vectors stay. */
  constructor(
    private readonly walk: VectorWalk,
    private readonly clock: LineClock | null = null,
  ) {}

  /**
   * Follows the vectors, or their reverse, from a place in the cell. The place itself is not added.
   * `sign`: 1 or -1. Returns why it ends. REQUIRES: the cell has the place.
   */
  follow(
    cell: number,
    place: readonly [number, number, number],
    sign: number,
    limits: TraceLimits,
    line: LinePoints,
  ): LineEnd {
    const {walk, k} = this;
    let [x, y, z] = place;
    let time = 0;
    let length = 0;
    walk.enter(cell);
    if (this.timeLeft(0, sign) <= 0) return 'time';
    if (!this.begin(x, y, z, sign)) return 'boundary';
    let share = kFirstStep;
    for (let count = 0; count < limits.steps;) {
      const untilTime = Math.min(limits.time - time, this.timeLeft(time, sign));
      if (untilTime <= 0) return 'time';
      const speed = Math.sqrt(k[0]! ** 2 + k[1]! ** 2 + k[2]! ** 2);
      if (Number.isNaN(speed)) return 'missing';
      if (!(speed > limits.stillSpeed)) {
        if (!this.clock) return 'still';
        // it waits for the vectors of a later time
        ++count;
        ++this.steps;
        time += Math.min(untilTime, kWaits * this.clock.spacing);
        if (this.timeLeft(time, sign) > 0) this.begin(x, y, z, sign);
        continue;
      }
      const {cell: from, size} = walk;
      let reach = share * size;
      const left = limits.length - length;
      if (left <= 0) return 'length';
      if (reach > left) reach = left;
      const h = Math.min(reach / speed, untilTime);
      this.time = time;
      const error = this.tryStep(x, y, z, h, sign);
      const isShortest = share <= kShortestStep;
      if (error < 0) {
        walk.enter(from);
        if (!isShortest) {
          share = Math.max(kShortestStep, share / 4);
          continue;
        }
        if (this.lacksVector) return 'missing';
        this.addExit([x, y, z, time], sign, line);
        return 'boundary';
      }
      const allowed = kTolerance * size;
      // only round a place without motion do vectors turn so soon
      if (isShortest && error > kTurned * h * speed) return 'still';
      if (error > allowed && !isShortest) {
        walk.enter(from);
        const shrink = kSafety * Math.sqrt(Math.sqrt(allowed / error));
        share = Math.max(kShortestStep, share * Math.max(kMostShrink, shrink));
        continue;
      }
      ++count;
      ++this.steps;
      length += Math.hypot(this.nextX - x, this.nextY - y, this.nextZ - z);
      time += h;
      x = this.nextX;
      y = this.nextY;
      z = this.nextZ;
      line.add([x, y, z], sign * time, walk);
      // the last slope is the next step's first
      k[0] = k[18]!;
      k[1] = k[19]!;
      k[2] = k[20]!;
      const growth = kSafety * Math.sqrt(Math.sqrt(allowed / Math.max(error, 1e-30)));
      share *= Math.min(kMostGrowth, Math.max(kMostShrink, growth));
      share = Math.min(kLongestStep, Math.max(kShortestStep, share));
    }
    return 'steps';
  }

  /** The first slope, at a place. False: it is outside. */
  private begin(x: number, y: number, z: number, sign: number): boolean {
    const {walk, k} = this;
    if (!walk.find(x, y, z)) return false;
    k[0] = sign * walk.vx;
    k[1] = sign * walk.vy;
    k[2] = sign * walk.vz;
    return true;
  }

  /** The time in which a step may end that begins at this time. */
  private timeLeft(time: number, sign: number): number {
    if (!this.clock) return Infinity;
    const left = this.clock.prepare(sign * time, sign);
    if (left > 0) this.clock.set(sign * time);
    return left;
  }

  /** When the step in hand begins, and how long it is. */
  private time = 0;
  private h = 0;
  private nextX = 0;
  private nextY = 0;
  private nextZ = 0;
  /** The last step came to a place without a vector. */
  private lacksVector = false;

  /**
   * A step of `h` from a place with the first slope in `k`. Leaves the next place, and its slope
   * as the last of `k`. Returns its error, in lattice steps. It is -1 if a place of the step
   * is outside, or has no vector.
   */
  private tryStep(x: number, y: number, z: number, h: number, sign: number): number {
    const {k} = this;
    this.lacksVector = false;
    this.h = h;
    const k1x = k[0]!;
    const k1y = k[1]!;
    const k1z = k[2]!;
    let a = h / 5;
    if (!this.slope(1, x + a * k1x, y + a * k1y, z + a * k1z, sign)) return -1;
    const k2x = k[3]!;
    const k2y = k[4]!;
    const k2z = k[5]!;
    a = (3 * h) / 40;
    let b = (9 * h) / 40;
    if (!this.slope(2, x + a * k1x + b * k2x, y + a * k1y + b * k2y, z + a * k1z + b * k2z, sign))
      return -1;
    const k3x = k[6]!;
    const k3y = k[7]!;
    const k3z = k[8]!;
    a = (44 * h) / 45;
    b = (-56 * h) / 15;
    let c = (32 * h) / 9;
    if (
      !this.slope(
        3,
        x + a * k1x + b * k2x + c * k3x,
        y + a * k1y + b * k2y + c * k3y,
        z + a * k1z + b * k2z + c * k3z,
        sign,
      )
    )
      return -1;
    const k4x = k[9]!;
    const k4y = k[10]!;
    const k4z = k[11]!;
    a = (19372 * h) / 6561;
    b = (-25360 * h) / 2187;
    c = (64448 * h) / 6561;
    let d = (-212 * h) / 729;
    if (
      !this.slope(
        4,
        x + a * k1x + b * k2x + c * k3x + d * k4x,
        y + a * k1y + b * k2y + c * k3y + d * k4y,
        z + a * k1z + b * k2z + c * k3z + d * k4z,
        sign,
      )
    )
      return -1;
    const k5x = k[12]!;
    const k5y = k[13]!;
    const k5z = k[14]!;
    a = (9017 * h) / 3168;
    b = (-355 * h) / 33;
    c = (46732 * h) / 5247;
    d = (49 * h) / 176;
    let e = (-5103 * h) / 18656;
    if (
      !this.slope(
        5,
        x + a * k1x + b * k2x + c * k3x + d * k4x + e * k5x,
        y + a * k1y + b * k2y + c * k3y + d * k4y + e * k5y,
        z + a * k1z + b * k2z + c * k3z + d * k4z + e * k5z,
        sign,
      )
    )
      return -1;
    const k6x = k[15]!;
    const k6y = k[16]!;
    const k6z = k[17]!;
    a = (35 * h) / 384;
    c = (500 * h) / 1113;
    d = (125 * h) / 192;
    e = (-2187 * h) / 6784;
    const f = (11 * h) / 84;
    this.nextX = x + a * k1x + c * k3x + d * k4x + e * k5x + f * k6x;
    this.nextY = y + a * k1y + c * k3y + d * k4y + e * k5y + f * k6y;
    this.nextZ = z + a * k1z + c * k3z + d * k4z + e * k5z + f * k6z;
    if (!this.slope(6, this.nextX, this.nextY, this.nextZ, sign)) return -1;
    // order 5 less order 4
    a = (71 * h) / 57600;
    c = (-71 * h) / 16695;
    d = (71 * h) / 1920;
    e = (-17253 * h) / 339200;
    const g = (22 * h) / 525;
    const last = -h / 40;
    return Math.hypot(
      a * k1x + c * k3x + d * k4x + e * k5x + g * k6x + last * k[18]!,
      a * k1y + c * k3y + d * k4y + e * k5y + g * k6y + last * k[19]!,
      a * k1z + c * k3z + d * k4z + e * k5z + g * k6z + last * k[20]!,
    );
  }

  /** False: the place is outside, or without a vector. */
  private slope(i: number, x: number, y: number, z: number, sign: number): boolean {
    const {walk, k} = this;
    this.clock?.set(sign * (this.time + kNodes[i]! * this.h));
    if (!walk.find(x, y, z)) return false;
    k[3 * i] = sign * walk.vx;
    k[3 * i + 1] = sign * walk.vy;
    k[3 * i + 2] = sign * walk.vz;
    if (walk.vx + walk.vy + walk.vz === walk.vx + walk.vy + walk.vz) return true;
    this.lacksVector = true;
    return false;
  }

  /** The line goes on straight to the face by which it leaves the mesh. */
  private addExit(
    [x, y, z, time]: readonly [number, number, number, number],
    sign: number,
    line: LinePoints,
  ): void {
    const {walk, k} = this;
    // the place that is still inside is found by halves: some 2^-20 of the way is left
    let inside = 0;
    let step = (kShortestStep * walk.size) / Math.hypot(k[0]!, k[1]!, k[2]!);
    const from = walk.cell;
    for (let turn = 0; turn < 20; ++turn, step /= 2) {
      const h = inside + step;
      walk.enter(from);
      if (walk.find(x + h * k[0]!, y + h * k[1]!, z + h * k[2]!)) inside = h;
    }
    walk.enter(from);
    if (inside === 0) return;
    const end: Vector = [x + inside * k[0]!, y + inside * k[1]!, z + inside * k[2]!];
    if (walk.find(...end)) line.add(end, sign * (time + inside), walk);
  }
}
