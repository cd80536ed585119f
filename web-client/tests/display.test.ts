import {describe, expect, test} from 'vitest';
import {keepBelow, keepWithin} from '../core/picture/cell_choice';
import {facesSoup, surfaceFaces} from '../core/picture/cell_surface';
import {creasesOf} from '../core/picture/creases';
import {
  cutsOf,
  kPlainDisplay,
  surfaceOf,
  type Display,
  type MeshArrays,
} from '../core/picture/display';
import {isosurfacesWork} from '../core/layers/isosurfaces';
import {fieldsOf, isJagged, keptCells} from '../core/layers/shown';
import {FieldScale, kMagnitude, scalarRange, type Scalar} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import {isosurface} from '../core/picture/slice';
import {joinSoups, type TriangleSoup} from '../core/picture/triangle_soup';
import {allVertices, cubes, soupArea, soupVolume} from './cubes';

const {points, tetrahedra} = cubes(4, 10);
const cells = tetrahedra.length / 4;
const info = (
  association: 'point' | 'cell',
  range: [number, number],
  components = 1,
): FieldInfo => ({
  name: 'f',
  components,
  association,
  step: 1,
  minimum: Array<number>(components).fill(0),
  range,
});
/** The x of each vertex. Below, for each cell, the x of its cube. */
const xs = new FieldScale(
  Int32Array.from({length: points.length / 3}, (_, v) => points[3 * v]!),
  info('point', [0, 40]),
);
const cubeOf = Int32Array.from({length: cells}, (_, cell) => 10 * Math.floor(cell / (6 * 16)));
const cellXs = new FieldScale(cubeOf, info('cell', [0, 30]));
const mesh: MeshArrays = {
  points,
  tetrahedra,
  boundary: allVertices(points),
  scale: ({field}: Scalar) => [xs, cellXs][field] ?? null,
};
const display = (change: Partial<Display>): Display => ({...kPlainDisplay, ...change});
const surface = (kept: Uint8Array | null): TriangleSoup =>
  facesSoup(
    {points, tetrahedra, kept},
    surfaceFaces({points, tetrahedra, kept}, mesh.boundary),
    null,
  );

describe('the surface of cells', () => {
  test('ofAllIsTheBoundarySeenFromOutside', () => {
    expect(soupArea(surface(null))).toBeCloseTo(6 * 1600, 3);
    expect(soupVolume(surface(null))).toBeCloseTo(6 * 64000, 2);
  });

  test('ofSomeEnclosesTheirVolume', () => {
    const kept = Uint8Array.from({length: cells}, (_, i) => ((i * 7919) % 3 === 0 ? 1 : 0));
    expect(soupVolume(surface(kept))).toBeCloseTo(kept.reduce((sum, k) => sum + k, 0) * 1000, 1);
  });

  test('carriesTheValuesOfItsOwnCells', () => {
    const soup = surfaceOf(mesh, display({color: {field: 1, component: kMagnitude}}), null);
    for (let i = 0; i < soup.values.length; i += 3) {
      const low = Math.min(
        soup.positions[3 * i]!,
        soup.positions[3 * i + 3]!,
        soup.positions[3 * i + 6]!,
      );
      const high = Math.max(
        soup.positions[3 * i]!,
        soup.positions[3 * i + 3]!,
        soup.positions[3 * i + 6]!,
      );
      expect(30 * soup.values[i]!).toBeGreaterThanOrEqual(high - 10.001);
      expect(30 * soup.values[i]!).toBeLessThanOrEqual(low + 0.001);
    }
  });
});

test('onlyAWholeSurfaceHasCreases', () => {
  const ofCells = display({color: {field: 1, component: kMagnitude}});
  // twelve edges of four cells, from both their triangles
  const sides = (kept: Uint8Array | null, its: Display): number | undefined =>
    surfaceOf(mesh, its, kept, creasesOf).creases?.reduce(
      (sum, bits, side) => sum + ((bits >> (side % 3)) & 1),
      0,
    );
  expect(sides(null, ofCells)).toBe(2 * 12 * 4);
  const range = {scalar: {field: 1, component: kMagnitude}, low: 0, high: 1};
  expect(isJagged(mesh, display({threshold: range}))).toBe(true);
  expect(isJagged(mesh, ofCells)).toBe(false);
  expect(surfaceOf(mesh, ofCells, null).creases).toBeUndefined();
});

