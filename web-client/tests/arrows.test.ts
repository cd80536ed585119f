// Arrows stand where they should, evenly, and as long as their vectors.

import {describe, expect, test} from 'vitest';
import {Arrows, kMostArrows, type ArrowsMesh, type Shown} from '../core/lines/arrows';
import {principalAxes} from '../core/lines/principal_axes';
import {readArrows} from '../core/layers/arrows_text';
import {kArrowWidth, type ArrowsRequest, type ArrowSoup} from '../core/picture/arrows';
import type {FieldInfo} from '../core/protocol/fields';
import type {Vector} from '../core/protocol/geometry';
import {wrongParts} from '../viewer/settings/wrong_parts';
import {randomOf} from './random';
import {boxMesh, vectorsOf} from './vector_fields';

const kEnd = 512;

const meshOf = (side: number): ArrowsMesh => ({
  ...boxMesh(side, kEnd),
  kept: null,
  longest: kEnd,
});
const kRequest: ArrowsRequest = {
  field: 0,
  places: 'shown',
  isColored: false,
  density: 8,
  length: 'magnitude',
  size: 1,
};
const kWhole: Shown = {hasSurface: true, cutting: [], cuts: []};

function make(
  mesh: ArrowsMesh,
  at: (place: Vector) => Vector | null,
  request: Partial<ArrowsRequest> = {},
  shown: Partial<Shown> = {},
): ArrowSoup {
  const arrows = new Arrows(mesh, vectorsOf(mesh, at), {...kRequest, ...request});
  return arrows.all({...kWhole, ...shown}, null);
}

/** By arrow its tail and its way. */
const listed = ({arrows}: ArrowSoup): {tail: number[]; way: number[]}[] =>
  Array.from({length: arrows.length / kArrowWidth}, (_, i) => {
    const its = [...arrows.subarray(kArrowWidth * i, kArrowWidth * (i + 1))];
    return {tail: its.slice(0, 3), way: its.slice(3, 6)};
  });
const tipOf = ({tail, way}: {tail: number[]; way: number[]}): number[] =>
  tail.map((x, axis) => x + way[axis]!);

describe('arrows', () => {
  test('onASurfaceTheyStandOutside', () => {
    const all = listed(make(meshOf(4), () => [2, 0, 0]));
    expect(all.length).toBeGreaterThanOrEqual(6 * 8 * 8 * 0.9);
    for (const arrow of all) {
      expect(arrow.way).toEqual([64, 0, 0]);
      const [tail, tip] = [arrow.tail[0]!, tipOf(arrow)[0]!];
      // the flow enters at 0 and leaves at the end
      if (tail < 0) expect(tip).toBeCloseTo(0);
      if (tip > kEnd && tail > kEnd - 32) expect(tail).toBeGreaterThan(kEnd - 65);
    }
    expect(all.some(({tail}) => tail[0]! === -64)).toBe(true);
    expect(all.some(({tail}) => tail[0]! === kEnd)).toBe(true);
  });

  test('aFinerMeshHasThemAtTheSamePlaces', () => {
    const [coarse, fine] = [2, 8].map((side) =>
      listed(make(meshOf(side), () => [0, 0, 1])).map(({tail}) => tail.map(Math.round).join()),
    );
    expect(new Set(fine)).toEqual(new Set(coarse));
  });

  test('cutsHaveThemOnAGridAndSurfacesAboveHaveNone', () => {
    const plane = {normal: [1, 0, 0] as Vector, offset: 200.5};
    const all = listed(make(meshOf(4), () => [-1, 0, 0], {}, {cutting: [plane], cuts: [plane]}));
    const onCut = all.filter((arrow) => Math.abs(tipOf(arrow)[0]! - 200.5) < 1e-3);
    expect(onCut).toHaveLength(9 * 9);
    for (const arrow of all) expect(Math.min(arrow.tail[0]!, tipOf(arrow)[0]!)).toBeLessThan(201);
    const slice = make(meshOf(4), () => [-1, 0, 0], {}, {hasSurface: false, cuts: [plane]});
    for (const {tail, way} of listed(slice)) expect(tail[0]! + way[0]! / 2).toBeCloseTo(200.5, 3);
  });

  test('insideTheyHaveTheirPlaceInTheirMiddle', () => {
    const all = listed(make(meshOf(4), () => [0, 3, 0], {places: 'volume', density: 4}));
    expect(all.length).toBeGreaterThan(4 ** 3);
    for (const {tail, way} of all) expect((tail[1]! + way[1]! / 2) % 64).toBeCloseTo(0);
  });

  test('hiddenCellsHaveNone', () => {
    const mesh = meshOf(4);
    const kept = new Uint8Array(mesh.tetrahedra.length / 4);
    for (const places of ['shown', 'volume', 'vertices'] as const)
      expect(make({...mesh, kept}, () => [1, 0, 0], {places}).count).toBe(0);
  });

  test('lengthsAreThoseOfTheVectors', () => {
    const lengths = (length: ArrowsRequest['length']): number[] => {
      const soup = make(meshOf(2), ([x]) => [x === 0 ? 1 : 100, 0, 0], {
        places: 'vertices',
        length,
      });
      return [...new Set(listed(soup).map(({way}) => Math.round(way[0]!)))].sort((a, b) => a - b);
    };
    expect(lengths('magnitude')).toEqual([64]); // a hundredth is not seen
    expect(lengths('log')).toEqual([21, 64]);
    expect(lengths('equal')).toEqual([64]);
  });

  test('aMeshThatAWarpMakesLargerHasNoMore', () => {
    const mesh = meshOf(4);
    const points = mesh.points.map((x) => x * 1_000_000);
    const soup = make({...mesh, points}, () => [1, 0, 0]);
    expect(soup.count).toBeGreaterThan(100);
    expect(soup.count).toBeLessThan(6 * 9 * 9 + 1);
  });

  test('missingVectorsHaveNone', () => {
    const soup = make(meshOf(2), ([x]) => (x === 0 ? null : [1, 0, 0]), {places: 'vertices'});
    expect(soup.count).toBe(2 * 9);
  });

  test.each([
    ['vertices', 27],
    ['volume', 4],
  ] as const)('%s areBounded', (places, side) => {
    const soup = make(meshOf(side), () => [1, 1, 1], {places, density: 100});
    expect(soup.count).toBeLessThanOrEqual(kMostArrows);
    expect(soup.count).toBeGreaterThan(kMostArrows / 4);
    expect(soup.isCut).toBe(true);
  });
});

