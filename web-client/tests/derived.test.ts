// Fields that are computed from others: texts, values against those of hand, errors, and hostile
// texts.

import {describe, expect, test} from 'vitest';
import {definitionsIn} from '../core/derived/definitions';
import {deriveFields, kDerivation, kMaxDefinitions} from '../core/derived/derived';
import {evaluate, type Input} from '../core/derived/evaluate';
import {
  ExpressionError,
  kMaxDepth,
  kMaxOperators,
  kMaxText,
  parseExpression,
} from '../core/derived/parse';
import {compile, inputsOf, kMaxSlopes} from '../core/derived/program';
import {kTensorQuantities} from '../core/derived/tensors';
import {parseScalar, scalarText} from '../core/layers/field_values';
import {kMissing} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import type {LevelInfo, Manifest} from '../core/protocol/manifest';
import {markSeries} from '../core/protocol/series';
import {cubes} from './cubes';
import {randomOf} from './random';

/** Values are the integers themselves, from -128 to 127. */
const field = (name: string, components = 1, more: Partial<FieldInfo> = {}): FieldInfo => ({
  name,
  components,
  association: 'point',
  step: 1,
  bits: 8,
  minimum: new Array<number>(components).fill(-128),
  range: components === 1 ? [-128, 127] : [0, 128 * Math.sqrt(components)],
  ...more,
});

const fields = [
  field('p'),
  field('T'),
  field('U', 3),
  field('V', 3),
  field('S', 6),
  field('alpha.water'),
  field('Heat flux'),
  field('mat', 1, {association: 'cell'}),
];
/** The values of one vertex; at a second one everything is missing. */
const numbers: Record<string, number[]> = {
  p: [10],
  T: [4],
  U: [1, 2, 2],
  V: [3, 0, -1],
  S: [50, 20, -10, 30, 0, 0],
  'alpha.water': [7],
  'Heat flux': [9],
  mat: [2],
};

const inputs = new Map(
  fields.map((info) => {
    const own = numbers[info.name]!;
    const values = [...own.map((x) => x + 128), ...own.map(() => kMissing)];
    return [info.name, {info, values: Int32Array.from(values)}];
  }),
);

const noMesh = {points: new Int32Array(6), tetrahedra: new Uint32Array(0), step: 1};

const valuesOf = (text: string): number[] => {
  const {components} = compile(parseExpression(text), fields);
  return [...evaluate(components[0]!.steps, inputs, 2, noMesh)];
};
const valueOf = (text: string): number => valuesOf(text)[0]!;

const faultOf = (text: string): [number, string] => {
  try {
    compile(parseExpression(text), fields);
  } catch (thrown) {
    if (thrown instanceof ExpressionError) return [thrown.at, thrown.message];
    throw thrown;
  }
  return [-1, ''];
};

test.each([
  ['(p - 101325) / (0.5 * 1.2 * 30^2)', (10 - 101325) / 540],
  ['p - T - 1', 5],
  ['p / T / 2', 1.25],
  ['p + T * 2', 18],
  ['-T^2', -16],
  ['T^-1', 0.25],
  ['2^3^2 + 0*p', 512],
  ['T^0.5', 2],
  ['+p', 10],
  ['1e1 - .5 * p', 5],
  ['p > T ? 1 : 2', 1],
  ['p < T ? 1 : p == 10 ? 3 : 4', 3],
  ['(p >= 10) + (p <= 9) + (p != T)', 2],
  ['mag(U)', 3],
  ['mag(U - V)', Math.sqrt(4 + 4 + 9)],
  ['mag(-p)', 10],
  ['mag(2 * U / T)', 1.5],
  ['dot(U, V)', 1],
  ['(U - V).z', 3],
  ['U.x + U[1]', 3],
  ['min(p, T) + max(p, T) + abs(-p)', 24],
  ['sqrt(T) + log(exp(p)) + sin(0 * p) + cos(0 * p)', 13],
  ['alpha.water + `Heat flux` + "p" + \'T\'', 30],
  ['S.xy + S.yy', 50],
  ['S.hydrostatic', 20],
  ['p \u2212 T', 6],
])('%s is %f', (text, expected) => expect(valueOf(text)).toBeCloseTo(expected, 12));

