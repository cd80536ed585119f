// Walks through the cells of a mesh, from one to the next across their faces, and reads a field of
// vectors there. In a cell the field is linear, so that it takes a few products at each place.

import {kMissing, type FieldScale} from '../picture/field_scale';
import type {FieldInfo} from '../protocol/fields';
import type {Vector} from '../protocol/geometry';

/** The codec's mesh as a walk needs it. */
export interface WalkMesh {
  points: Int32Array;
  tetrahedra: Uint32Array;
  /** The cell across the face opposite to a corner; kOutside at the boundary. */
  across(cell: number, corner: number): number;
}

/** The integers of a field of points with three components, or of symmetric tensors. */
export interface Vectors {
  values: Int32Array;
  info: FieldInfo;
}

export const kOutside = 0xffffffff;
/** A share of a corner below this lies outside: places on a face belong to both cells. */
const kLeastShare = -1e-9;
/** A walk through more cells than this is lost: between flat ones it may turn in circles. */
const kMostTurns = 512;

/** Cells that are remembered: a step takes places in a few, and goes to and fro between them. */
const kKept = 16;
/**
 * The first corner; the rows that give the shares of the other three; the vectors of all four, now
 * and at the next instant.
 */
const kCellWidth = 36;
const kVectorsAt = 12;
const kNextAt = 24;

/** The integers of vectors as vectors in lattice steps a unit of time. */
class VectorScale {
  readonly values: Int32Array;
  private readonly scale: number;
  private readonly leastX: number;
  private readonly leastY: number;
  private readonly leastZ: number;

  /** `step` is the lattice's. */
  constructor({values, info}: Vectors, step: number) {
    this.values = values;
    this.scale = info.step / step;
    [this.leastX, this.leastY, this.leastZ] = info.minimum.map((low) => low / step) as Vector;
  }

  /** Writes the vector of a vertex; NaN: it is missing. */
  write(vertex: number, to: Float64Array, at: number): void {
    const {values, scale} = this;
    const [x, y, z] = [values[3 * vertex]!, values[3 * vertex + 1]!, values[3 * vertex + 2]!];
    to[at] = x === kMissing ? NaN : this.leastX + scale * x;
    to[at + 1] = y === kMissing ? NaN : this.leastY + scale * y;
    to[at + 2] = z === kMissing ? NaN : this.leastZ + scale * z;
  }
}

export class VectorWalk {
  /** The cell in hand; -1: none. */
  cell = -1;
  /** The vector of the last place that find() found. */
  vx = 0;
  vy = 0;
  vz = 0;
  /** The shares of the cell's corners at that place. */
  readonly shares = new Float64Array(4);
  /** The cells that all walks went through. */
  turns = 0;

  /** By `cell % kKept` what is known of it. */
  private readonly cells = new Int32Array(kKept).fill(-1);
  private readonly known = new Float64Array(kKept * kCellWidth);
  private readonly sizes = new Float64Array(kKept);
  private slot = 0;
  private now: VectorScale | null;
  /** Null: the vectors stay. */
  private next: VectorScale | null = null;
  /** The share of the way to the next instant. */
  private share = 0;

  /** `step` is the lattice's. Without vectors it finds places alone. */
  constructor(
    readonly mesh: WalkMesh,
    vectors: Vectors | null,
    private readonly step: number,
  ) {
    this.now = vectors && new VectorScale(vectors, step);
  }

  /** Vectors change from these to the next ones. */
  between(now: Vectors, next: Vectors): void {
    this.now = new VectorScale(now, this.step);
    this.next = new VectorScale(next, this.step);
    this.cells.fill(-1);
    if (this.cell >= 0) this.enter(this.cell);
  }

  /** From 0 to 1. REQUIRES: between() was called. */
  setShare(share: number): void {
    this.share = share;
  }

  /** The root mean square of the edges at the cell's first corner. */
  get size(): number {
    return this.sizes[this.slot]!;
  }

  enter(cell: number): void {
    this.cell = cell;
    this.slot = cell % kKept;
    if (this.cells[this.slot] !== cell) this.learn(cell, this.slot);
  }

  /** Whether the cell has the place. It is in hand then. */
  holds(cell: number, [x, y, z]: Vector): boolean {
    this.enter(cell);
    return this.takeShares(x, y, z);
  }

  /** The vector at a place in the cell or close to it, and its shares there. */
  readAt(cell: number, place: Vector): void {
    this.holds(cell, place);
    this.read(kCellWidth * this.slot);
  }

  /** Those of the cell in hand. Returns whether it has the place. */
  private takeShares(x: number, y: number, z: number): boolean {
    const {known, shares} = this;
    const at = kCellWidth * this.slot;
    const dx = x - known[at]!;
    const dy = y - known[at + 1]!;
    const dz = z - known[at + 2]!;
    const b = known[at + 3]! * dx + known[at + 4]! * dy + known[at + 5]! * dz;
    const c = known[at + 6]! * dx + known[at + 7]! * dy + known[at + 8]! * dz;
    const d = known[at + 9]! * dx + known[at + 10]! * dy + known[at + 11]! * dz;
    const a = 1 - b - c - d;
    shares[0] = a;
    shares[1] = b;
    shares[2] = c;
    shares[3] = d;
    return a >= kLeastShare && b >= kLeastShare && c >= kLeastShare && d >= kLeastShare;
  }

