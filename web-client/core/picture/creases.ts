// Where a surface is bent sharply: its creases, drawn as lines. A coarse mesh of a smooth body is
// bent everywhere, and so is a rough surface. A bend alone is no crease there.

/** A crease bends by more than 30 degrees. */
const kMaxCosine = 0.866;
/** Across a side that bends by less than 20 degrees the surface goes on flat. */
const kFlatCosine = 0.94;
/** A crease's `1 - cosine` is so many times the mean around it: its bend 4.5 times. */
const kContrast = 20;
const kNone = -1;

/**
 * Rough surfaces have short creases. Creases that hang together are left out below this length in
 * all, as a share of the surface's extent, and with fewer sides than kMinSides.
 */
const kMinLength = 0.1;
const kMinSides = 4;

/**
 * CreasesOf. A side may be a crease if the surface bends sharply there, while both its
 * triangles go on flat across another of their sides. It is one if the other sides around are flat
 * beside it. Those that may be creases themselves do not count.
 */
export function creasesOf(points: Int32Array, triangles: Uint32Array): Uint8Array {
  const twins = twinsOf(triangles);
  const bends = bendsOf(normalsOf(points, triangles), twins);
  const sharp = new Uint8Array(bends.length);
  for (let side = 0; side < bends.length; ++side)
    if (bends[side]! < kMaxCosine && goesOn(bends, side) && goesOn(bends, twins[side]!))
      sharp[side] = 1;
  const rough = roughness(bends, sharp, triangles, points.length / 3);
  const found: Side[] = [];
  sharp.forEach((isSharp, side) => {
    if (!isSharp) return;
    const [from, to] = [triangles[next(side)]!, triangles[next(next(side))]!];
    const near = [from, to, triangles[side]!, triangles[twins[side]!]!];
    const sum = near.reduce((all, vertex) => all + rough.sums[vertex]!, 0);
    const count = near.reduce((all, vertex) => all + rough.counts[vertex]!, 0);
    if ((1 - bends[side]!) * count >= kContrast * sum) found.push({side, from, to});
  });
  const creases = new Uint8Array(triangles.length);
  for (const {side} of longOnes(found, points)) {
    const first = side - (side % 3);
    creases.fill(creases[first]! | (1 << (side % 3)), first, first + 3);
  }
  return creases;
}

/** For each vertex `1 - cosine` of the sides of its triangles, without the sharp ones. */
function roughness(
  bends: Float32Array,
  sharp: Uint8Array,
  triangles: Uint32Array,
  vertices: number,
): {sums: Float32Array; counts: Float32Array} {
  const sums = new Float32Array(vertices);
  const counts = new Float32Array(vertices);
  for (let at = 0; at < triangles.length; at += 3) {
    let sum = 0,
      count = 0;
    for (let side = at; side < at + 3; ++side) {
      if (sharp[side]) continue;
      sum += 1 - bends[side]!;
      ++count;
    }
    for (let corner = at; corner < at + 3; ++corner) {
      sums[triangles[corner]!]! += sum;
      counts[triangles[corner]!]! += count;
    }
  }
  return {sums, counts};
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
  const sums = new Map<number, {length: number; count: number}>();
  for (const {from, to} of sides) {
    const sum = sums.get(first(from)) ?? {length: 0, count: 0};
    const at = (axis: number): number => points[3 * from + axis]! - points[3 * to + axis]!;
    sum.length += Math.hypot(at(0), at(1), at(2)) / 2;
    sum.count += 1 / 2;
    sums.set(first(from), sum);
  }
  const least = kMinLength * extentOf(points);
  return sides.filter(({from}) => {
    const {length, count} = sums.get(first(from))!;
    return length >= least && count >= kMinSides;
  });
}

/** The longest side of the points' box. */
function extentOf(points: Int32Array): number {
  const extents = [0, 1, 2].map((axis) => {
    let low = Infinity,
      high = -Infinity;
    for (let i = axis; i < points.length; i += 3) {
      const at = points[i]!;
      if (at < low) low = at;
      if (at > high) high = at;
    }
    return high - low;
  });
  return Math.max(...extents);
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
    const both = Math.imul(Math.imul(a, b) + a + b, 73856093); // the same both ways
    let slot = (both ^ (both >>> 15)) & mask;
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