test('aMissingOrInfiniteValueIsMissing', () => {
  for (const text of ['p + 1', 'p > 1', 'p ? 1 : 2', 'p^0', 'min(p, 3)', 'mag(U)', 'S.mises'])
    expect(valuesOf(text)[1]).toBeNaN();
  for (const text of ['p / 0', 'log(0 * p)', 'sqrt(-p)', '(-p)^0.5'])
    expect(valuesOf(text)[0]).toBeNaN();
});

test.each([
  ['p +', 3, /^the text ends where a field/],
  ['p p', 2, /^"p" stands where an operator/],
  ['(p', 2, /"\)" is expected/],
  ['p ? 1', 5, /":" is expected/],
  ['p = 1', 2, /equality is ==/],
  ['p # 1', 2, /"#" means nothing/],
  ['`p', 0, /has no end/],
  ['q + 1', 0, /no field "q"; there are p, T/],
  ['1 + U', 2, /one side has 1 components, the other 3/],
  ['U', 0, /^a vector of 3 components stands here/],
  ['U * V', 2, /no product; take dot/],
  ['sin(U)', 0, /a number is taken here/],
  ['dot(U, p)', 0, /one side has 3/],
  ['U.w', 0, /no "w" here; it has x, y, z/],
  ['S.mise', 0, /it has xx, yy.*mises/],
  ['p.x', 0, /a number has no parts/],
  ['min(p)', 0, /min takes 2, not 1/],
  ['eval(p)', 0, /no function "eval"; there are grad, div, curl, Q, mag, dot/],
  ['constructor(p)', 0, /no function "constructor"/],
  ['grad(mat).x', 0, /^"mat" is of cells, and constant in each; grad takes a field of points/],
  ['grad(mat + 1).x', 0, /^this is of cells/],
  ['grad(2).x', 0, /takes a field of points, not a number/],
  ['grad(U).x', 0, /grad takes a number, not a vector/],
  ['div(p)', 0, /div takes a vector of 3 components, not of 1/],
  ['curl(S).x', 0, /not of 6/],
  ['curl(U)', 0, /a vector of 3 components stands here/],
  ['p.Q', 0, /a number has no parts/],
  ['U.q', 0, /it has x, y, z, div, vorticity, Q/],
  ['p + mat', 2, /one field is of points, the other of cells/],
])('whatIsWrongAndWhere: %s', (text, at, message) => {
  expect(faultOf(text)[0]).toBe(at);
  expect(faultOf(text)[1]).toMatch(message);
});

test('limitsHoldOneBelowAtAndOneAbove', () => {
  const nested = (depth: number): string => '('.repeat(depth) + 'p' + ')'.repeat(depth);
  const chain = (count: number): string => `p${'+p'.repeat(count)}`;
  const long = (length: number): string => 'p'.padEnd(length);
  const cases: [(size: number) => string, number][] = [
    [nested, kMaxDepth - 1], // the whole is one level
    [chain, kMaxOperators],
    [long, kMaxText],
  ];
  for (const [make, most] of cases) {
    expect(faultOf(make(most - 1))[0]).toBe(-1);
    expect(faultOf(make(most))[0]).toBe(-1);
    expect(faultOf(make(most + 1))[0]).toBeGreaterThanOrEqual(0);
  }
});

