// Integrals of a unit cube whose answers are exact.

import {describe, expect, test} from 'vitest';
import {extremesOf, ShownIntegrals, type Integrals} from '../core/integrals/integrals';
import {tetrahedraBelow, trianglesBelow, volumeOf, type Corner} from '../core/integrals/simplices';
import {surfaceFaces} from '../core/picture/cell_surface';
import {kPlainDisplay, type Display, type MeshArrays} from '../core/picture/display';
import {FieldScale, kMagnitude, kMissing, type Scalar} from '../core/picture/field_scale';
import {facesSoup} from '../core/picture/cell_surface';
import type {Plane} from '../core/protocol/geometry';
import type {FieldInfo} from '../core/protocol/fields';
import type {Manifest} from '../core/protocol/manifest';
import {allVertices, cubes} from './cubes';
import {randomOf} from './random';

const kCubes = 3;
const kSize = 8;
const kEdge = kCubes * kSize;
const {points, tetrahedra} = cubes(kCubes, kSize);
const kVertices = points.length / 3;

/** Outward triangles of the whole cube. */
const boundary = ((): Uint32Array => {
  const faces = surfaceFaces({points, tetrahedra}, allVertices(points));
  const at = new Map(
    Array.from({length: kVertices}, (_, v) => [points.subarray(3 * v, 3 * v + 3).join(), v]),
  );
  const {positions} = facesSoup({points, tetrahedra}, faces, null);
  return Uint32Array.from({length: positions.length / 3}, (_, i) =>
    at.get(positions.subarray(3 * i, 3 * i + 3).join())!,
  );
})();

interface Made {
  info: FieldInfo;
  values: Int32Array;
}

const kStep = 1 / kEdge;

/** Values are steps of an edge's kEdge-th. */
function made(components: number, integers: number[], more: Partial<FieldInfo> = {}): Made {
  const info: FieldInfo = {
    name: 'f',
    components,
    association: 'point',
    step: kStep,
    minimum: new Array<number>(components).fill(0),
    range: [0, components === 1 ? 1 : 2],
    ...more,
  };
  return {info, values: Int32Array.from(integers)};
}

const ofVertices = (f: (x: number, y: number, z: number) => number[]): number[] =>
  Array.from({length: kVertices}, (_, v) =>
    f(points[3 * v]!, points[3 * v + 1]!, points[3 * v + 2]!),
  ).flat();

const kCells = tetrahedra.length / 4;
const middleOf = (cell: number): number[] =>
  [0, 1, 2].map(
    (axis) =>
      [0, 1, 2, 3].reduce((sum, i) => sum + points[3 * tetrahedra[4 * cell + i]! + axis]!, 0) / 4,
  );

const fields: Made[] = [
  made(
    1,
    ofVertices((x) => [x]),
  ),
  made(
    1,
    ofVertices((_, __, z) => [z]),
  ),
  made(
    1,
    ofVertices(() => [kEdge]),
  ),
  made(
    3,
    ofVertices(() => [0, 0, kEdge]),
  ),
  made(
    3,
    ofVertices((x, y, z) => [x, y, z]),
  ),
  made(
    1,
    Array.from({length: kCells}, (_, cell) => (middleOf(cell)[0]! > kEdge / 3 ? kEdge : 0)),
    {
      association: 'cell',
    },
  ),
  made(
    1,
    ofVertices((x) => [x === 0 ? kMissing : x]),
  ),
  made(
    1,
    ofVertices((x) => [x]),
    {minimum: [1e6], range: [1e6, 1e6 + 1]},
  ),
];
const [kX, kZ, kOne, kUp, kPlace, kOfCells, kHoled, kLarge] = fields.keys() as unknown as number[];

const mesh: MeshArrays = {
  points,
  tetrahedra,
  boundary,
  scale: ({field, component}) =>
    new FieldScale(fields[field]!.values, fields[field]!.info, component),
};
const manifest = {fields: fields.map(({info}) => info)} as Manifest;

