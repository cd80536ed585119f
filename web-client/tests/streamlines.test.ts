// Lines through fields whose lines are known.

import {describe, expect, test} from 'vitest';
import {parseLimits, parseSeeds, readStreamlines, seedsText} from '../core/layers/streamlines_text';
import {cellsAt} from '../core/lines/cells_at';
import {placesOf} from '../core/lines/seeds';
import {Streamlines, type LinesMesh} from '../core/lines/streamlines';
import {kOutside, VectorWalk} from '../core/lines/vector_walk';
import {
  kLineWidth,
  type LineSoup,
  type Seeds,
  type StreamlinesRequest,
} from '../core/picture/streamlines';
import {neighboursOf} from '../core/picture/neighbours';
import type {Vector} from '../core/protocol/geometry';
import type {Manifest} from '../core/protocol/manifest';
import {boxMesh, vectorsOf} from './vector_fields';

const kSide = 8;
const kSize = 64;
const kEnd = kSide * kSize;
const kMiddle: Vector = [kEnd / 2, kEnd / 2, kEnd / 2];

const mesh = (side = kSide): LinesMesh => boxMesh(side, kEnd);

const kFar = {steps: 2000, length: 10, time: Infinity};
const oneAt = (place: Vector): Seeds[] => [{kind: 'line', from: place, to: place, count: 1}];

/** By line its points, 6 numbers each. */
function linesIn({points, lines}: LineSoup): number[][][] {
  const all: number[][][] = Array.from({length: lines}, () => []);
  for (let at = 0; at < points.length; at += kLineWidth)
    all[points[at + 5]!]!.push([...points.subarray(at, at + kLineWidth)]);
  return all;
}

describe('streamlines', () => {
  test('aUniformFieldGivesStraightLinesFromFaceToFace', () => {
    const its = mesh();
    const soup = new Streamlines(
      its,
      vectorsOf(its, () => [3, 0, 0]),
      kFar,
      null,
    ).all(oneAt([100, 200, 300]));
    const [line] = linesIn(soup);
    expect(soup).toMatchObject({lines: 1, isCut: false});
    expect(line![0]![0]).toBeCloseTo(0, 1);
    expect(line!.at(-1)![0]).toBeCloseTo(kEnd, 1);
    for (const [i, [x, y, z, , time]] of line!.entries()) {
      expect([y, z]).toEqual([200, 300]);
      expect(time).toBeCloseTo((x! - 100) / 3, 3);
      if (i > 0) expect(x).toBeGreaterThan(line![i - 1]![0]!);
    }
  });

  test('aRotationGivesCircles', () => {
    const its = mesh();
    // linear, so that the cells hold it exactly
    const field = vectorsOf(its, ([x, y]) => [kMiddle[1] - y, x - kMiddle[0], 0]);
    const limits = {...kFar, time: 2 * Math.PI};
    const soup = new Streamlines(its, field, limits, null).all(
      oneAt([kMiddle[0] + 150, kMiddle[1], 77]),
    );
    const [line] = linesIn(soup);
    for (const [x, y, z] of line!) {
      expect(Math.hypot(x! - kMiddle[0], y! - kMiddle[1])).toBeCloseTo(150, 0);
      expect(z).toBe(77);
    }
    for (const end of [line![0]!, line!.at(-1)!]) {
      expect(end[0]).toBeCloseTo(kMiddle[0] + 150, 0);
      expect(end[1]).toBeCloseTo(kMiddle[1], 0);
    }
    expect(line![0]![4]).toBeCloseTo(-2 * Math.PI, 4);
  });

  test('linesEndWhereVectorsAreMissingOrStillOrALimitIsReached', () => {
    const its = mesh();
    const run = (
      at: (place: Vector) => Vector | null,
      limits: Partial<typeof kFar>,
    ): number[][] | undefined =>
      linesIn(
        new Streamlines(its, vectorsOf(its, at), {...kFar, ...limits}, null).all(
          oneAt([200, 200, 200]),
        ),
      )[0];
    const missing = run(([x]) => (x > 300 ? null : [1, 0, 0]), {})!;
    expect(missing.at(-1)![0]).toBeGreaterThan(240);
    expect(missing.at(-1)![0]).toBeLessThan(321);
    const still = run(([x]) => [Math.max(0, 320 - x), 0, 0], {})!;
    expect(still.at(-1)![0]).toBeLessThan(323); // vectors have a kink there
    expect(still.at(-1)![0]).toBeGreaterThan(315);
    expect(run(() => [1, 0, 0], {steps: 7})).toHaveLength(2 * 7 + 1);
    const long = run(() => [1, 0, 0], {length: 0.1})!;
    expect(long.at(-1)![0]! - 200).toBeCloseTo(0.1 * Math.sqrt(3) * kEnd, 3);
    expect(run(() => [2, 0, 0], {time: 10})!.at(-1)![0]).toBeCloseTo(220, 3);
    expect(run(() => [0, 0, 0], {})).toBeUndefined();
  });

  test('evenLinesAreAsManyAndCoverTheMesh', () => {
    const its = mesh();
    const soup = new Streamlines(
      its,
      vectorsOf(its, () => [1, 0, 0]),
      kFar,
      null,
    ).all([{kind: 'even', count: 64}]);
    expect(soup.lines).toBe(64);
    const boxes = new Set<number>();
    for (const [point] of linesIn(soup)) {
      const [, y, z] = point!;
      boxes.add(Math.floor((4 * y!) / kEnd) * 4 + Math.floor((4 * z!) / kEnd));
    }
    expect(boxes.size).toBe(16);
  });

  test('evenLinesStayWhereTheyAreInAFinerMesh', () => {
    const [coarse, fine] = [mesh(4), mesh(8)].map((its) => {
      const soup = new Streamlines(
        its,
        vectorsOf(its, () => [0, 1, 0]),
        kFar,
        null,
      ).all([{kind: 'even', count: 20}]);
      return linesIn(soup).map(([point]) => [point![0], point![2]]);
    });
    expect(fine).toEqual(coarse);
  });
});