describe('gradients', () => {
  /** 64 cubes in a lattice of half a unit; each cube is 3 steps wide. */
  const [size, step] = [3, 0.5];
  const mesh = {...cubes(4, size), step};
  const count = mesh.points.length / 3;
  const places = Array.from({length: count}, (_, i) =>
    [...mesh.points.subarray(3 * i, 3 * i + 3)].map((x) => x * step),
  );
  /** Values are multiples of an eighth. */
  type Made = Map<string, Input>;
  const given = (make: Record<string, (x: number, y: number, z: number) => number[]>): Made =>
    new Map(
      Object.entries(make).map(([name, of]) => {
        const minimum = of(0, 0, 0).map(() => 0);
        const info = field(name, minimum.length, {step: 1 / 8, minimum});
        const values = places.flatMap(([x, y, z]) => of(x!, y!, z!).map((its) => its * 8));
        return [name, {info, values: Int32Array.from(values)}];
      }),
    );
  const evaluated = (text: string, its: Made, at = mesh): number[] => {
    const {components} = compile(
      parseExpression(text),
      [...its.values()].map(({info}) => info),
    );
    return [...evaluate(components[0]!.steps, its, count, at)];
  };
  const isInside = (i: number): boolean => places[i]!.every((x) => x > 0 && x < 4 * size * step);
  const everywhere = (text: string, value: number, its: Made): void => {
    for (const found of evaluated(text, its)) expect(found, text).toBeCloseTo(value, 9);
  };

  test('ofALinearFieldAreExactAtEveryVertex', () => {
    const its = given({p: (x, y, z) => [2 * x - 3 * y + 0.5 * z + 7]});
    for (const [part, value] of [2, -3, 0.5].entries()) everywhere(`grad(p)[${part}]`, value, its);
    everywhere('mag(grad(p))', Math.sqrt(13.25), its);
    everywhere('grad(2 * p - 1).x + grad(p).x', 6, its);
  });

  test('ofAQuadraticFieldAreExactInsideARegularMesh', () => {
    const its = given({p: (x, y) => [x * x + 2 * x * y]});
    const [alongX, alongY] = ['x', 'y'].map((axis) => evaluated(`grad(p).${axis}`, its));
    for (const [i, [x, y]] of places.entries()) {
      if (!isInside(i)) continue;
      expect(alongX![i]).toBeCloseTo(2 * x! + 2 * y!, 9);
      expect(alongY![i]).toBeCloseTo(2 * x!, 9);
    }
  });

  test('ofARigidRotationAreTwiceItsSpeed', () => {
    const its = given({U: (x, y, z) => [2 * z - 3 * y, 3 * x - z, y - 2 * x]}); // (1, 2, 3)
    for (const [part, speed] of [1, 2, 3].entries()) everywhere(`curl(U)[${part}]`, 2 * speed, its);
    everywhere('div(U)', 0, its);
    everywhere('Q(U)', 14, its);
    everywhere('U.vorticity', 2 * Math.sqrt(14), its);
    everywhere('U.Q + U.div', 14, its);
  });

  test('ofStrainAndShearHaveTheValuesOfHand', () => {
    const strain = given({U: (x, y, z) => [2 * x, -3 * y, 4 * z]});
    everywhere('div(U)', 3, strain);
    everywhere('mag(curl(U))', 0, strain);
    everywhere('Q(U)', -(4 + 9 + 16) / 2, strain);
    const shear = given({U: (_x, y) => [5 * y, 0, 0]});
    everywhere('Q(U)', 0, shear);
    everywhere('curl(U).z', -5, shear);
  });

  test('ofGradientsAreGradientsToo', () => {
    const its = given({p: (x) => [x * x]});
    const bent = evaluated('div(grad(p))', its);
    const middle = places.findIndex((place) => place.every((x) => x === 2 * size * step));
    expect(bent[middle]).toBeCloseTo(2, 9);
  });

  test('doNotDependOnTheOrderOfCornersAndLeaveOutFlatCells', () => {
    const its = given({p: (x, y) => [x * y]});
    const right = evaluated('grad(p).x', its);
    const turned = mesh.tetrahedra.map((_, i, all) => all[i ^ 2]!);
    expect(evaluated('grad(p).x', its, {...mesh, tetrahedra: turned})).toEqual(
      right.map((x) => expect.closeTo(x, 9) as number),
    );
    const flat = Uint32Array.from([...mesh.tetrahedra, 0, 1, 2, 3, 7, 7, 8, 9]);
    expect(evaluated('grad(p).x', its, {...mesh, tetrahedra: flat})).toEqual(right);
  });

  test('weighCellsByTheirVolumes', () => {
    const points = Int32Array.of(0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0);
    const two = {points, tetrahedra: Uint32Array.of(0, 1, 2, 3, 0, 4, 2, 3), step: 1};
    const its = new Map([['p', {info: field('p'), values: Int32Array.of(0, 6, 0, 0, -6)}]]);
    const values = (text: string): Float64Array =>
      evaluate(compile(parseExpression(text), [field('p')]).components[0]!.steps, its, 5, two);
    // 2 in a cell of volume 3, 6 in one of volume 1
    expect([...values('grad(p).x')].map((x) => x - 0)).toEqual([3, 2, 3, 3, 6]);
  });

  test('areMissingWhereNoCellHasAllValues', () => {
    const its = given({p: (x) => [x]});
    its.get('p')!.values[0] = kMissing;
    const values = evaluated('grad(p).x', its);
    expect(values[0]).toBeNaN();
    expect(values.at(-1)).toBeCloseTo(1, 9);
    expect(valuesOf('grad(p).x')).toEqual([NaN, NaN]);
  });

  test('haveNoRangeAndNoKnownError', () => {
    for (const text of ['grad(p).x', 'mag(grad(p))', 'div(U)', 'mag(curl(U))', 'Q(U)', 'U.Q']) {
      const {components, errors, association} = compile(parseExpression(text), fields);
      expect(errors, text).toBe(null);
      expect(association).toBe('point');
      expect(components[0]!.range[1]).toBe(Infinity);
    }
    expect(inputsOf(compile(parseExpression('div(p * U) + grad(grad(T).x).y'), fields))).toEqual([
      'p',
      'U',
      'T',
    ]);
  });

  test('areNoMoreThanTheLimit', () => {
    const many = (length: number): string =>
      Array.from({length}, (_, i) => `grad(p + ${i}).x`).join(' + ');
    expect(faultOf(many(kMaxSlopes - 1))[1]).toBe('');
    expect(faultOf(many(kMaxSlopes))[1]).toBe('');
    expect(faultOf(many(kMaxSlopes + 1))[1]).toMatch(/more than 12 gradients/);
    // equal ones are one
    expect(faultOf('grad(p).x + grad(p).y + '.repeat(20) + '0')[1]).toBe('');
  });
});

