import {describe, expect, test} from 'vitest';
import {WorkerCanvas} from '../webgl/worker_canvas';
import {MeshCamera} from '../webgl/mesh_camera';
import type {Assembler} from '../core/decode/assembler';
import {fieldsOf} from '../core/layers/shown';
import {kPlainDisplay} from '../core/picture/display';
import {meshArrays} from '../core/picture/mesh_arrays';
import {warpedPoints} from '../core/picture/warp';
import type {FieldInfo} from '../core/protocol/fields';
import type {Manifest} from '../core/protocol/manifest';
import {markSeries, showTime} from '../core/protocol/series';
import {
  automaticScale,
  displacementKey,
  firstWarp,
  kNoWarp,
  largestScale,
  warpField,
  warpFields,
  warpOf,
} from '../viewer/settings/warp';
import {ShownMesh, settingsFor} from '../viewer/page/shown_mesh';
import {readSettings} from '../viewer/settings/settings';
import {FakeCodec} from './fakes';

const kNoValue = -2147483648;
/** Values are -10 + 0.5 times the integer: 20 is 0, and 24 is 2. */
const kScale = {minimum: [-10, -10, -10], step: 0.5};
const kZero = 20;

/** Vertices 0 to 4 of two cells that share the face 1, 2, 3. */
const points = Int32Array.of(0, 0, 0, 100, 0, 0, 0, 100, 0, 0, 0, 100, 100, 100, 100);
const tetrahedra = Uint32Array.of(0, 1, 2, 3, 1, 2, 3, 4);
const still = (): Int32Array => new Int32Array(15).fill(kZero);

const vectors = (name: string, more: Partial<FieldInfo> = {}): FieldInfo => ({
  ...{name, components: 3, association: 'point', range: [0, 2]},
  ...kScale,
  ...more,
});

describe('theMovedVertices', () => {
  test('lieAtTheFactorTimesTheirVectors', () => {
    const values = still();
    values.set([kZero + 4, kZero - 2, kZero + 1], 3); // (2, -1, 0.5) at vertex 1
    const moved = warpedPoints({points, tetrahedra}, values, kScale, 10);
    expect([...moved.subarray(0, 6)]).toEqual([0, 0, 0, 120, -10, 5]);
    expect([...moved.subarray(6)]).toEqual([...points.subarray(6)]);
    expect([...points.subarray(3, 6)]).toEqual([100, 0, 0]);
  });

  test('moveAsTheirNeighboursDoWithoutVectors', () => {
    const values = still();
    for (const vertex of [1, 2, 3]) values[3 * vertex] = kZero + 2; // (1, 0, 0)
    values.set([kZero, kZero, kNoValue], 12);
    const moved = warpedPoints({points, tetrahedra}, values, kScale, 30);
    expect([...moved.subarray(12)]).toEqual([130, 100, 100]);
  });

  test('followEachOtherAndRestIfNoneMoves', () => {
    const values = new Int32Array(15).fill(kNoValue);
    const none = warpedPoints({points, tetrahedra}, values, kScale, 30);
    expect(none).toEqual(points);
    values.set([kZero + 2, kZero, kZero], 0);
    const moved = warpedPoints({points, tetrahedra}, values, kScale, 30);
    expect([...moved].map((place, i) => place - points[i]!)).toEqual(
      Array.from({length: 5}, () => [30, 0, 0]).flat(),
    );
  });

  test('leaveOutCellsThatAreHoles', () => {
    const values = still();
    values.set([kNoValue, kNoValue, kNoValue], 12);
    values[3] = kZero + 2;
    const holes = Uint32Array.of(1, 1, 3, 4, 2, 3, 0, 4);
    const moved = warpedPoints({points, tetrahedra: holes}, values, kScale, 30);
    expect([...moved.subarray(12)]).toEqual([100, 100, 100]);
  });

  test('stayWithinTheIntegersWhateverTheFactorIs', () => {
    const values = still();
    values.set([kZero + 4, kZero - 4, kZero], 3);
    const moved = warpedPoints({points, tetrahedra}, values, kScale, 1e30);
    expect([...moved.subarray(3, 6)]).toEqual([2 ** 30, -(2 ** 30), 0]);
  });
});

class OneCell extends FakeCodec {
  values = still();
  override points = (): Int32Array => points;
  override tetrahedra = (): Uint32Array => tetrahedra;
  override field = (field: number): Int32Array | null =>
    this.fieldChunksApplied(field) > 0 ? this.values : null;
}

