import {describe, expect, test} from 'vitest';
import {FieldScale} from '../core/picture/field_scale';
import {fieldKeys, type FieldInfo} from '../core/protocol/fields';
import {errorOf, readManifest} from '../core/protocol/manifest';
import {fakeHead} from './fakes';
import {boundarySoup, pointBounds} from '../core/picture/triangle_soup';

const info = (components: number, minimum: number[], range: [number, number]): FieldInfo => ({
  name: 'f',
  components,
  association: 'point',
  step: 0.5,
  minimum,
  range,
});

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
    const soup = boundarySoup(
      new Int32Array(9),
      Uint32Array.from([0, 1, 2]),
      new FieldScale(Int32Array.from([0, 1, 2]), field),
    );
    expect([...soup.values].map((value) => Number(value.toFixed(5)))).toEqual([0, 0.5, 1]);
  });

  test('thatAreMissingAreNaN', () => {
    const missing = -(2 ** 31);
    expect(new FieldScale(Int32Array.from([missing, 4]), info(1, [10], [10, 14])).at(0)).toBeNaN();
    const vectors = new FieldScale(
      Int32Array.from([0, missing, 0, 6, 8, 0]),
      info(3, [0, 0, 0], [0, 10]),
    );
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
  expect(pointBounds(points, Uint32Array.from([3, 1, 0, 2, 1, 3]))).toEqual([0, 0, 0, 5, 6, 7]);
});

describe('a manifest', () => {
  const columns = (): Uint32Array => Uint32Array.from([5, 6, 4, 7, 3, 8]);
  const head = (): Uint8Array => fakeHead({fields: ['p', 'q'], cellFields: ['p'], chunks: 2});
  const kNameAt = 64 + 5 + 9 + 32 + 1,
    kTypeAt = kNameAt + 1,
    kBitsAt = kTypeAt + 1,
    kStepAt = kBitsAt + 1;

  test('isReadAsItStands', () => {
    const field = (name: string, association: 'point' | 'cell'): FieldInfo => ({
      name,
      components: 1,
      association,
      isWhole: false,
      type: 0,
      bits: 8,
      step: 1,
      minimum: [0],
      range: [0, 255],
    });
    expect(readManifest(head(), columns)).toEqual({
      source: 'fake.vtu',
      lattice: {bits: 16, step: 1, origin: [0, 0, 0]},
      fields: [field('p', 'point'), field('q', 'point'), field('p', 'cell')],
      levels: [
        {level: 0, tetrahedra: 5, vertices: 4, boundaryTriangles: 3},
        {level: 1, tetrahedra: 6, vertices: 7, boundaryTriangles: 8},
      ],
      later: 0,
    });
  });

  test('tellsFieldsOfOneNameApart', () => {
    expect(fieldKeys(readManifest(head(), columns).fields)).toEqual(['p', 'q', 'cell:p']);
  });

  test('ofFieldsWithGapsIsTheSameButForTheFlagInBothPlaces', () => {
    const bytes = head();
    for (let f = 0; f < 3; ++f) bytes[bytes.length - 1 - 2 * f]! += 128;
    expect(() => readManifest(bytes, columns)).toThrow('missing values');
    for (let f = 0; f < 3; ++f) bytes[kTypeAt + 36 * f]! += 128;
    expect(readManifest(bytes, columns)).toEqual(readManifest(head(), columns));
  });

  test('tellsTheErrorsOfSomeLevels', () => {
    const bytes = fakeHead({fields: ['p'], chunks: 2});
    bytes[bytes.length - 4] = 1; // the table with the one field's shape is behind it
    const numbers = (errors: string, count: number): Uint32Array => {
      expect([errors, count]).toEqual(['some', 12]);
      return Uint32Array.from(
        [9, 8, 7, 1, 12346, 4000, 1, 901, 0, 0, 9024, 9924].flatMap((number, column) => [
          number,
          column < 3 ? number : 0,
        ]),
      );
    };
    const {levels} = readManifest(bytes, (_, errors, _fields, count) => numbers(errors, count));
    expect(levels.map(({error}) => error)).toEqual([
      {
        toLevel: {mean: 1e-12, max: 1e-11},
        toOriginal: {mean: 0, max: 0},
        volumeLost: 0.012346,
        volumeGained: 0.004,
        fields: [{mean: 0.0123, max: 0.123}],
      },
      undefined,
    ]);
    expect(errorOf(17100)).toBe(9.99e6);
  });

  test.each([
    ['a name too long', 64, [0x81, 0x03]],
    ['a length not in its shortest form', 64, [0x84, 0x00]],
    ['no name', kNameAt - 1, [0]],
    ['the same field twice', kNameAt + 36, ['p'.charCodeAt(0)]],
    ['an unknown type', kTypeAt, [10]],
    ['no bits', kBitsAt, [0]],
    ['too many bits', kBitsAt, [29]],
    ['a step of 0', kStepAt, [0, 0, 0, 0, 0, 0, 0, 0]],
    ['a step that is no number', kStepAt + 6, [0xf8, 0x7f]],
  ])('with %s isRefused', (_, at, bytes) => {
    const bad = head();
    bad.set(bytes, at);
    expect(() => readManifest(bad, columns)).toThrow('damaged');
  });

  test('cutAnywhereBeforeItsLevelsIsRefused', () => {
    const whole = head();
    const size = new DataView(whole.buffer).getUint32(24, true);
    for (let n = 0; n < size; ++n) {
      const cut = new Uint8Array([...whole.subarray(0, 64 + n), ...whole.subarray(64 + size)]);
      new DataView(cut.buffer).setUint32(24, n, true);
      expect(() => readManifest(cut, columns), `${n} bytes`).toThrow('ends too early');
    }
  });
});