const all = (field: number | undefined, more: Partial<Display> = {}): Integrals => {
  const color = field === undefined ? null : {field, component: kMagnitude};
  return new ShownIntegrals(mesh, {...kPlainDisplay, color, ...more}, manifest).all();
};

const plane = (normal: Plane['normal'], share: number): Plane => ({
  normal,
  offset: share * kEdge,
});
const [kAcrossX, kAcrossZ] = [plane([1, 0, 0], 0.4), plane([0, 0, 2], 1)];
const vector = (field?: number): Scalar => ({field: field!, component: kMagnitude});
const kVolume = kEdge ** 3;
const kArea = kEdge ** 2;

const close = (value: number | undefined | null, expected: number, digits = 6): void =>
  expect(value).toBeCloseTo(expected, digits);

describe('theUnitCube', () => {
  test('hasItsVolumeMeanAndDeviation', () => {
    const {body, isWhole} = all(kX);
    close(body!.size / kVolume, 1, 12);
    close(body!.mean, 0.5, 12);
    close(body!.deviation, Math.sqrt(1 / 12), 12);
    expect([body!.least!.value, body!.largest!.value]).toEqual([0, 1]);
    expect([body!.least!.place[0], body!.largest!.place[0]]).toEqual([0, kEdge]);
    expect(isWhole).toBe(true);
  });

  test('keepsTheDigitsOfLargeValues', () => {
    const {body} = all(kLarge);
    close(body!.mean, 1e6 + 0.5, 8);
    close(body!.deviation, Math.sqrt(1 / 12), 8);
  });

  test('hasASurfaceWithTheForceOfAPressure', () => {
    close(all(undefined).surface!.size / kArea, 6);
    expect(all(undefined).surface!.force).toBe(null);
    for (const x of all(kOne).surface!.force!) close(x / kArea, 0);
    const [x, y, z] = all(kZ).surface!.force!;
    close(x / kArea, 0);
    close(y / kArea, 0);
    close(z / kArea, 1);
  });

  test('hasAFluxThroughItsSurfaceThatIsItsDivergence', () => {
    close(all(kX, {flux: vector(kUp)}).surface!.flux! / kArea, 0);
    close(all(kX, {flux: vector(kPlace)}).surface!.flux! / kArea, 3);
    expect(all(kX).surface!.flux).toBe(null);
  });

  test('hasACutWithItsAreaMeanAndFlux', () => {
    const [cut] = all(kX, {planes: [kAcrossZ], flux: vector(kUp)}).cuts;
    close(cut!.size / kArea, 1);
    close(cut!.mean, 0.5);
    close(cut!.deviation, Math.sqrt(1 / 12));
    close(cut!.flux! / kArea, 1);
    expect(cut!.normal).toEqual([0, 0, 1]);
    const [back] = all(kX, {planes: [plane([0, 0, -1], -0.5)], flux: vector(kUp)}).cuts;
    close(back!.flux! / kArea, -1);
  });

  test('losesWhatPlanesCutAway', () => {
    const {body, surface, cuts, isWhole} = all(kX, {planes: [kAcrossX, kAcrossZ]});
    close(body!.size / kVolume, 0.2, 12);
    close(body!.mean, 0.2, 12);
    close(body!.deviation, 0.4 / Math.sqrt(12), 9);
    close(body!.largest!.value, 0.4, 9);
    close(surface!.size / kArea, 0.5 + 0.4 + 2 * 0.2);
    close(cuts[0]!.size / kArea, 0.5);
    close(cuts[1]!.size / kArea, 0.4);
    close(cuts[1]!.mean, 0.2);
    expect(isWhole).toBe(false);
  });

  test('isNotThereWhereSlicesAloneAreDrawn', () => {
    const its = all(kX, {planes: [kAcrossX, kAcrossZ], mode: 'slice'});
    const {body, surface, cuts} = its;
    expect([body, surface]).toEqual([null, null]);
    close(cuts[0]!.size / kArea, 1);
    close(cuts[1]!.size / kArea, 1);
    const [least, largest] = extremesOf(its);
    expect([least!.value, largest!.value]).toEqual([0, 1]);
    close(largest!.place[2], kEdge / 2);
  });

  test('losesTheCellsThatAThresholdHides', () => {
    const threshold = {scalar: {field: kOfCells!, component: kMagnitude}, low: 0.5, high: 1};
    const {body, surface, isWhole} = all(kX, {threshold});
    close(body!.size / kVolume, 2 / 3, 12);
    close(body!.mean, 2 / 3, 12);
    close(surface!.size / kArea, 2 + 4 * (2 / 3));
    expect(isWhole).toBe(false);
  });

  test('hasAMeanOfCellFields', () => {
    const {body, surface} = all(kOfCells);
    close(body!.mean, 2 / 3, 12);
    close(body!.deviation, Math.sqrt(2) / 3, 12);
    close(surface!.force![0] / kArea, 1);
    expect(body!.largest!.place[0]).toBeGreaterThan(kEdge / 3);
  });

  test('countsMissingValuesInItsVolumeAlone', () => {
    const {body} = all(kHoled);
    close(body!.size / kVolume, 1, 12);
    close(body!.valued / kVolume, 2 / 3, 12);
    close(body!.mean, 2 / 3, 12);
    close(body!.least!.value, 1 / 3, 12);
  });

  test('hasIsosurfaces', () => {
    const isosurfaces = {scalar: {field: kX!, component: kMagnitude}, values: [0.2, 0.7]};
    const {isosurfaces: its} = all(kZ, {isosurfaces, body: false, planes: [kAcrossZ]});
    close(its!.size / kArea, 1);
    close(its!.mean, 0.25);
  });

  test('withoutAFieldHasSizesAlone', () => {
    const {body} = all(undefined);
    close(body!.size / kVolume, 1, 12);
    expect(body!.mean).toBeNaN();
    expect(body!.least).toBe(null);
  });
});

