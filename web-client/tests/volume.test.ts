import {expect, test} from 'vitest';
import type {Vector} from '../core/protocol/geometry';
import {cellAround} from '../core/picture/cell_entry';
import type {FieldScale} from '../core/picture/field_scale';
import {kHiddenCell} from '../core/picture/volume';
import {volumeCells} from '../core/picture/volume_cells';
import {kRow, maxRows} from '../webgl/cell_textures';
import {raysOf} from '../webgl/rays';
import {Matrix4, PerspectiveCamera, Vector3} from 'three';
import {allVertices, cubes} from './cubes';

const kCubes = 3,
  kSize = 1000;
const {points, tetrahedra} = cubes(kCubes, kSize);
const count = tetrahedra.length / 4;
const mesh = {points, tetrahedra, boundary: allVertices(points), scale: () => null};
const valued = (at: (v: number) => number): FieldScale =>
  ({ofCells: false, at}) as unknown as FieldScale;

test('aLinkLeadsToTheNeighboursTagAndToItsVertexBeyondTheFace', () => {
  const {cells, links, tags} = volumeCells(
    mesh,
    valued((v) => v),
    null,
  );
  expect([...tags]).toEqual(Array.from({length: count}, (_, cell) => cell + 1));
  let inner = 0;
  for (let face = 0; face < 4 * count; ++face) {
    const tag = links[2 * face]!;
    if (tag === 0) continue;
    ++inner;
    const mine = [...cells.subarray(face & ~3, (face & ~3) + 4)];
    expect(mine).toEqual([...mine].sort((a, b) => a - b));
    const its = new Set(cells.subarray(4 * tag - 4, 4 * tag));
    expect(its.delete(links[2 * face + 1]!)).toBe(true);
    expect(mine.filter((_, i) => i !== (face & 3)).every((id) => its.has(id))).toBe(true);
  }
  expect(inner).toBe(4 * count - 2 * 6 * kCubes ** 2);
});

test('cellsThatAreNotKeptOrWithoutAValueAreHiddenAndHolesAreNone', () => {
  const holed = {...mesh, tetrahedra: tetrahedra.slice()};
  holed.tetrahedra.fill(0, 0, 4);
  const kept = new Uint8Array(count).fill(1);
  kept[7] = 0;
  const missing = tetrahedra[4 * 9]!;
  const {tags, entries} = volumeCells(
    holed,
    valued((v) => (v === missing ? NaN : 1)),
    kept,
  );
  for (let cell = 1; cell < count; ++cell) {
    const hidden = cell === 7 || tetrahedra.subarray(4 * cell, 4 * cell + 4).includes(missing);
    expect(tags[cell]).toBe(cell + 1 + (hidden ? kHiddenCell : 0));
  }
  for (let at = 0; at < entries.length; at += 8)
    expect((entries[at + 4]! % kHiddenCell) - 1).not.toBe(0);
});

test('entriesAreTheBoundarySeenFromOutside', () => {
  const {entries, vertices} = volumeCells(
    mesh,
    valued(() => 1),
    null,
  );
  const place = (id: number): Vector3 => new Vector3(...vertices.subarray(4 * id, 4 * id + 3));
  const middle = new Vector3().setScalar((kCubes * kSize) / 2);
  let area = 0;
  for (let at = 0; at < entries.length; at += 8) {
    const [a, b, c] = [0, 1, 2].map((k) => place(entries[at + k]!)) as [Vector3, Vector3, Vector3];
    const normal = b.clone().sub(a).cross(c.clone().sub(a));
    expect(normal.dot(a.clone().sub(middle))).toBeGreaterThan(0);
    const cell = entries[at + 4]!;
    expect(tetrahedra.slice(4 * cell - 4, 4 * cell).sort()).toEqual(
      entries.slice(at, at + 4).sort(),
    );
    area += normal.length() / 2;
  }
  expect(area).toBeCloseTo(6 * (kCubes * kSize) ** 2);
});

test('theEyesCellIsFoundAndOutsideThereIsNone', () => {
  const {vertices, cells} = volumeCells(
    mesh,
    valued(() => 1),
    null,
  );
  for (const cell of [0, 17, count - 1]) {
    const middle = [0, 1, 2].map((axis) =>
      [0, 1, 2, 3].reduce((sum, k) => sum + vertices[4 * cells[4 * cell + k]! + axis]! / 4, 0),
    ) as Vector;
    expect(cellAround(vertices, cells, middle)).toBe(cell);
  }
  expect(cellAround(vertices, cells, [-1, 10, 10])).toBe(-1);
  expect(cellAround(vertices, cells, [kCubes * kSize + 1, 1, 1])).toBe(-1);
});

test('raysGoThroughTheSamePointsAsTheCamera', () => {
  for (const fov of [32, 0.1]) {
    const camera = new PerspectiveCamera(fov, 1.5, 90, 130);
    camera.position.set(30, -80, 60);
    camera.lookAt(1, 2, 3);
    camera.setViewOffset(300, 200, 40, -10, 300, 200);
    camera.updateMatrixWorld();
    const {near, far, farPerNear, distances} = raysOf(
      new Matrix4().multiplyMatrices(camera.matrixWorld, camera.projectionMatrixInverse).toArray(),
    );
    expect(distances[0]).toBeCloseTo(90);
    expect(distances[1]).toBeCloseTo(130);
    for (const [x, y] of [
      [0, 0],
      [0.7, -0.9],
      [-1, 1],
    ] as const) {
      const at = ([middle, right, up]: Vector[]): Vector3 =>
        new Vector3(...middle!)
          .addScaledVector(new Vector3(...right!), x)
          .addScaledVector(new Vector3(...up!), y);
      expect(at(near).distanceTo(new Vector3(x, y, -1).unproject(camera))).toBeLessThan(1e-6);
      const [from, to] = [at(near), at(far)];
      for (const depth of [0.2, 0.6]) {
        const share = (farPerNear * depth) / (1 - depth + farPerNear * depth);
        expect(
          from
            .clone()
            .lerp(to, share)
            .distanceTo(new Vector3(x, y, 2 * depth - 1).unproject(camera)),
        ).toBeLessThan(1e-6);
      }
    }
  }
});

test('rowsAreThoseOfTheLargestTexture', () => {
  const cells = volumeCells(
    mesh,
    valued((v) => v),
    null,
  );
  expect(maxRows(cells)).toBe(1);
  const of = (links: number, vertices: number, entries: number): number =>
    maxRows({
      ...cells,
      links: {length: links} as Uint32Array,
      vertices: {length: vertices} as Float32Array,
      entries: {length: entries} as Uint32Array,
    });
  expect(of(2 * kRow, 4, 8)).toBe(1);
  expect(of(2 * kRow + 8, 4, 8)).toBe(2);
  expect(of(8, 4 * kRow + 4, 8)).toBe(2);
  expect(of(8, 4, 12 * kRow)).toBe(3);
});