describe('tensors', () => {
  const of = (name: string, tensor: number[]): number =>
    kTensorQuantities.find((its) => its.name === name)!.of(tensor);
  const all = (tensor: number[]): number[] => kTensorQuantities.map((its) => its.of(tensor));

  const near = (x: number): number => expect.closeTo(x, 10) as number;

  test('haveTheValuesOfHand', () => {
    // plane stress: 35 +- sqrt(15^2 + 30^2), and 0 - 10
    const plane = [50, 20, -10, 30, 0, 0];
    const radius = Math.sqrt(225 + 900);
    expect(of('principal1', plane)).toBeCloseTo(35 + radius, 10);
    expect(of('principal2', plane)).toBeCloseTo(35 - radius, 10);
    expect(of('principal3', plane)).toBeCloseTo(-10, 10);
    expect(of('tresca', plane)).toBeCloseTo(45 + radius, 10);
    expect(of('mises', plane)).toBeCloseTo(Math.sqrt(5400), 10);
    // pure tension and pure shear, in each plane
    for (const [i, shear] of [3, 4, 5].entries()) {
      const tension = [0, 0, 0, 0, 0, 0].map((_, k) => (k === i ? 7 : 0));
      expect(all(tension)).toEqual([7, 7, 7, 0, 0, 7 / 3].map(near));
      const twist = [0, 0, 0, 0, 0, 0].map((_, k) => (k === shear ? 2 : 0));
      const right = [2 * Math.sqrt(3), 4, 2, 0, -2, 0];
      expect(all(twist)).toEqual(right.map(near));
    }
    expect(all([5, 5, 5, 0, 0, 0])).toEqual([0, 0, 5, 5, 5, 5]);
  });

  test('changeByNoMoreThanTheirFactor', () => {
    const random = randomOf(11);
    const any = (): number[] => Array.from({length: 6}, () => random() * 2 - 1);
    for (let i = 0; i < 3000; ++i) {
      const [a, b] = [any(), any()];
      const length = Math.hypot(...a.map((x, c) => x - b[c]!));
      for (const {factor, isSigned, of: quantity} of kTensorQuantities) {
        expect(Math.abs(quantity(a) - quantity(b))).toBeLessThanOrEqual(factor * length + 1e-9);
        if (!isSigned) expect(quantity(a)).toBeGreaterThanOrEqual(0);
      }
    }
  });
});

