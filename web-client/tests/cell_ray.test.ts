import {describe, expect, test} from 'vitest';
import type {Vector} from '../core/protocol/geometry';
import {
  along,
  barycentric,
  below,
  cellAt,
  placesOf,
  stretches,
  type Ray,
} from '../core/picture/cell_ray';
import {cubes} from './cubes';

const {points, tetrahedra} = cubes(4, 10);
const cells = {points, tetrahedra};
const ray = (origin: Vector, direction: Vector): Ray => ({origin, direction});

describe('a line through cells', () => {
  test.each<[Vector, Vector, number]>([
    [[-5, 11.3, 17.7], [1, 0, 0], 40],
    [[-7, 3.1, 4.2], [0.9, 0.31, 0.23], 0],
    [[20.5, 13.25, 99], [0, 0, -1], 40],
  ])('from %j towards %j isCoveredWithoutGapsOrOverlaps', (origin, direction, length) => {
    const found = stretches(cells, ray(origin, direction), 0, Infinity).sort(
      (a, b) => a.from - b.from,
    );
    expect(found.length).toBeGreaterThan(4);
    for (let i = 1; i < found.length; ++i) expect(found[i]!.from).toBeCloseTo(found[i - 1]!.to, 9);
    if (length > 0) expect(found.at(-1)!.to - found[0]!.from).toBeCloseTo(length, 9);
  });

  test('thatMissesTheMeshMeetsNothing', () => {
    expect(stretches(cells, ray([-5, 50, 17], [1, 0, 0]), 0, Infinity)).toEqual([]);
    expect(stretches(cells, ray([-5, 11.3, 17.7], [-1, 0, 0]), 0, Infinity)).toEqual([]);
  });

  test('passesByCellsThatAreNotKept', () => {
    const kept = Uint8Array.from({length: tetrahedra.length / 4}, (_, cell) =>
      cell >= 96 ? 1 : 0,
    );
    const found = stretches({...cells, kept}, ray([-5, 11.3, 17.7], [1, 0, 0]), 0, Infinity);
    expect(Math.min(...found.map(({from}) => from))).toBeCloseTo(15, 9);
  });

  test('isCutByPlanes', () => {
    const line = ray([0, 0, 0], [2, 0, 0]);
    const plane = {normal: [1, 0, 0] as Vector, offset: 12};
    expect(below([plane], line, {cell: 3, from: 1, to: 9})).toEqual({cell: 3, from: 1, to: 6});
    expect(below([{normal: [-1, 0, 0], offset: -12}], line, {cell: 3, from: 1, to: 9})).toEqual({
      cell: 3,
      from: 6,
      to: 9,
    });
    expect(below([plane], line, {cell: 3, from: 7, to: 9})).toBeNull();
    expect(below([{normal: [0, 1, 0], offset: -1}], line, {cell: 3, from: 1, to: 9})).toBeNull();
  });
});

test.each<[Vector]>([[[11.3, 17.7, 3.1]], [[40, 0, 40]], [[40.2, 17.7, 3.1]], [[0, -1e-9, 0]]])(
  'the cell at %j holdsItOrIsBesideIt',
  (place) => {
    expect(Math.min(...barycentric(cells, cellAt(cells, place), place))).toBeGreaterThan(-0.05);
  },
);

test('aHoleIsNoCell', () => {
  expect(cellAt({points, tetrahedra: Uint32Array.of(1, 1, 2, 3)}, [1, 1, 1])).toBe(-1);
});

describe('the places of a line', () => {
  test('areEachBorderOnceInOrder', () => {
    const line = ray([-5, 11.3, 17.7], [50, 0, 0]);
    const found = stretches(cells, line, 0, 1);
    const places = placesOf(found);
    expect(places).toHaveLength(found.length + 1);
    places.slice(1).forEach(({t}, i) => expect(t).toBeGreaterThan(places[i]!.t));
    expect(places[0]!.t).toBeCloseTo(0.1);
    expect(places.at(-1)!.t).toBeCloseTo(0.9);
  });

  test('haveTheCellAheadAndOneWithoutCellInEachGap', () => {
    const found = [
      {cell: 7, from: 0.6, to: 1},
      {cell: 5, from: 0, to: 0.25},
      {cell: 6, from: 0.25, to: 0.4},
      {cell: 8, from: 0.4, to: 0.4 + 1e-9}, // it only touches the line
    ];
    expect(placesOf(found)).toEqual([
      {t: 0, cell: 5},
      {t: 0.25, cell: 6},
      {t: 0.4, cell: 6},
      {t: 0.5, cell: null},
      {t: 0.6, cell: 7},
      {t: 1, cell: 7},
    ]);
    expect(placesOf([])).toEqual([]);
  });

  test('areNotDoubledByCellsOnBothSidesOfTheLine', () => {
    const beside = [1, 2, 3].flatMap((cell) => [
      {cell, from: 0.1 * cell, to: 0.1 * cell + 0.1},
      {cell: 10 + cell, from: 0.1 * cell, to: 0.1 * cell + 0.1},
    ]);
    expect(placesOf(beside).map(({t}) => t.toFixed(2))).toEqual(['0.10', '0.20', '0.30', '0.40']);
  });
});

test('sharesOfCornersGiveThePointBack', () => {
  const line = ray([-5, 11.3, 17.7], [1, 0.02, 0.01]);
  for (const {cell, from, to} of stretches(cells, line, 0, Infinity)) {
    const point = along(line, (from + to) / 2);
    const shares = barycentric(cells, cell, point);
    expect(Math.min(...shares)).toBeGreaterThan(0);
    const back = [0, 1, 2].map((axis) =>
      shares.reduce(
        (sum, share, i) => sum + share * points[3 * tetrahedra[4 * cell + i]! + axis]!,
        0,
      ),
    );
    back.forEach((value, axis) => expect(value).toBeCloseTo(point[axis]!, 9));
  }
});