/** The parts on both sides of a plane are the whole, and the value's integral, too. */
test('planesCutRandomSimplicesIntoTwoSides', () => {
  const random = randomOf(5);
  const any = (): number => 2 * random() - 1;
  const corner = (): Corner => [any(), any(), any(), any()];
  const integralOf = (parts: Corner[][], sizeOf: (part: Corner[]) => number): number[] =>
    parts.reduce(
      ([size, whole], part) => {
        const mean = part.reduce((sum, its) => sum + its[3], 0) / part.length;
        return [size! + sizeOf(part), whole! + sizeOf(part) * mean];
      },
      [0, 0],
    );
  const areaOf = ([a, b, c]: Corner[]): number => {
    const [u, v] = [b!, c!].map((end) => [0, 1, 2].map((axis) => end[axis]! - a![axis]!));
    const squares = [0, 1, 2].map((axis) => {
      const [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
      return (u![j]! * v![k]! - u![k]! * v![j]!) ** 2;
    });
    return Math.sqrt(squares.reduce((sum, its) => sum + its)) / 2;
  };
  for (let i = 0; i < 500; ++i) {
    const normal: Plane['normal'] = [any(), any(), any()];
    const offset = 0.4 * any();
    const sides: Plane[] = [
      {normal, offset},
      {normal: normal.map((x) => -x) as Plane['normal'], offset: -offset},
    ];
    for (const [count, cut, sizeOf] of [
      [4, tetrahedraBelow, volumeOf],
      [3, trianglesBelow, areaOf],
    ] as const) {
      const simplex = Array.from({length: count}, corner);
      const whole = integralOf([simplex], sizeOf);
      const [low, high] = sides.map((its) => integralOf(cut(simplex, [its]), sizeOf));
      whole.forEach((its, k) => close(low![k]! + high![k]!, its, 9));
    }
  }
});