test('knownErrorsFollowByRuleWhereTheyCan', () => {
  const sizes: Record<string, number> = {p: 1, T: 10, U: 100, V: 1000, S: 1};
  const ofCells = fields.map((its) => ({...its, association: 'cell' as const}));
  const errorOf = (text: string, of = ofCells as readonly FieldInfo[]): number | null =>
    compile(parseExpression(text), of).errors?.((key) => {
      const max = sizes[key]!;
      return {mean: max / 2, max};
    }).max ?? null;
  const [most, length] = [128, 128 * Math.sqrt(3)];
  const right: [string, number][] = [
    ['p - T', 11],
    ['2 * p - p / 4 + 5', 2.25],
    ['-(3 - p)', 1],
    ['mag(U)', 100],
    ['mag(U - 2 * V)', 2100],
    ['U.x', 100],
    ['max(p, abs(T))', 11],
    ['S.hydrostatic', Math.sqrt(1 / 3)],
    ['p * T', most * 11 + 10],
    ['p^2', most * 2 + 1],
    ['mag(p * U)', most * 100 + length * 1 + 100],
    ['dot(U, V)', length * 1100 + 100 * 1000],
  ];
  for (const [text, error] of right) expect(errorOf(text), text).toBeCloseTo(error, 9);
  for (const text of ['p / T', 'p^3', 'sqrt(p)', 'p > T', 'p * sqrt(T)'])
    expect(errorOf(text), text).toBe(null);
  // Between points only what is linear keeps to its rule.
  const ofPoints = (text: string): number | null => errorOf(text, fields);
  for (const text of ['abs(p)', 'p * T', 'p^2', 'mag(U)', 'mag(U - V)', 'dot(U, V)', 'S.mises'])
    expect(ofPoints(text), text).toBe(null);
  for (const text of ['p - T', '2 * p - p / 4 + 5', '-(3 - p)', 'U.x', 'S.hydrostatic'])
    expect(ofPoints(text), text).toBeCloseTo(errorOf(text)!, 9);
});

test('noProductIsFurtherOffThanItsRuleSays', () => {
  const ofCells = fields.map((its) => ({...its, association: 'cell' as const}));
  const rule = compile(parseExpression('p * T'), ofCells).errors!;
  const random = randomOf(3);
  const any = (most: number): number => most * (2 * random() - 1);
  for (let i = 0; i < 1000; ++i) {
    const [a, b, da, db] = [any(127), any(127), any(5), any(5)];
    const known: Record<string, number> = {p: Math.abs(da), T: Math.abs(db)};
    const {max} = rule((key) => ({mean: 0, max: known[key]!}));
    expect(Math.abs((a + da) * (b + db) - a * b)).toBeLessThanOrEqual(max + 1e-9);
  }
});

