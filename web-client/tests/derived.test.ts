// Fields that are computed from others: texts, values against those of hand, errors, and hostile
// texts.

import {describe, expect, test} from 'vitest';
import {definitionsIn} from '../core/derived/definitions';
import {deriveFields, kDerivation, kMaxDefinitions} from '../core/derived/derived';
import {evaluate} from '../core/derived/evaluate';
import {
  ExpressionError,
  kMaxDepth,
  kMaxOperators,
  kMaxText,
  parseExpression,
} from '../core/derived/parse';
import {compile} from '../core/derived/program';
import {kTensorQuantities} from '../core/derived/tensors';
import {parseScalar, scalarText} from '../core/layers/field_values';
import {kMissing} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import type {LevelInfo, Manifest} from '../core/protocol/manifest';
import {markSeries} from '../core/protocol/series';
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

const valuesOf = (text: string): number[] => {
  const {components} = compile(parseExpression(text), fields);
  return [...evaluate(components[0]!.steps, inputs, 2)];
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
  ['eval(p)', 0, /no function "eval"; there are mag, dot/],
  ['constructor(p)', 0, /no function "constructor"/],
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
    const scale = kDerivation.scale!({id, info, inputs: [2, 0]}, (at) => ({
      info: series[at]!,
      values: Int32Array.of(values[at]! + 128),
      state: '1,1',
    }))!;
    const [low, high] = info.range;
    expect(low + scale.at(0) * (high - low)).toBeCloseTo(24, 10);
    expect(kDerivation.scale!({id, info, inputs: [2, 0]}, () => null)).toBe(null);
  });
});

describe('hostileTexts', () => {
  const kPieces = [
    ...Array.from('+-*/^<>=?:(),.[]`"\'@;#\u2212\u00e9\u{1f600} \n'),
    ...['p', 'T@2', 'U.x', 'U', 'S.mises', 'mag(', 'dot(', 'min(', '1e308', '.5', '==', '<=', '1.'],
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
