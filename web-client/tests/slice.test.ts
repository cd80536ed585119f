import {describe, expect, test} from 'vitest';
import type {Plane} from '../core/protocol/geometry';
import {FieldScale} from '../core/picture/field_scale';
import {slice} from '../core/picture/slice';
import type {TriangleSoup} from '../core/picture/triangle_soup';
import {cubes, soupArea} from './cubes';

type Point = [number, number, number];
const corner = (soup: TriangleSoup, i: number): Point =>
  [...soup.positions.subarray(3 * i, 3 * i + 3)] as Point;

const plane = (normal: Point, offset: number): Plane => ({normal, offset});

describe('a cut', () => {
  const {points, tetrahedra} = cubes(3, 10);

  test.each([[0.5], [4.5], [9.5], [10.5], [29.5]])(
    'acrossACubeAt %d coversItsSectionOnce',
    (at) => {
      for (const normal of [
        [1, 0, 0],
        [0, -1, 0],
        [0, 0, 1],
      ] as Point[]) {
        const soup = slice(
          {points, tetrahedra},
          null,
          plane(normal, at * (normal[0] + normal[1] + normal[2])),
        );
        expect(soupArea(soup)).toBeCloseTo(900, 3);
      }
    },
  );

  test('throughVerticesStillCoversTheSectionOnce', () => {
    expect(soupArea(slice({points, tetrahedra}, null, plane([1, 0, 0], 10)))).toBeCloseTo(900, 3);
  });

  test('outsideTheMeshIsEmpty', () => {
    expect(slice({points, tetrahedra}, null, plane([1, 0, 0], 30.5)).positions).toHaveLength(0);
    expect(slice({points, tetrahedra}, null, plane([1, 0, 0], -0.5)).positions).toHaveLength(0);
  });

  test('obliqueLiesOnItsPlane', () => {
    const normal: Point = [1, 2, 3];
    const soup = slice({points, tetrahedra}, null, plane(normal, 77.25));
    expect(soup.positions.length).toBeGreaterThan(0);
    for (let i = 0; i < soup.positions.length / 3; ++i) {
      expect(corner(soup, i).reduce((sum, value, k) => sum + value * normal[k]!, 0)).toBeCloseTo(
        77.25,
        3,
      );
    }
  });

  test('interpolatesALinearFieldExactly', () => {
    const values = Int32Array.from(
      {length: points.length / 3},
      (_, v) => 2 * points[3 * v]! + 3 * points[3 * v + 1]! + 5 * points[3 * v + 2]!,
    );
    const scale = new FieldScale(values, {
      name: 'f',
      components: 1,
      association: 'point',
      step: 1,
      minimum: [0],
      range: [0, 300],
    });
    const soup = slice({points, tetrahedra}, scale, plane([1, 1, 1], 41.5));
    for (let i = 0; i < soup.values.length; ++i) {
      const [x, y, z] = corner(soup, i);
      expect(300 * soup.values[i]!).toBeCloseTo(2 * x + 3 * y + 5 * z, 3);
    }
  });
});

describe('one tetrahedron', () => {
  const points = Int32Array.from([0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4]);
  const tetrahedra = Uint32Array.from([0, 1, 2, 3]);

  test('withOneCornerCutOffGivesATriangle', () => {
    const soup = slice({points, tetrahedra}, null, plane([1, 0, 0], 3));
    expect([soup.positions.length, soup.firstHalf]).toEqual([9, 1]);
  });

  test('cutInPairsGivesAQuadWhoseDiagonalIsOppositeToTheFirstCorners', () => {
    const soup = slice({points, tetrahedra}, null, plane([1, 1, 0], 2));
    expect([soup.positions.length, soup.firstHalf]).toEqual([18, 0]);
    const shared = (first: number): string =>
      [corner(soup, first + 1), corner(soup, first + 2)].map(String).sort().join(' ');
    expect(shared(3)).toBe(shared(0));
    expect(String(corner(soup, 0))).not.toBe(String(corner(soup, 3)));
  });

  test('givesTheSameCutWhicheverSideIsAbove', () => {
    for (const normal of [
      [1, 0, 0],
      [0, 1, 0],
      [0, 0, 1],
      [1, 1, 0],
      [1, 0, 1],
      [0, 1, 1],
    ] as Point[]) {
      const there = slice({points, tetrahedra}, null, plane(normal, 1.5));
      const back = slice(
        {points, tetrahedra},
        null,
        plane(normal.map((value) => -value) as Point, -1.5),
      );
      expect(back.positions.length).toBe(there.positions.length);
      expect(soupArea(back)).toBeCloseTo(soupArea(there), 6);
    }
  });
});