describe('tensors', () => {
  test('principalAxesAreThoseOfTheTensor', () => {
    const random = randomOf(7);
    for (let turn = 0; turn < 50; ++turn) {
      const [xx, yy, zz, xy, yz, xz] = Array.from({length: 6}, () => random() * 20 - 10);
      const rows = [
        [xx!, xy!, xz!],
        [xy!, yy!, yz!],
        [xz!, yz!, zz!],
      ];
      const axes = principalAxes([xx!, yy!, zz!, xy!, yz!, xz!]);
      for (const {value, direction} of axes) {
        expect(Math.hypot(...direction)).toBeCloseTo(1, 10);
        rows.forEach((row, i) => {
          const product = row.reduce((sum, x, k) => sum + x * direction[k]!, 0);
          expect(product).toBeCloseTo(value * direction[i]!, 8);
        });
      }
    }
  });

  test('tensionPointsApartAndCompressionTowards', () => {
    const mesh = meshOf(2);
    const tensor = [4, -2, 0, 0, 0, 0];
    const values = Int32Array.from(
      {length: 2 * mesh.points.length},
      (_, i) => tensor[i % 6]! + 10, // the least value is -10
    );
    const info = {
      ...vectorsOf(mesh, () => [1, 0, 0]).info,
      components: 6,
      minimum: [-10, -10, -10, -10, -10, -10],
      range: [0, 4] as [number, number],
    };
    const soup = new Arrows(mesh, {values, info}, {...kRequest, places: 'vertices'}).all(
      kWhole,
      null,
    );
    expect(soup.count).toBe(27 * 4); // two directions; nothing along the third
    const ofFirst = listed(soup).slice(0, 4);
    expect(ofFirst.map(({tail}) => tail)).toEqual([
      [0, 0, 0],
      [0, 0, 0],
      [0, 16, 0],
      [0, -16, 0],
    ]);
    const ways = ofFirst.map(({way}) => way.map((x) => Math.round(x) + 0));
    expect(ways).toEqual([
      [32, 0, 0],
      [-32, 0, 0],
      [0, -16, 0],
      [0, 16, 0],
    ]);
  });
});

describe('attributes', () => {
  const fields = [
    {name: 'U', components: 3, association: 'point'},
    {name: 'p', components: 1, association: 'point'},
  ] as unknown as FieldInfo[];
  const read = (its: Record<string, string>) => (name: string) => its[name] ?? null;

  test('theFirstOnes', () => {
    expect(readArrows(read({arrows: 'U'}), fields)).toEqual({
      field: 0,
      places: 'shown',
      isColored: false,
      density: 30,
      length: 'magnitude',
      size: 1.5,
    });
    expect(readArrows(read({arrows: 'p'}), fields)).toBeNull();
  });

  test('insideTheyAreColouredUnlessToldOtherwise', () => {
    const its = {arrows: 'U', 'arrow-places': 'volume'};
    expect(readArrows(read(its), fields)?.isColored).toBe(true);
    expect(readArrows(read({...its, 'arrow-color': 'plain'}), fields)?.isColored).toBe(false);
  });

  test.each([
    ['arrow-density', '3', '4', '100', '101'],
    ['arrow-size', '0.09', '0.1', '20', '20.1'],
  ])('%s', (name, below, least, most, above) => {
    const isWrong = (text: string): boolean => wrongParts(read({[name]: text})).length > 0;
    expect([below, least, most, above].map(isWrong)).toEqual([true, false, false, true]);
    expect(isWrong('')).toBe(true);
  });
});