test('theMeshRestsUntilTheFieldIsHereAndAtScale0', () => {
  const codec = new OneCell({fields: ['u'], chunks: 2});
  codec.open();
  codec.chunksApplied = 1;
  codec.values.fill(kZero + 2);
  const manifest = {fields: [vectors('u')], lattice: {step: 0.1}};
  const assembler = {codec, manifest} as unknown as Assembler;
  const x = (scale: number): number => meshArrays(assembler, {warp: {field: 0, scale}})!.points[0]!;
  expect(x(3)).toBe(0);
  codec.applyField(0, 0);
  expect([x(3), x(0), x(-3), meshArrays(assembler)!.points[0]]).toEqual([30, 0, -30, 0]);
  expect(meshArrays(assembler, {warp: {field: 0, scale: 3}})!.points).not.toBe(points);
});

test('aDisplayNeedsTheFieldThatMovesItsMesh', () => {
  const color = {field: 4, component: -1};
  expect(fieldsOf({...kPlainDisplay, color, warp: {field: 2, scale: 1}})).toEqual([4, 2]);
});

describe('theFieldThatMovesTheMesh', () => {
  const fields = [
    vectors('U'),
    vectors('T', {components: 1}),
    vectors('Displacement', {association: 'cell'}),
    vectors('DISPL'),
  ];
  test('isAFieldOfVectorsOfPointsWithDisplacementsFirst', () =>
    expect(warpFields(fields)).toEqual([3, 0]));
  test.each([
    ['U', 0],
    ['U[1]', -1],
    ['T', -1],
    ['Displacement', -1],
    ['DISPL', 3],
    ['none', -1],
    [null, -1],
  ])('of %s is %i', (text, field) => expect(warpField(text, fields)).toBe(field));

  test('isTheShownInstantOfASeries', () => {
    const series = ['Displacement@0', 'Displacement@1'].map((name) => vectors(name));
    markSeries(series);
    showTime(series, 1);
    expect([warpFields(series), warpField('Displacement', series)]).toEqual([[1], 1]);
  });
});

describe('anAutomaticScale', () => {
  const mesh = (largest: number): Parameters<typeof automaticScale>[1] => ({
    manifest: {
      fields: [vectors('u', {range: [0, largest]})],
      lattice: {step: 0.01},
    } as unknown as Manifest,
    bounds: [0, 0, 0, 300, 400, 0], // 5 in the mesh's unit
  });
  test.each([
    [5, 1],
    [0.05, 1],
    [0.0499, 10],
    [0.01, 50],
    [0.0099, 50],
    [5e-7, 1e6],
    [50, 0.01],
    [0, 1],
  ])('of the largest vector %d is %d', (largest, scale) =>
    expect(automaticScale(0, mesh(largest))).toBe(scale),
  );
  test.each([
    [0.1, 20],
    [0.01, 200],
    [2.5, 4],
    [0, 4],
  ])('ofTheLargestVector%dHasASliderTo%d', (largest, end) =>
    expect(largestScale(0, mesh(largest))).toBe(end),
  );
  test('givesWayToTheAttribute', () => {
    const settings = (scale: string | null): ReturnType<typeof readSettings> =>
      readSettings((name) => (name === 'warp' ? 'u' : name === 'warp-scale' ? scale : null));
    expect(warpOf(settings('-2.5'), mesh(0.01))).toEqual({field: 0, scale: -2.5});
    expect(warpOf(settings('much'), mesh(0.01))).toEqual({field: 0, scale: 50});
    expect(warpOf({...settings('1'), warp: null}, mesh(0.01))).toBeNull();
  });
});

