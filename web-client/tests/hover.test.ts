import {expect, test} from 'vitest';
import type {FieldInfo} from '../core/protocol/fields';
import type {Pick} from '../core/session/inspector';
import {hoverText} from '../viewer/panels/hover';

const field = (name: string, components: number): FieldInfo => ({
  name,
  components,
  association: 'point',
  step: 0.01,
  minimum: Array<number>(components).fill(0),
  range: [0, 10],
});
const kFields = [field('p', 1), field('v', 3)];
const pickOf = (...fields: [number, number[]][]): Pick => ({
  cell: 0,
  corners: [0, 1, 2, 3],
  places: [],
  position: [0, 0, 0],
  lattice: [0, 0, 0],
  rest: null,
  fields: fields.map(([its, values]) => ({field: its, values})),
});

test('theShownQuantityIsNamedWithItsValue', () => {
  const pick = pickOf([0, [2.5]], [1, [3, 4, 0]]);
  expect(hoverText(pick, {field: 0, component: -1}, kFields)).toMatch(/^p 2\.50?$/);
  expect(hoverText(pick, {field: 1, component: -1}, kFields)).toMatch(/^v, magnitude 5(\.00?)?$/);
  expect(hoverText(pick, {field: 1, component: 1}, kFields)).toMatch(/^v, y 4(\.00?)?$/);
});

test('theUnitStandsBehindTheValue', () => {
  const fields = [{...kFields[0]!, unit: 'K'}];
  expect(hoverText(pickOf([0, [2.5]]), {field: 0, component: -1}, fields)).toMatch(
    /^p 2\.50?\u00a0K$/,
  );
  expect(hoverText(pickOf([0, [NaN]]), {field: 0, component: -1}, fields)).toBe('p no value');
});

test('aMissingValueIsSaid', () => {
  expect(hoverText(pickOf([0, [NaN]]), {field: 0, component: -1}, kFields)).toBe('p no value');
});

test('aFieldThatIsNotHereSaysNothing', () => {
  expect(hoverText(pickOf(), {field: 0, component: -1}, kFields)).toBe(null);
});
