// Lines through fields whose lines are known.

import {describe, expect, test} from 'vitest';
import {cellsAt} from '../core/lines/cells_at';
import {placesOf} from '../core/lines/seeds';
import {Streamlines, type LinesMesh} from '../core/lines/streamlines';
import {kOutside, VectorWalk} from '../core/lines/vector_walk';
import {kLineWidth, type LineSoup, type Seeds} from '../core/picture/streamlines';
import type {Vector} from '../core/protocol/geometry';
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