describe('without an attribute', () => {
  /** A cube of 60 regular cells, whose edge is 0.52 of the cube's. */
  const mesh = (name: string, largest: number, cells = 60): ShownMesh => {
    const fields = [vectors('U'), vectors(name, {range: [0, largest]})];
    const shown = new ShownMesh();
    const lattice = {step: 0.01};
    shown.manifest = {fields, lattice, levels: [{tetrahedra: cells}]} as unknown as Manifest;
    shown.base.bounds = [0, 0, 0, 100, 100, 100];
    return shown;
  };
  const warpable = ({manifest, base}: ShownMesh): Parameters<typeof firstWarp>[0] => ({
    manifest,
    ...base,
  });
  test.each([
    ['Displacement', 0.51, 60, null],
    ['Displacement', 0.53, 60, 'Displacement'],
    ['Velocity', 0.53, 60, null],
    // as long as the diagonal, and a hundredth of it, with tiny cells
    ['Displacement', 1.73, 60, 'Displacement'],
    ['Displacement', 1.74, 60, null],
    ['Displacement', 0.0174, 1e9, 'Displacement'],
    ['Displacement', 0.0173, 1e9, null],
  ])('%s of %d moves a mesh of %d cells: %s', (name, largest, cells, warp) =>
    expect(firstWarp(warpable(mesh(name, largest, cells)))).toBe(warp),
  );
  test('aListsKeyOfDisplacementsIsAskedForAtOnce', () => {
    expect(displacementKey(['VonMises', 'cell:Displacement', 'U_disp'])).toBe('U_disp');
    expect(displacementKey(['VonMises', 'Displacement@0'])).toBeNull();
  });
  test('aMeshRestsUntilItsBoundsAreKnown', () => {
    const shown = mesh('Displacement', 1);
    shown.base.bounds = [];
    expect(firstWarp(warpable(shown))).toBeNull();
  });
  test('itsDisplacementIsThatOfTheShownInstantAndTheAttributeSaysOtherwise', () => {
    const shown = mesh('Displacement@0', 0);
    shown.manifest!.fields.push(vectors('Displacement@1', {range: [0, 1]}));
    markSeries(shown.manifest!.fields);
    const warp = (text: string | null, time: string): ReturnType<typeof warpOf> => {
      const read = (name: string): string | null =>
        name === 'warp' ? text : name === 'time' ? time : null;
      return warpOf(settingsFor(shown, read), warpable(shown));
    };
    expect(warp(null, '0')).toEqual({field: 1, scale: 1});
    expect(warp(null, '1')).toEqual({field: 2, scale: 1});
    expect(warp('U', '1')?.field).toBe(0);
    expect(warp(kNoWarp, '1')).toBeNull();
  });
});

describe('theCamera', () => {
  const rest = [0, 0, 0, 200, 100, 50];
  const far = [-2000, 0, 0, 2200, 100, 50];
  const warp = {field: 0, scale: 50, restBounds: rest};
  const camera = (): MeshCamera => {
    const canvas = new WorkerCanvas({} as OffscreenCanvas);
    canvas.resize({width: 1280, height: 800, pixelRatio: 1});
    const made = new MeshCamera(canvas, () => undefined);
    made.resize(1280, 800);
    made.growTo({bounds: rest});
    return made;
  };
  const distance = ({orbit}: MeshCamera): number => Math.hypot(...orbit.lens.eye);

  test('fitsTheMovedMeshAndThePlainOneAgain', () => {
    const its = camera();
    const before = distance(its);
    its.growTo({bounds: far, warp});
    expect(distance(its)).toBeGreaterThan(5 * before);
    its.growTo({bounds: rest});
    expect(distance(its)).toBeCloseTo(before, 9);
  });

  test('keepsItsStateAndSeesAsFarAsTheMeshReaches', () => {
    const its = camera();
    its.moveTo([1, -3, 2, 0, 0, 0]);
    const seen = its.pose(0).toCanvas;
    its.growTo({bounds: far, warp});
    expect(its.pose(0).camera).toEqual([1, -3, 2, 0, 0, 0]);
    expect(its.pose(0).toCanvas).toEqual(seen);
    its.orbit.setDepths();
    const radius = 2100 / (Math.hypot(200, 100, 50) / 2);
    expect(its.orbit.lens.far).toBeGreaterThan(distance(its) + radius);
  });

  test('makesRoomForTheEdgesAtRestWhileTheyAreSeen', () => {
    const its = camera();
    const aside = [0, 900, 0, 200, 1000, 50];
    its.growTo({bounds: aside, warp});
    const near = distance(its);
    const restEdges = Float32Array.of(0, 0, 0, 200, 100, 50);
    its.growTo({bounds: aside, warp: {...warp, restEdges}});
    expect(distance(its)).toBeGreaterThan(3 * near);
    its.growTo({bounds: aside, warp});
    expect(distance(its)).toBeCloseTo(near, 9);
  });

  test('staysWideWhileASeriesMovesTheMesh', () => {
    const its = camera();
    its.growTo({bounds: far, warp});
    const wide = distance(its);
    its.growTo({bounds: [0, 0, 0, 210, 100, 50], warp: {...warp, field: 1}});
    expect(distance(its)).toBe(wide);
  });
});