describe('cells without volume', () => {
  /** A square in a plane as one cell, with two cells above it and two below. */
  const withFlat = (flat: readonly number[]): LinesMesh => {
    const points = [
      [0, 0, 0],
      [900, 0, 0],
      [0, 900, 0],
      [900, 900, 0],
      [450, 450, 900],
      [450, 450, -900],
    ];
    const cells = [[0, 1, 2, 4], [1, 3, 2, 4], [0, 1, 3, 5], [0, 3, 2, 5], flat];
    const tetrahedra = Uint32Array.from(cells.flat());
    const neighbours = neighboursOf(tetrahedra);
    return {
      points: Int32Array.from(points.flat()),
      tetrahedra,
      boundary: Uint32Array.from(points.keys()),
      step: 1,
      across: (cell, corner) => neighbours[4 * cell + corner]! >>> 0,
    };
  };

  test.each([
    [0, 1, 2, 3],
    [3, 2, 1, 0],
    [1, 3, 0, 2],
    [2, 0, 3, 1],
    [0, 3, 1, 2],
  ])('linesPassThem (%i %i %i %i)', (...flat) => {
    const its = withFlat(flat);
    for (const [x, y] of [
      [300, 500],
      [500, 300],
      [440, 470],
    ] as const) {
      const lines = new Streamlines(
        its,
        vectorsOf(its, () => [0, 0, -1]),
        kFar,
        null,
      );
      const [line] = linesIn(lines.all(oneAt([x, y, 50])));
      expect(line![0]![2]).toBeGreaterThan(200);
      expect(line!.at(-1)![2]).toBeLessThan(-200);
    }
  });
});

describe('path lines', () => {
  /** The line through a place at `begin`, with a speed along x for each instant 0, 1, ... */
  function pathOf(speeds: readonly number[], begin: number, limits = kFar): number[][] {
    const its = mesh();
    const instants = speeds.map((speed, time) => ({...vectorsOf(its, () => [speed, 0, 0]), time}));
    const soup = new Streamlines(its, instants[begin]!, limits, null, {instants, begin});
    return linesIn(soup.all(oneAt([200, 200, 200])))[0]!;
  }

  test('goThroughVectorsThatChangeInTime', () => {
    const line = pathOf([0, 10, 20, 30, 40], 2);
    for (const [x, , , , time] of line) expect(x! - 200).toBeCloseTo(5 * (2 + time!) ** 2 - 20, 2);
    expect(line[0]![4]).toBeCloseTo(-2);
    expect(line.at(-1)![4]).toBeCloseTo(2);
  });

  test('waitWhereNothingMovesYet', () => {
    const line = pathOf([0, 0, 0, 20], 0);
    expect(line.at(-1)![0]).toBeCloseTo(210, 1);
    expect(line.at(-1)![4]).toBeCloseTo(3);
  });

  test('endAtALimitOfTime', () => {
    const line = pathOf([10, 10, 10], 1, {...kFar, time: 0.5});
    expect([line[0]![0], line.at(-1)![0]]).toEqual([195, 205]);
  });
});