  /** The value of a field at the place of `shares`. */
  valueOf(scale: FieldScale): number {
    const {cell, shares} = this;
    if (scale.ofCells) return scale.at(cell);
    const {tetrahedra} = this.mesh;
    const at = 4 * cell;
    return (
      shares[0]! * scale.at(tetrahedra[at]!) +
      shares[1]! * scale.at(tetrahedra[at + 1]!) +
      shares[2]! * scale.at(tetrahedra[at + 2]!) +
      shares[3]! * scale.at(tetrahedra[at + 3]!)
    );
  }

  private read(at: number): void {
    this.readFrom(at + kVectorsAt);
    if (!this.next) return;
    const {share, vx, vy, vz} = this;
    this.readFrom(at + kNextAt);
    this.vx = vx + share * (this.vx - vx);
    this.vy = vy + share * (this.vy - vy);
    this.vz = vz + share * (this.vz - vz);
  }

  private readFrom(v: number): void {
    const {known, shares} = this;
    const [a, b, c, d] = [shares[0]!, shares[1]!, shares[2]!, shares[3]!];
    this.vx = a * known[v]! + b * known[v + 3]! + c * known[v + 6]! + d * known[v + 9]!;
    this.vy = a * known[v + 1]! + b * known[v + 4]! + c * known[v + 7]! + d * known[v + 10]!;
    this.vz = a * known[v + 2]! + b * known[v + 5]! + c * known[v + 8]! + d * known[v + 11]!;
  }

  private learn(cell: number, slot: number): void {
    this.cells[slot] = cell;
    const {known, next, now} = this;
    const {points, tetrahedra} = this.mesh;
    const at = kCellWidth * slot;
    for (let corner = 0; corner < 4; ++corner) {
      const vertex = tetrahedra[4 * cell + corner]!;
      now?.write(vertex, known, at + kVectorsAt + 3 * corner);
      next?.write(vertex, known, at + kNextAt + 3 * corner);
    }
    const a = 3 * tetrahedra[4 * cell]!;
    const b = 3 * tetrahedra[4 * cell + 1]!;
    const c = 3 * tetrahedra[4 * cell + 2]!;
    const d = 3 * tetrahedra[4 * cell + 3]!;
    const x = points[a]!;
    const y = points[a + 1]!;
    const z = points[a + 2]!;
    const bx = points[b]! - x;
    const by = points[b + 1]! - y;
    const bz = points[b + 2]! - z;
    const cx = points[c]! - x;
    const cy = points[c + 1]! - y;
    const cz = points[c + 2]! - z;
    const dx = points[d]! - x;
    const dy = points[d + 1]! - y;
    const dz = points[d + 2]! - z;
    const px = cy * dz - cz * dy;
    const py = cz * dx - cx * dz;
    const pz = cx * dy - cy * dx;
    const volume = bx * px + by * py + bz * pz;
    const inverse = volume === 0 ? NaN : 1 / volume; // no place is in a flat cell
    known[at] = x;
    known[at + 1] = y;
    known[at + 2] = z;
    known[at + 3] = px * inverse;
    known[at + 4] = py * inverse;
    known[at + 5] = pz * inverse;
    known[at + 6] = (dy * bz - dz * by) * inverse;
    known[at + 7] = (dz * bx - dx * bz) * inverse;
    known[at + 8] = (dx * by - dy * bx) * inverse;
    known[at + 9] = (by * cz - bz * cy) * inverse;
    known[at + 10] = (bz * cx - bx * cz) * inverse;
    known[at + 11] = (bx * cy - by * cx) * inverse;
    const squares = bx * bx + by * by + bz * bz + cx * cx + cy * cy + cz * cz;
    this.sizes[slot] = Math.sqrt((squares + dx * dx + dy * dy + dz * dz) / 3);
  }

  /**
   * Goes to the cell of a place, by faces, and reads the vector there. False: the way leaves the
   * mesh; the last cell is in hand then. REQUIRES: a cell in hand.
   */
  find(x: number, y: number, z: number): boolean {
    let before = kOutside;
    for (let turn = 0; turn < kMostTurns; ++turn) {
      if (this.takeShares(x, y, z)) {
        this.read(kCellWidth * this.slot);
        return true;
      }
      const {cell} = this;
      const isFlat = Number.isNaN(this.shares[0]);
      const other = isFlat ? this.through([x, y, z], before) : this.onward();
      if (other === kOutside) return false;
      before = cell;
      ++this.turns;
      this.enter(other);
    }
    return false;
  }

  /** Across the face that the place is farthest behind, or another that it is behind. */
  private onward(): number {
    const {cell, mesh, shares} = this;
    let worst = 0;
    for (let corner = 1; corner < 4; ++corner) if (shares[corner]! < shares[worst]!) worst = corner;
    const first = mesh.across(cell, worst);
    if (first !== kOutside) return first;
    for (let corner = 0; corner < 4; ++corner) {
      if (corner === worst || !(shares[corner]! < kLeastShare)) continue;
      const next = mesh.across(cell, corner);
      if (next !== kOutside) return next;
    }
    return kOutside;
  }

  /**
   * A cell without volume knows no sides. The walk goes on to a neighbour on the place's side of
   * their face, or else to any but the last one.
   */
  private through(place: Vector, before: number): number {
    const {cell, mesh, shares} = this;
    let other = kOutside;
    for (let corner = 0; corner < 4; ++corner) {
      const next = mesh.across(cell, corner);
      if (next === kOutside) continue;
      if (next !== before) other = next;
      this.holds(next, place);
      for (let back = 0; back < 4; ++back)
        if (mesh.across(next, back) === cell && shares[back]! >= kLeastShare) return next;
    }
    this.enter(cell);
    return other;
  }
}
