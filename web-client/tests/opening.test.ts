// The choices of the opening view: the range, the place and the camera.

import {describe, expect, test} from 'vitest';
import {baseFigures} from '../core/picture/base_figures';
import type {MeshArrays} from '../core/picture/display';
import {FieldScale} from '../core/picture/field_scale';
import {kMaxLabels, labelsOf} from '../core/picture/labels';
import type {FieldInfo} from '../core/protocol/fields';
import {amountsOf, middleOf} from '../core/picture/spread';
import type {Vector} from '../core/protocol/geometry';
import {OrbitCamera} from '../webgl/camera';
import {product, transformed} from '../webgl/matrix';
import {outlineOf} from '../webgl/outline';
import {allVertices, cubes} from './cubes';

const field: FieldInfo = {
  name: 'p',
  components: 1,
  association: 'point',
  isWhole: true,
  step: 1,
  minimum: [0],
  range: [0, 1000],
};
const {points, tetrahedra} = cubes(4, 10);
const scaleOf = (value: (vertex: number) => number): FieldScale =>
  new FieldScale(
    Int32Array.from({length: points.length / 3}, (_, v) => value(v)),
    field,
  );

describe('the middle of the values', () => {
  const near = (value: number): unknown => expect.closeTo(value, 6) as unknown;

  test('leavesTwoPerCentOfTheVolumeOutAtEachEnd', () => {
    // 100 cells alike, of which two have low values and two high ones
    const cells = Uint32Array.from({length: 4 * 100}, (_, corner) => tetrahedra[corner % 4]!);
    const values = Int32Array.from({length: 100}, (_, cell) =>
      cell < 2 ? cell : cell > 97 ? 900 + cell : 400 + cell,
    );
    const ofCells = new FieldScale(values, {...field, association: 'cell'});
    expect(middleOf(ofCells, {points, tetrahedra: cells})).toEqual([near(0.402), near(0.998)]);
  });

  test('countsValuesByTheirVolumeAndNotByTheirVertices', () => {
    // 60 small cells beside a large one: most vertices have a hundredth of the volume
    const corners = [0, 0, 0, 60, 0, 0, 0, 60, 0, 0, 0, 60];
    const small = [100, 0, 0, 103, 0, 0, 100, 3, 0, 100, 0, 3];
    const places = Int32Array.from([...corners, ...Array<number[]>(60).fill(small).flat()]);
    const cells = Uint32Array.from({length: places.length / 3}, (_, vertex) => vertex);
    const values = Int32Array.from(cells, (vertex) => (vertex < 4 ? 100 + vertex : 900));
    const scale = new FieldScale(values, field);
    const middle = middleOf(scale, {points: places, tetrahedra: cells});
    expect(middle).toEqual([near(0.1), near(0.103)]);
    const none = {points: places, tetrahedra: new Uint32Array(0)};
    expect(middleOf(scale, none)).toEqual([0, 1]);
  });

  test('isOneValueWhereNearlyAllOfTheVolumeHasIt', () => {
    const [from, to] = middleOf(
      scaleOf((v) => (v === 0 ? 1000 : 0)),
      {points, tetrahedra},
    );
    expect(from).toBe(to);
  });
});

describe('the amounts of the volume', () => {
  test('countCellsByTheirSizeAndMeanValue', () => {
    const corners = Int32Array.of(0, 0, 0, 6, 0, 0, 0, 6, 0, 0, 0, 6, 0, 0, -18);
    const cells = Uint32Array.of(0, 1, 2, 3, 0, 1, 2, 4, 1, 1, 1, 1);
    const mesh = {points: corners, tetrahedra: cells};
    // the means are 100 and 400 of 1000
    const scale = new FieldScale(Int32Array.of(0, 0, 0, 400, 1600), field);
    const amounts = amountsOf(scale, mesh);
    expect(amounts).toHaveLength(64);
    expect(amounts[Math.floor(0.1 * 64)]).toBe(0.25);
    expect(amounts[Math.floor(0.4 * 64)]).toBe(0.75);
    const ofCells = new FieldScale(Int32Array.of(1000, -2147483648, 0), {
      ...field,
      association: 'cell',
    });
    expect(amountsOf(ofCells, mesh)[63]).toBe(1);
    expect(amountsOf(ofCells, {...mesh, tetrahedra: cells.subarray(8)})[0]).toBe(0);
  });
});

describe('labels', () => {
  test('areFewWholeNumbers', () => {
    expect(labelsOf({...field, range: [1, 4]})).toEqual([1, 4]);
    expect(labelsOf({...field, range: [0, kMaxLabels - 1]})).toEqual([0, kMaxLabels]);
    for (const other of [
      {range: [0, kMaxLabels]},
      {range: [3, 3]},
      {isWhole: false, range: [1, 4]},
      {components: 3, range: [1, 4]},
    ] as Partial<FieldInfo>[])
      expect(labelsOf({...field, ...other})).toBeNull();
  });
});

describe('the figures of a base mesh', () => {
  const mesh = (places: Int32Array): MeshArrays => ({
    points: places,
    tetrahedra,
    boundary: allVertices(places),
    scale: () => null,
  });
  test('haveBounds', () => {
    expect(baseFigures(mesh(points)).bounds).toEqual([0, 0, 0, 40, 40, 40]);
  });
});

describe('a fitted camera', () => {
  const places = ({lens: {toEye, toCube}}: OrbitCamera, at: Vector[]): Vector[] =>
    at.map((point) => transformed(product(toCube, toEye), point));
  test.each([false, true])('fillsTheFreeAreaAndIsCentred (parallel %s)', (parallel) => {
    const camera = new OrbitCamera();
    camera.parallel = parallel;
    camera.lens.aspect = 1.6;
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i): Vector => [
      i & 1 ? 0.7 : -0.2,
      i & 2 ? 0.3 : -0.6,
      i & 4 ? 0.5 : -0.1,
    ]);
    for (const direction of [null, '+x', '-z'] as const) {
      camera.look(direction, () => camera.framing(corners, 0.75, 1));
      const seen = places(camera, corners);
      const range = (axis: 0 | 1): [number, number] => [
        Math.min(...seen.map((place) => place[axis])),
        Math.max(...seen.map((place) => place[axis])),
      ];
      const [left, right] = range(0);
      const [bottom, top] = range(1);
      const filled = Math.max((right - left) / 2 / 0.75, (top - bottom) / 2);
      expect(filled).toBeGreaterThan(0.8);
      expect(filled).toBeLessThan(0.9);
      expect(Math.max(-left, right) / 0.75).toBeLessThan(0.9);
      expect(Math.max(-bottom, top)).toBeLessThan(0.9);
    }
  });
  test('standsByTheMeshAndNotByItsBox', () => {
    const positions = Float32Array.from([0, 0, 0, 10, 0, 0, 0, 10, 10]);
    const surface = {positions, values: new Float32Array(0), firstHalf: 1};
    expect(outlineOf(surface, [0, 0, 0, 10, 10, 10])).toHaveLength(3);
    expect(outlineOf(undefined, [0, 0, 0, 10, 10, 10])).toHaveLength(8);
  });
});