describe('attributes', () => {
  const kFields = ['U@0', 'U@1', 'U@2'].map((name, field) => ({
    name,
    components: 3,
    association: 'point',
    instant: {series: 'U', time: field, isShown: field === 1},
  }));
  const manifest = (vertices: number): Manifest =>
    ({
      fields: kFields,
      lattice: {bits: 16, step: 0.5, origin: [1, 1, 1]},
      levels: [{vertices}],
    }) as unknown as Manifest;
  const request = (its: Record<string, string>, vertices = 10): StreamlinesRequest | null =>
    readStreamlines(
      (name) => its[name] ?? null,
      manifest(vertices),
      ({normal}) => ({normal, offset: 7}),
    );

  test('seedsComeOntoTheLattice', () => {
    const seeds = 'line 1,1,1 2,1,1 3; plane -y:0.2 4; sphere 1,2,1 3 5; even 6';
    expect(request({streamlines: 'U', seeds})?.seeds).toEqual([
      {kind: 'line', from: [0, 0, 0], to: [2, 0, 0], count: 3},
      {kind: 'plane', normal: [0, 1, 0], offset: 7, count: 4},
      {kind: 'sphere', centre: [0, 2, 0], radius: 6, count: 5},
      {kind: 'even', count: 6},
    ]);
    expect(seedsText(parseSeeds(seeds)!)).toBe(seeds);
  });

  test.each([
    'even 0',
    'even 2001',
    'even 1.5',
    'plane x:0.5 41',
    'plane x:2 5',
    'sphere 0,0,0 0 5',
    'line 0,0,0 1,0 5',
    'ring 5',
    '',
    Array(33).fill('even 1').join(';'),
  ])('%s isNoSeeds', (text) => expect(parseSeeds(text)).toBeNull());

  test.each(['even 1', 'even 2000', 'plane x:0.5 40', Array(32).fill('even 1').join(';')])(
    '%s isSeeds',
    (text) => expect(parseSeeds(text)).not.toBeNull(),
  );

  test('limitsAreNumbersAboveZero', () => {
    expect(parseLimits('steps=10000 time=2')).toEqual({steps: 10000, length: 3, time: 2});
    for (const text of ['steps=10001', 'steps=1.5', 'length=0', 'time=', 'speed=1', 'steps=1=2'])
      expect(parseLimits(text), text).toBeNull();
  });

  test('pathLinesTakeTheInstantsThatFitMemory', () => {
    const its = {streamlines: 'U', 'streamline-kind': 'path'};
    expect(request({streamlines: 'U'})?.instants).toBeUndefined();
    expect(request(its)?.instants?.map(({field}) => field)).toEqual([0, 1, 2]);
    expect(request(its, 10_000_000)?.instants?.map(({field}) => field)).toEqual([0, 1, 2]);
    expect(request(its)?.field).toBe(1);
  });
});

describe('seeds', () => {
  const kBox = [0, 0, 0, 100, 200, 300];
  test.each<[Seeds, number]>([
    [{kind: 'line', from: [0, 0, 0], to: [10, 0, 0], count: 11}, 11],
    [{kind: 'plane', normal: [1, 0, 0], offset: 50, count: 6}, 24],
    [{kind: 'sphere', centre: [50, 50, 50], radius: 10, count: 40}, 40],
  ])('%o', (seeds, count) => {
    const places = placesOf(seeds, kBox, (all) => all.map(() => true));
    expect(places).toHaveLength(count);
    if (seeds.kind === 'line') expect(places[5]).toEqual([5, 0, 0]);
    if (seeds.kind === 'plane') for (const [x] of places) expect(x).toBe(50);
    if (seeds.kind === 'sphere')
      for (const [x, y, z] of places)
        expect(Math.hypot(x - 50, y - 50, z - 50)).toBeLessThanOrEqual(10);
  });

  test.each([0, 1e-12, 1e-9, 1e-5, 1e-3, 1])('placesThatDifferBy %d areFound', (difference) => {
    const its = mesh();
    const walk = new VectorWalk(its, null, 1);
    const places = Array.from({length: 20}, (_, i): Vector => [
      20 * i + 7,
      300 + (i * difference) / 20,
      77,
    ]);
    expect([...cellsAt(walk, places)].every((cell) => cell >= 0)).toBe(true);
  });

  test('cellsOfManyPlacesAreThoseThatHoldThem', () => {
    const its = mesh();
    const places = placesOf(
      {kind: 'even', count: 50},
      [-99, 0, 0, kEnd, kEnd, kEnd + 99],
      () => [],
    );
    const walk = new VectorWalk(
      its,
      vectorsOf(its, () => [0, 0, 0]),
      1,
    );
    const cells = cellsAt(walk, places);
    places.forEach((place, i) => {
      const isInside = place.every((x) => x >= 0 && x <= kEnd);
      expect(cells[i]! >= 0).toBe(isInside);
      if (!isInside) return;
      for (let axis = 0; axis < 3; ++axis) {
        const at = [...its.tetrahedra.subarray(4 * cells[i]!, 4 * cells[i]! + 4)].map(
          (vertex) => its.points[3 * vertex + axis]!,
        );
        expect(place[axis]).toBeGreaterThanOrEqual(Math.min(...at));
        expect(place[axis]).toBeLessThanOrEqual(Math.max(...at));
      }
    });
  });

  test('theBoundaryHasNothingBehindIt', () => {
    const its = mesh(1);
    const across = [0, 1, 2, 3].map((corner) => its.across(0, corner));
    expect(across).toContain(kOutside);
  });
});
