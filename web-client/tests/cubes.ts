// A block of cubes, six tetrahedra each.

/** The six tetrahedra round a cube's diagonal. Vertex i stands at the bits of i. */
const kCube = [
  [1, 3],
  [3, 2],
  [2, 6],
  [6, 4],
  [4, 5],
  [5, 1],
].flatMap(([p, q]) => [0, p!, q!, 7]);

export function cubes(n: number, size: number): {points: Int32Array; tetrahedra: Uint32Array} {
  const id = (x: number, y: number, z: number): number => (x * (n + 1) + y) * (n + 1) + z;
  const points: number[] = [];
  const tetrahedra: number[] = [];
  for (let x = 0; x <= n; ++x)
    for (let y = 0; y <= n; ++y)
      for (let z = 0; z <= n; ++z) points.push(size * x, size * y, size * z);
  for (let x = 0; x < n; ++x)
    for (let y = 0; y < n; ++y)
      for (let z = 0; z < n; ++z) {
        tetrahedra.push(
          ...kCube.map((corner) =>
            id(x + (corner & 1), y + ((corner >> 1) & 1), z + (corner >> 2)),
          ),
        );
      }
  return {points: Int32Array.from(points), tetrahedra: Uint32Array.from(tetrahedra)};
}

/** Every vertex as a boundary: the safe choice if surfaceFaces knows no better. */
export function allVertices(points: Int32Array): Uint32Array {
  return Uint32Array.from({length: points.length / 3}, (_, i) => i);
}

export function soupArea({positions}: {positions: Float32Array}): number {
  let sum = 0;
  for (let i = 0; i < positions.length; i += 9) {
    const [u, v] = [3, 6].map((k) =>
      [0, 1, 2].map((axis) => positions[i + k + axis]! - positions[i + axis]!),
    ) as [number[], number[]];
    sum +=
      Math.hypot(
        u[1]! * v[2]! - u[2]! * v[1]!,
        u[2]! * v[0]! - u[0]! * v[2]!,
        u[0]! * v[1]! - u[1]! * v[0]!,
      ) / 2;
  }
  return sum;
}

/** Six times the volume that a closed soup encloses; positive if it is seen from outside. */
export function soupVolume({positions: p}: {positions: Float32Array}): number {
  let sum = 0;
  for (let i = 0; i < p.length; i += 9) {
    sum +=
      p[i]! * (p[i + 4]! * p[i + 8]! - p[i + 5]! * p[i + 7]!) +
      p[i + 1]! * (p[i + 5]! * p[i + 6]! - p[i + 3]! * p[i + 8]!) +
      p[i + 2]! * (p[i + 3]! * p[i + 7]! - p[i + 4]! * p[i + 6]!);
  }
  return sum;
}