describe('chosen cells', () => {
  test('byAThresholdOfPointsHaveAllTheirCornersInside', () => {
    const kept = new Uint8Array(cells).fill(1);
    keepWithin(kept, tetrahedra, xs, 0.25, 0.75);
    expect(soupVolume(surface(kept))).toBeCloseTo(6 * 20 * 1600, 1);
  });

  test('byAThresholdOfCellsAreThoseCells', () => {
    const kept = keptCells(
      mesh,
      display({threshold: {scalar: {field: 1, component: kMagnitude}, low: 0.3, high: 0.4}}),
    )!;
    expect(soupVolume(surface(kept))).toBeCloseTo(6 * 10 * 1600, 1);
  });

  test('byAPlaneReachBelowIt', () => {
    const kept = new Uint8Array(cells).fill(1);
    keepBelow(kept, points, tetrahedra, {normal: [1, 0, 0], offset: 15.5});
    expect(soupVolume(surface(kept))).toBeCloseTo(6 * 20 * 1600, 1);
  });

  test('areTheOnlyOnesThatAreCut', () => {
    const threshold = {scalar: {field: 1, component: kMagnitude}, low: 0, high: 0.4};
    const wanted = display({threshold, planes: [{normal: [0, 0, 1], offset: 12.5}]});
    const [cut] = cutsOf(mesh, wanted, keptCells(mesh, wanted));
    expect(soupArea(cut!)).toBeCloseTo(20 * 40, 3);
  });

  test('inWholeCellsHaveNoCuts', () => {
    expect(
      cutsOf(mesh, display({mode: 'cells', planes: [{normal: [0, 0, 1], offset: 12.5}]}), null),
    ).toEqual([]);
  });
});

describe('isosurfaces', () => {
  test('lieWhereTheFieldHasTheValue', () => {
    const soup = isosurface({points, tetrahedra}, xs, 13 / 40, null);
    expect(soupArea(soup)).toBeCloseTo(1600, 2);
    for (let i = 0; i < soup.positions.length; i += 3) expect(soup.positions[i]).toBeCloseTo(13, 4);
  });

  test('ofSeveralValuesAreOneSoupColouredByAnotherField', () => {
    const soup = isosurfacesWork.make(
      mesh,
      display({
        color: {field: 1, component: kMagnitude},
        isosurfaces: {scalar: {field: 0, component: kMagnitude}, values: [0.1, 0.6]},
      }),
      null,
    )!;
    expect(soupArea(soup)).toBeCloseTo(3200, 2);
    expect(new Set([...soup.values].map((value) => Math.round(30 * value)))).toEqual(
      new Set([0, 20]),
    );
  });

  test('haveNoPartInCellsWhereAValueIsMissing', () => {
    const missing = Int32Array.from({length: points.length / 3}, (_, v) =>
      points[3 * v + 2] === 0 ? -(2 ** 31) : points[3 * v]!,
    );
    expect(
      soupArea(
        isosurface(
          {points, tetrahedra},
          new FieldScale(missing, info('point', [0, 40])),
          13 / 40,
          null,
        ),
      ),
    ).toBeCloseTo(1200, 2);
  });

  test('joinedKeepTheirHalvesBehindTheirTriangles', () => {
    const [a, b] = [0.1, 0.6].map((value) => isosurface({points, tetrahedra}, xs, value, null)) as [
      never,
      never,
    ];
    const joined = joinSoups([a, b]) as {firstHalf: number; positions: Float32Array};
    expect(joined.firstHalf).toBe(
      (a as {firstHalf: number}).firstHalf + (b as {firstHalf: number}).firstHalf,
    );
    expect(soupArea(joined)).toBeCloseTo(3200, 2);
  });
});

describe('components', () => {
  const vector = info('point', [0, 5], 3);
  test('ofHolesAndUnusedVerticesDoNotCount', () => {
    const values = Int32Array.from([1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, -5, 0, 0]);
    const oneAndAHole = Uint32Array.from([0, 1, 2, 3, 4, 4, 4, 4]);
    const [low, high] = new FieldScale(values, vector, 0).extent(oneAndAHole);
    expect([low, high].map((share) => 10 * share - 5)).toEqual(
      [1, 4].map((value) => expect.closeTo(value, 5) as number),
    );
    expect(
      new FieldScale(values.subarray(0, 6), {...vector, association: 'cell'}, 0).extent(
        oneAndAHole,
      ),
    ).toEqual([expect.closeTo(0.6, 5), expect.closeTo(0.6, 5)]);
    expect(new FieldScale(values, vector, 0).extent(new Uint32Array(0))).toEqual([0, 1]);
  });
  test('spanTheLargestMagnitudeBothWays', () => {
    expect([scalarRange(vector, 1), scalarRange(vector, kMagnitude)]).toEqual([
      [-5, 5],
      [0, 5],
    ]);
    const scale = new FieldScale(Int32Array.from([3, -4, 0, 0, 5, 0]), vector, 1);
    expect([scale.at(0), scale.at(1)]).toEqual([0.1, 1]);
  });
});

test('aDisplayNeedsEachOfItsFieldsOnce', () => {
  const scalar = (field: number): Scalar => ({field, component: kMagnitude});
  expect(
    fieldsOf(
      display({
        color: scalar(2),
        isosurfaces: {scalar: scalar(0), values: []},
        threshold: {scalar: scalar(2), low: 0, high: 1},
      }),
    ),
  ).toEqual([2, 0]);
});
