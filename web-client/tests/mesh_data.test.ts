import {describe, expect, test} from 'vitest';
import {FieldScale} from '../core/field_scale';
import {parseManifest} from '../core/manifest';
import {boundarySoup, soupBounds} from '../core/triangle_soup';

const info = (components: number, minimum: number[], range: [number, number]) =>
  ({name: 'f', components, association: 'point' as const, step: 0.5, minimum, range});

describe('field values', () => {
  test('ofAScalarSpanItsRange', () => {
    const scale = new FieldScale(Int32Array.from([0, 4, 8]), info(1, [10], [10, 14]));
    expect([0, 1, 2].map((vertex) => scale.at(vertex))).toEqual([0, 0.5, 1]);
  });

  test('ofAVectorAreMagnitudes', () => {
    const scale = new FieldScale(Int32Array.from([0, 0, 0, 6, 8, 0]), info(3, [0, 0, 0], [0, 10]));
    expect([0, 1].map((vertex) => scale.at(vertex))).toEqual([0, 0.5]);
  });

  test('keepTheDigitsOfASmallRangeRoundALargeValue', () => {
    const field = {...info(1, [101325], [101325, 101325.002]), step: 0.001};
    const soup = boundarySoup(new Int32Array(9), Uint32Array.from([0, 1, 2]), new FieldScale(Int32Array.from([0, 1, 2]), field));
    expect([...soup.values].map((value) => Number(value.toFixed(5)))).toEqual([0, 0.5, 1]);
  });

  test('thatAreMissingAreNaN', () => {
    const gap = -(2 ** 31);
    expect(new FieldScale(Int32Array.from([gap, 4]), info(1, [10], [10, 14])).at(0)).toBeNaN();
    const vectors = new FieldScale(Int32Array.from([0, gap, 0, 6, 8, 0]), info(3, [0, 0, 0], [0, 10]));
    expect([0, 1].map((vertex) => vectors.at(vertex))).toEqual([NaN, 0.5]);
  });

  test('ofAConstantFieldAreZero', () => {
    expect(new FieldScale(Int32Array.from([3]), info(1, [1.5], [3, 3])).at(0)).toBe(0);
  });
});

test('aSoupHasEveryTrianglesCornersInOrder', () => {
  const points = Int32Array.from([0, 0, 0, 5, 0, 0, 0, 6, 0, 0, 0, 7]);
  const soup = boundarySoup(points, Uint32Array.from([3, 1, 0, 2, 1, 3]), null);
  expect([...soup.positions]).toEqual([0, 0, 7, 5, 0, 0, 0, 0, 0, 0, 6, 0, 5, 0, 0, 0, 0, 7]);
  expect(soup.values).toHaveLength(0);
  expect(soup.firstHalf).toBe(2);
  expect(soupBounds(soup)).toEqual([0, 0, 0, 5, 6, 7]);
});

describe('a manifest', () => {
  const good = {
    source: 'a.vtu', lattice: {bits: 16, step: 0.1, origin: [1, 2, 3]},
    fields: [{name: 'p', components: 1, association: 'point', step: 1, minimum: [0], range: [0, 1]}],
    levels: [{level: 0, tetrahedra: 5, vertices: 4, boundaryTriangles: 3}],
  };

  test('isReadAsItStands', () => {
    expect(parseManifest(JSON.stringify(good))).toEqual(good);
  });

  test.each([
    ['/lattice', {...good, lattice: undefined}],
    ['/lattice/origin', {...good, lattice: {...good.lattice, origin: [1, 2]}}],
    ['/fields/0/minimum', {...good, fields: [{...good.fields[0], minimum: []}]}],
    ['/fields/0/name', {...good, fields: [{...good.fields[0], name: 3}]}],
    ['/levels/0/tetrahedra', {...good, levels: [{...good.levels[0], tetrahedra: '5'}]}],
  ])('withoutItsPart %s isRefusedWithThePlace', (place, broken) => {
    expect(() => parseManifest(JSON.stringify(broken))).toThrow(`"${place}"`);
  });

  test('thatIsNotJsonIsRefused', () => {
    expect(() => parseManifest('{')).toThrow('not JSON');
  });
});
