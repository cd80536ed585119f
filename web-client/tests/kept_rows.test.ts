// The rows of the table of kept points and lines.

import {expect, test} from 'vitest';
import {kMagnitude} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import type {Manifest} from '../core/protocol/manifest';
import type {Vector} from '../core/protocol/geometry';
import {alongLine, type Pick} from '../core/session/inspector';
import {angle, measuredRows, valueRows, withinOf, type KeptScene} from '../viewer/panels/kept_rows';
import {tableOfRows, textOfRows} from '../viewer/panels/numbers_table';

const kNone = {points: new Set<number>(), lines: new Set<number>()};

const info = (name: string, components: number, more: Partial<FieldInfo> = {}): FieldInfo => ({
  name,
  components,
  association: 'point',
  step: 0.5,
  minimum: new Array<number>(components).fill(0),
  range: [0, 10],
  ...more,
});
const manifest = {
  fields: [info('T', 1, {unit: 'K'}), info('U', 3), info('M', 1, {labels: new Map([[1, 'iron']])})],
  levels: [
    {
      error: {
        fields: [
          {mean: 0.01, max: 0.1},
          {mean: 0.01, max: NaN},
          {mean: 0.1, max: 1},
        ],
      },
    },
    {error: undefined},
  ],
  lattice: {bits: 4, step: 1, origin: [0, 0, 0]},
} as unknown as Manifest;

const pickAt = (position: Vector, rest: Vector | null = null): Pick => ({
  cell: 0,
  corners: [],
  places: [],
  position,
  lattice: position,
  rest: rest && {position: rest, lattice: rest},
  fields: [
    {field: 0, values: [7]},
    {field: 1, values: [3, 4, 0]},
    {field: 2, values: [1]},
  ],
});

const scene: KeptScene = {
  points: [
    {name: 'Tip', places: [[0, 0, 0]]},
    {name: '', places: [[3, 0, 0]]},
    {name: '=1+1', places: [[3, 4, 0]]},
  ],
  lines: [
    {name: 'Wake', places: [[0, 0, 0], [2, 0, 0]]}, // prettier-ignore
    {name: '', places: [[0, 0, 0], [-1, 1, 0]]}, // prettier-ignore
  ],
  values: {
    level: 0,
    color: {field: 0, component: kMagnitude},
    extremes: [],
    points: [pickAt([0, 0, 0]), null, pickAt([3, 4, 0])],
    lines: [
      {ends: [pickAt([0, 0, 0]), pickAt([2, 0, 0])], length: 2, mean: 5, least: 4, largest: 6},
      {ends: [pickAt([0, 0, 0]), pickAt([-1, 1, 0])], length: 1.5, mean: 5, least: 4, largest: 6},
    ],
  },
  color: {field: 0, component: kMagnitude},
  manifest,
  level: 0,
  unit: 'm',
};
const titlesOf = (rows: {title: string}[]): string[] => rows.map(({title}) => title);

test('pointsHavePlacesAndValues_AndLinesTheirLength', () => {
  const rows = valueRows(scene, false);
  expect(titlesOf(rows)).toEqual([
    'Place of Tip',
    'Value of T at Tip',
    'Place of Point 2',
    'Place of =1+1',
    'Value of T at =1+1',
    'Length of Wake',
    'Mean of T along Wake',
    'Least of T along Wake',
    'Largest of T along Wake',
    'Length of Line B',
    'Mean of T along Line B',
    'Least of T along Line B',
    'Largest of T along Line B',
  ]);
  expect(rows[1]).toEqual({title: 'Value of T at Tip', values: [7], unit: 'K', within: 1});
  expect(rows[5]).toEqual({title: 'Length of Wake', values: [2], unit: 'm'});
});

test('allFieldsHaveTheirComponents_AndOnlyOnesThatAreHere', () => {
  const titles = titlesOf(valueRows({...scene, points: scene.points.slice(0, 1)}, true));
  expect(titles.slice(1, 7)).toEqual([
    'Value of T at Tip',
    'Value of U, x at Tip',
    'Value of U, y at Tip',
    'Value of U, z at Tip',
    'Value of U, magnitude at Tip',
    'Value of M at Tip',
  ]);
});

test('aLabelHasNoMean_AndAnUnknownErrorNoBound', () => {
  const label = valueRows({...scene, color: {field: 2, component: kMagnitude}}, false);
  expect(titlesOf(label).filter((title) => /Mean|Least/.test(title))).toEqual([]);
  expect([0, 1, 2].map((field) => withinOf(field, scene))).toEqual([1, undefined, undefined]);
  expect(withinOf(0, {...scene, level: 1})).toBe(0.25); // half of a step
  expect(valueRows({...scene, color: null}, false).some(({title}) => /^V/.test(title))).toBe(false);
});

test('aPlaceThatAWarpMovesIsMeasuredThere', () => {
  const points = [pickAt([0, 0, 1], [0, 0, 0]), pickAt([3, 0, 1], [3, 0, 0]), pickAt([3, 4, 0])];
  const moved = {...scene, values: {...scene.values, points}};
  expect(titlesOf(valueRows(moved, false)).slice(0, 2)).toEqual([
    'Place of Tip',
    'Place at rest of Tip',
  ]);
  expect(measuredRows(moved, kNone)[1]!.values[0]).toBeCloseTo(Math.sqrt(17), 12);
});

test('distancesAndAnglesGoAlongTheList_OrAlongTheChosen', () => {
  expect(measuredRows(scene, kNone)).toEqual([
    {title: 'Distance from Tip to Point 2', values: [3], unit: 'm'},
    {title: 'Distance from Point 2 to =1+1', values: [4], unit: 'm'},
    {title: 'Angle at Point 2, from Tip to =1+1', values: [90], unit: '\u00b0'},
    {
      title: 'Angle between Wake and Line B',
      values: [expect.closeTo(45, 10)],
      unit: '\u00b0',
    },
  ]);
  const chosen = {points: new Set([0, 2]), lines: new Set([1])};
  expect(titlesOf(measuredRows(scene, chosen))).toEqual([
    'Distance from Tip to =1+1',
    'Angle between Wake and Line B',
  ]);
});

test('anglesAreExactNearTheirEnds', () => {
  expect(angle([1, 0, 0], [1, 1e-9, 0])).toBeCloseTo((1e-9 * 180) / Math.PI, 15);
  expect(angle([2, 0, 0], [-5, 0, 0])).toBe(180);
  expect(angle([0, 0, 0], [1, 0, 0])).toBeNaN();
});

test('theMeanAlongALineIsByLength', () => {
  const gap = {at: [0, 1, 1.5, 2, 5], values: [0, 2, NaN, 4, 4]};
  expect(alongLine(gap)).toEqual({mean: (1 + 12) / 4, least: 0, largest: 4});
  // two cells share the face that the line goes along
  const twice = {at: [0, 1, 0, 1, 1, 2], values: [0, 2, 0, 2, 2, 2]};
  expect(alongLine(twice).mean).toBe(1.5);
  expect(alongLine({at: [], values: []}).mean).toBeNaN();
});

test('noNameBecomesAFormula', async () => {
  const rows = [...valueRows(scene, true), ...measuredRows(scene, kNone)];
  for (const line of textOfRows(rows).split('\n')) expect(line).toMatch(/^[A-Z][a-z]/);
  const lines = (await tableOfRows(rows, []).text()).split('\r\n');
  for (const line of lines.slice(1)) expect(line).toMatch(/^"[A-Z][a-z]/);
});
