// Where a surface is bent sharply: its creases, drawn as lines. A coarse mesh of a smooth body is
// bent everywhere, so a bend alone is no crease.

/** A crease bends by more than 45 degrees, which hardly any mesh of a smooth body does. */
const kMaxCosine = Math.SQRT1_2;
/** Across a side that bends by less than 20 degrees the surface goes on flat. */
const kFlatCosine = 0.94;
const kNone = -1;

/**
 * Creases that hang together and are shorter than this share of the surface's extent in all are
 * left out: rough surfaces have many.
 */
const kMinLength = 0.05;

/**
 * The creases among the sides of each triangle: bit k is the side opposite to corner k. A side is a
 * crease if the surface bends sharply there, while both its triangles go on flat across another of
 * their sides. `points`: 3 a vertex; `triangles`: 3 a triangle, all seen from outside.
 */
export function creasesOf(points: Int32Array, triangles: Uint32Array): Uint8Array {
  const twins = twinsOf(triangles);
  const bends = bendsOf(normalsOf(points, triangles), twins);
  const sharp: Side[] = [];
  for (let side = 0; side < triangles.length; ++side) {
    if (bends[side]! >= kMaxCosine || !goesOn(bends, side) || !goesOn(bends, twins[side]!))
      continue;
    sharp.push({side, from: triangles[next(side)]!, to: triangles[next(next(side))]!});
  }
  const creases = new Uint8Array(triangles.length / 3);
  for (const {side} of longOnes(sharp, points)) creases[Math.trunc(side / 3)]! |= 1 << (side % 3);
  return creases;
}

/** A triangle's side, and the vertices at its ends. */
interface Side {
  side: number;
  from: number;
  to: number;
}

/** Those that hang together with enough others. Each comes twice, from both its triangles. */
function longOnes(sides: readonly Side[], points: Int32Array): Side[] {
  const heads = new Map<number, number>(); // of each vertex a step towards its group's first one
  const first = (vertex: number): number => {
    let at = vertex;
    for (let up = heads.get(at); up !== undefined; up = heads.get(at)) at = up;
    if (at !== vertex) heads.set(vertex, at);
    return at;
  };
  for (const {from, to} of sides) {
    const [a, b] = [first(from), first(to)];
    if (a !== b) heads.set(a, b);
  }
  const lengths = new Map<number, number>();
  for (const {from, to} of sides) {
    const length = Math.hypot(...[0, 1, 2].map((i) => points[3 * from + i]! - points[3 * to + i]!));
    lengths.set(first(from), (lengths.get(first(from)) ?? 0) + length / 2);
  }
  const least = kMinLength * extentOf(points);
  return sides.filter(({from}) => lengths.get(first(from))! >= least);
}

/** The longest side of the points' box. */
function extentOf(points: Int32Array): number {
  const low = [Infinity, Infinity, Infinity],
    high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; ++i) {
    low[i % 3] = Math.min(low[i % 3]!, points[i]!);
    high[i % 3] = Math.max(high[i % 3]!, points[i]!);
  }
  return Math.max(...high.map((x, axis) => x - low[axis]!));
}

/** The next corner of the same triangle, and so the next side. */
function next(corner: number): number {
  return corner % 3 === 2 ? corner - 2 : corner + 1;
}

function goesOn(bends: Float32Array, side: number): boolean {
  return Math.max(bends[next(side)]!, bends[next(next(side))]!) > kFlatCosine;
}

/** For each side (3 * triangle + the opposite corner) the same side of the other triangle. */
function twinsOf(triangles: Uint32Array): Int32Array {
  const mask = 2 ** Math.ceil(Math.log2(triangles.length + 2)) - 1;
  const slots = new Int32Array(mask + 1).fill(kNone);
  const twins = new Int32Array(triangles.length).fill(kNone);
  for (let side = 0; side < triangles.length; ++side) {
    const a = triangles[next(side)]!,
      b = triangles[next(next(side))]!;
    let slot = (Math.imul(Math.min(a, b), 73856093) ^ Math.imul(Math.max(a, b), 19349663)) & mask;
    for (; ; slot = (slot + 1) & mask) {
      const other = slots[slot]!;
      if (other === kNone) {
        slots[slot] = side;
        break;
      }
      // seen from outside, the other triangle has the corners the other way round
      if (triangles[next(other)] !== b || triangles[next(next(other))] !== a) continue;
      if (twins[other] !== kNone) continue; // where surfaces touch along an edge
      twins[other] = side;
      twins[side] = other;
      break;
    }
  }
  return twins;
}

/** Unit vectors; 0 for a triangle without area. */
function normalsOf(points: Int32Array, triangles: Uint32Array): Float32Array {
  const normals = new Float32Array(triangles.length);
  for (let at = 0; at < triangles.length; at += 3) {
    const a = 3 * triangles[at]!,
      b = 3 * triangles[at + 1]!,
      c = 3 * triangles[at + 2]!;
    const ux = points[b]! - points[a]!,
      uy = points[b + 1]! - points[a + 1]!,
      uz = points[b + 2]! - points[a + 2]!;
    const vx = points[c]! - points[a]!,
      vy = points[c + 1]! - points[a + 1]!,
      vz = points[c + 2]! - points[a + 2]!;
    const x = uy * vz - uz * vy,
      y = uz * vx - ux * vz,
      z = ux * vy - uy * vx;
    const length = Math.sqrt(x * x + y * y + z * z) || 1;
    normals[at] = x / length;
    normals[at + 1] = y / length;
    normals[at + 2] = z / length;
  }
  return normals;
}

/** The cosine of the bend at each side; 1 where there is no other triangle. */
function bendsOf(normals: Float32Array, twins: Int32Array): Float32Array {
  const bends = new Float32Array(twins.length).fill(1);
  for (let side = 0; side < twins.length; ++side) {
    if (twins[side] === kNone) continue;
    const a = side - (side % 3),
      b = twins[side]! - (twins[side]! % 3);
    bends[side] =
      normals[a]! * normals[b]! +
      normals[a + 1]! * normals[b + 1]! +
      normals[a + 2]! * normals[b + 2]!;
  }
  return bends;
}