describe('definitions', () => {
  const level = (mean: number): LevelInfo => ({
    level: 0,
    tetrahedra: 1,
    vertices: 4,
    boundaryTriangles: 4,
    error: {
      toLevel: {mean: 0, max: 0},
      toOriginal: {mean: 0, max: 0},
      volumeLost: 0,
      volumeGained: 0,
      fields: fields.map(() => ({mean, max: 2 * mean})),
    },
  });
  const manifest = {fields, levels: [level(0.1), level(0.01)]} as unknown as Manifest;

  test('makeFieldsBehindThoseOfTheMesh', () => {
    const {fields: made, errors} = deriveFields(
      'q = 0.5; Cp = (p - 1) * q; a b = Cp - T;; bad = 1 +; Cp = 3*p; p = T; = 3; x=1/p',
      manifest,
    );
    const own = made.filter(({info}) => info.of === undefined);
    expect(own.map(({info}) => info.name)).toEqual(['Cp', 'a b', 'x']);
    expect(own.map((its) => its.inputs)).toEqual([['p'], ['p', 'T'], ['p']]);
    expect(own[0]!.info.range).toEqual([-64.5, 63]);
    expect(own[0]!.errors).toEqual([
      {mean: expect.closeTo(0.1, 12) as number, max: expect.closeTo(0.2, 12) as number},
      {mean: expect.closeTo(0.01, 12) as number, max: expect.closeTo(0.02, 12) as number},
    ]);
    expect(own[2]!.info.derived).toBe('unbounded');
    expect(own[2]!.errors).toEqual([null, null]);
    expect(errors.map((text) => /^"(.*)", column (\d+)/.exec(text)!.slice(1))).toEqual([
      ['bad = 1 +', '10'],
      ['Cp = 3*p', '1'],
      ['p = T', '1'],
      ['= 3', '1'],
    ]);
    const all = [...fields, ...made.map(({info}) => info)];
    expect(made.slice(3).map(({info}) => info.title)).toContain('S, von Mises');
    expect(scalarText(parseScalar('S.mises', all)!, all)).toBe('S.mises');
    expect(parseScalar('Cp', all)).toEqual({field: fields.length, component: -1});
  });

  test('offerTheQuantitiesOfVectors', () => {
    const {fields: made} = deriveFields('', manifest);
    const ofU = made.filter(({info}) => info.of === 'U');
    expect(ofU.map(({info}) => [info.name, info.title])).toEqual([
      ['U.div', 'U, divergence'],
      ['U.vorticity', 'U, vorticity'],
      ['U.Q', 'U, Q criterion'],
    ]);
    expect(ofU[0]!.errors).toEqual([null, null]);
  });

  test('ofOldTextsEnd', () => {
    const {id, info} = deriveFields('a = p', manifest).fields[0]!;
    const values = {info: fields[0]!, values: Int32Array.of(5), state: '1,1'};
    const isKnown = (): boolean =>
      kDerivation.scale!({id, info, inputs: [0]}, () => values, noMesh) !== null;
    for (let i = 1; i < 8; ++i) {
      deriveFields(`a = p + ${i}`, manifest);
      expect(isKnown()).toBe(true);
    }
    deriveFields('a = T', manifest);
    expect(isKnown()).toBe(false);
  });

  test('areSeparatedOutsideOfQuotes', () =>
    expect(definitionsIn(' a = `x;y`; b=2 ;')).toEqual(['a = `x;y`', 'b=2']));

  test('areNoMoreThanTheLimit', () => {
    const text = (count: number): string =>
      Array.from({length: count}, (_, i) => `a${i} = p + ${i}`).join(';');
    expect(deriveFields(text(kMaxDefinitions), manifest).errors).toEqual([]);
    for (const more of [1, 1000])
      expect(deriveFields(text(kMaxDefinitions + more), manifest).errors.length).toBe(1);
  });

  test('cannotDoubleTheirStepsAgainAndAgain', () => {
    const doubled = Array.from({length: 19}, (_, i) => `a${i + 1} = a${i} * a${i}`).join(';');
    const {errors} = deriveFields(`a0 = p + 1; ${doubled}`, manifest);
    expect(errors[0]).toMatch(/more than 1000 steps/);
  });

  test('ofInstantsAndOfTheShownOneHaveValues', () => {
    const series = [field('T@1'), field('T@2'), field('T@3')];
    markSeries(series);
    const ofSeries = {fields: series, levels: []} as unknown as Manifest;
    const [{id, info, inputs: keys}] = deriveFields('d = T - T@1', ofSeries).fields as [
      ReturnType<typeof deriveFields>['fields'][number],
    ];
    expect(keys).toEqual(['T', 'T@1']);
    const values = [1, 5, 25];
    const scale = kDerivation.scale!(
      {id, info, inputs: [2, 0]},
      (at) => ({
        info: series[at]!,
        values: Int32Array.of(values[at]! + 128),
        state: '1,1',
      }),
      noMesh,
    )!;
    const [low, high] = info.range;
    expect(low + scale.at(0) * (high - low)).toBeCloseTo(24, 10);
    expect(kDerivation.scale!({id, info, inputs: [2, 0]}, () => null, noMesh)).toBe(null);
  });
});

