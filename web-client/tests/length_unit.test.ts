import {expect, test} from 'vitest';
import type {FieldInfo} from '../core/protocol/fields';
import {markSeries} from '../core/protocol/series';
import {lengthUnit} from '../viewer/settings/length_unit';

const field = (name: string, more: Partial<FieldInfo> = {}): FieldInfo => ({
  ...{name, components: 3, association: 'point', unit: 'mm'},
  ...{step: 1, minimum: [0, 0, 0], range: [0, 1]},
  ...more,
});
const unitOf = (...fields: FieldInfo[]): string => lengthUnit({lengthUnit: null}, {fields});

test('theUnitIsThatOfDisplacementsUnlessThePageSaysAnother', () => {
  expect(unitOf(field('T', {unit: 'K'}), field('Displacement'))).toBe('mm');
  expect(lengthUnit({lengthUnit: 'cm'}, {fields: [field('disp')]})).toBe('cm');
  expect(unitOf(field('T'))).toBe('');
});

test('aScalarOfThatNameIsNoDisplacement', () => {
  expect(unitOf(field('disp', {components: 1, minimum: [0], unit: '%'}))).toBe('');
});

test('aSeriesOfCellsHasTheUnitToo', () => {
  const fields = [
    field('u_disp', {components: 1, minimum: [0]}),
    field('u_disp@0', {association: 'cell'}),
    field('u_disp@1', {association: 'cell'}),
  ];
  delete fields[0]!.unit;
  markSeries(fields);
  expect(fields[1]!.instant!.series).toBe('cell:u_disp'); // not the name
  expect(unitOf(...fields)).toBe('mm');
});
