import {describe, expect, test} from 'vitest';
import {parseScalar, scalarText} from '../core/layers/field_values';
import {kMagnitude} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import {markSeries, shownInstant, showTime, timesOf} from '../core/protocol/series';

function field(name: string, high = 1, association: 'point' | 'cell' = 'point'): FieldInfo {
  return {name, components: 1, association, step: 1, minimum: [0], range: [0, high]};
}

function marked(...fields: FieldInfo[]): FieldInfo[] {
  markSeries(fields);
  return fields;
}

describe('a series', () => {
  const fields = marked(
    field('T@0', 2),
    field('T@2', 5),
    field('T@0.5', 3),
    field('p'),
    field('lone@1'),
    field('x@y'),
  );

  test('isTwoInstantsAndMoreWithOneRange', () => {
    expect(fields.map(({instant}) => instant?.time)).toEqual([
      0,
      2,
      0.5,
      undefined,
      undefined,
      undefined,
    ]);
    expect(fields.map(({range}) => range[1])).toEqual([5, 5, 5, 1, 1, 1]);
    expect(timesOf(fields).map(({text}) => text)).toEqual(['0', '0.5', '2']);
  });

  test('isMeantByItsKeyAtTheTimeThatIsShown', () => {
    for (const [time, shown] of [
      [null, 0],
      [-9, 0],
      [0.2, 0],
      [0.25, 0],
      [0.3, 2],
      [1.5, 1],
      [99, 1],
    ] as const) {
      showTime(fields, time);
      expect(parseScalar('T', fields)).toEqual({field: shown, component: kMagnitude});
      expect(shownInstant(fields, 1)).toBe(shown);
      expect(scalarText({field: shown, component: kMagnitude}, fields)).toBe('T');
    }
    expect(parseScalar('T@0.5', fields)?.field).toBe(2);
    expect(shownInstant(fields, 3)).toBe(3);
  });

  test('ofCellsIsAnotherThanThatOfPoints', () => {
    const both = marked(
      field('T@0'),
      field('T@1'),
      field('T@0', 7, 'cell'),
      field('T@1', 8, 'cell'),
    );
    showTime(both, 1);
    expect(parseScalar('T', both)?.field).toBe(1);
    expect(parseScalar('cell:T', both)?.field).toBe(3);
    expect(both.map(({range}) => range[1])).toEqual([1, 1, 8, 8]);
  });
});