describe('hostileTexts', () => {
  const kPieces = [
    ...Array.from('+-*/^<>=?:(),.[]`"\'@;#\u2212\u00e9\u{1f600} \n'),
    ...[
      'p',
      'T@2',
      'U.x',
      'U',
      'S.mises',
      'mag(',
      'dot(',
      'min(',
      'grad(',
      'curl(',
      'Q(',
      '1e308',
      '.5',
      '==',
      '<=',
      '1.',
    ],
    ...[
      '__proto__',
      'constructor',
      'toString(',
      'window',
      'import(',
      '${p}',
      '\\u0070',
      '//',
      '/*',
    ],
  ];

  test('giveValuesOrAnErrorWithAPlaceInTheText', () => {
    const random = randomOf(20261130);
    let right = 0;
    for (let i = 0; i < 20_000; ++i) {
      const length = 1 + Math.floor(random() * (i % 50 === 0 ? 600 : 9));
      const text = Array.from({length}, () => kPieces[Math.floor(random() * kPieces.length)]!).join(
        '',
      );
      const [at, message] = faultOf(text);
      expect(at).toBeLessThanOrEqual(text.length);
      if (message === '') {
        ++right;
        expect(valuesOf(text)).toHaveLength(2);
      }
    }
    expect(right).toBeGreaterThan(100);
  });

  test('ofTheGrammarAreWhatTheRangeSays', () => {
    const random = randomOf(7);
    const pick = <T>(all: readonly T[]): T => all[Math.floor(random() * all.length)]!;
    const make = (depth: number): string => {
      if (depth === 0)
        return pick(['p', 'T', 'U.y', 'mag(V)', 'S.mises', '2', '0.5', 'S.principal3']);
      const its = (): string => make(depth - 1);
      return pick([
        () => `(${its()} ${pick(['+', '-', '*', '/', '^', '<', '>=', '=='])} ${its()})`,
        () => `${pick(['abs', 'sqrt', 'exp', 'log', 'sin', 'cos', '-'])}(${its()})`,
        () => `${pick(['min', 'max'])}(${its()}, ${its()})`,
        () => `(${its()} > 0 ? ${its()} : ${its()})`,
      ])();
    };
    for (let i = 0; i < 3000; ++i) {
      const text = make(1 + (i % 4));
      const {components} = compile(parseExpression(text), fields);
      const [low, high] = components[0]!.range;
      const value = valueOf(text);
      if (Number.isNaN(value) || Number.isNaN(low + high)) continue;
      const slack = 1e-9 * (1 + Math.abs(value));
      expect(value, text).toBeGreaterThanOrEqual(low - slack);
      expect(value, text).toBeLessThanOrEqual(high + slack);
    }
  });
});
