import {describe, expect, test} from 'vitest';
import {parseScalar, scalarText} from '../core/layers/field_values';
import {kMagnitude} from '../core/picture/field_scale';
import type {Assembler} from '../core/decode/assembler';
import type {FieldInfo} from '../core/protocol/fields';
import {kFull} from '../core/protocol/limit';
import {
  instantKey,
  instantName,
  instantsOf,
  markSeries,
  openingTime,
  shownInstant,
  showTime,
  timesOf,
} from '../core/protocol/series';
import {RequestedPart} from '../core/session/requested_part';
import {keyToAsk, keyToBegin} from '../viewer/stream_control';

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

  test('hasItsInstantsInTheOrderOfTime', () => {
    expect(instantsOf(fields, 'T')).toEqual([0, 2, 1]);
  });

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

  test('hasTheUsualRangeBesideOutlyingInstants', () => {
    const alike = (...highs: number[]): (number | undefined)[] =>
      marked(...highs.map((high, i) => field(`T@${i}`, high))).map(
        ({instant}) => instant!.alike?.range[1],
      );
    expect(alike(2, 3, 5, 8)).toEqual([undefined, undefined, undefined, undefined]);
    expect(alike(2, 3, 2, 3e6)).toEqual([3, 3, 3, 3e6]);
    expect(alike(1, 1, 4)).toEqual([undefined, undefined, undefined]);
    expect(alike(1, 1, 4.1)).toEqual([1, 1, 4.1]);
    expect(alike(0, 0, 1)).toEqual([undefined, undefined, undefined]);
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

  test('withoutATimeMeansItsInstantOfTheLowestNumber', () => {
    const later = marked(field('p'), field('T@2'), field('v@2'), field('T@0'), field('v@0'));
    showTime(later, 0);
    expect(parseScalar('T', later)?.field).toBe(3);
    showTime(later, null);
    expect(parseScalar('T', later)?.field).toBe(1);
    expect([1, 0].map((its) => openingTime(later, its)?.text)).toEqual(['2', '2']);
    expect(openingTime([field('p')], 0)).toBe(null);
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

describe('a time', () => {
  test('isADecimalNumberThatADoubleHolds', () => {
    for (const [text, time] of [
      ['-1.5e+2', -150],
      ['.5', 0.5],
      ['5.', 5],
      ['0e999', 0],
      ['1e-310', 1e-310],
    ] as const)
      expect(instantName(`T@${text}`)).toEqual({series: 'T', time, text});
    for (const text of ['', '+1', ' 1', '1 ', '0x1', 'inf', 'nan', '1e', '.', '1e999', '1e-999'])
      expect(instantName(`T@${text}`)).toBe(null);
  });

  test('isBehindANameAndItsLastAt', () => {
    expect(instantName('@3')).toBe(null);
    expect(instantName('a@b@3')?.series).toBe('a@b');
    expect(marked(field('@3', 1, 'cell'), field('@4', 1, 'cell'))[0]!.instant).toBe(undefined);
  });
});

describe('instants', () => {
  const vectors = (name: string, association: 'point' | 'cell' = 'point'): FieldInfo => ({
    ...field(name, 1, association),
    components: 2,
    minimum: [-1, 0],
    bits: 3,
  });
  const seriesOf = (...fields: FieldInfo[]): unknown[] =>
    marked(...fields).map(({instant}) => instant?.series);

  test('ofOneTimeAreOneAndTheSecondIsAFieldOfItsOwn', () => {
    expect(seriesOf(field('T@0'), field('T@0.0'))).toEqual([undefined, undefined]);
    expect(seriesOf(field('T@0'), field('T@-0.0'), field('T@1'))).toEqual(['T', undefined, 'T']);
  });

  test('agreeInComponentsAndType', () => {
    expect(seriesOf(field('T@0'), vectors('T@1'))).toEqual([undefined, undefined]);
    expect(seriesOf({...field('T@0'), type: 0}, {...field('T@1'), type: 1})).toEqual([
      undefined,
      undefined,
    ]);
  });

  test('haveAKeyThatNothingElseHas', () => {
    const fields = marked(
      field('T'),
      field('T@0'),
      field('T@1'),
      vectors('T@2'),
      vectors('T@3'),
      field('S@2', 1, 'cell'),
      field('S@3', 1, 'cell'),
      field('S@0'),
      field('S@1'),
    );
    expect(fields.map(({instant}) => instant?.series)).toEqual([
      undefined,
      ...['T@0', 'T@0', 'T@2', 'T@2', 'cell:S', 'cell:S', 'S', 'S'],
    ]);
    showTime(fields, 9);
    expect(parseScalar('T', fields)?.field).toBe(0);
    for (const [text, shown] of [
      ['T@0', 2],
      ['T@2.y', 4],
      ['cell:S', 6],
      ['S', 8],
    ] as const) {
      const scalar = parseScalar(text, fields)!;
      expect(scalar.field).toBe(shown);
      expect(scalarText(scalar, fields)).toBe(text);
    }
  });

  test('keepTheComponent', () => {
    const fields = marked(
      vectors('V@0'),
      vectors('V@1'),
      vectors('V@0', 'cell'),
      vectors('V@1', 'cell'),
    );
    showTime(fields, 1);
    expect(parseScalar('V[0]', fields)).toEqual({field: 1, component: 0});
    expect(parseScalar('point:V[0]', fields)).toEqual({field: 1, component: 0});
    expect(parseScalar('cell:V[1]', fields)).toEqual({field: 3, component: 1});
    expect(parseScalar('cell:W[1]', fields)).toBe(null);
    const ofCells = marked(vectors('V@0', 'cell'), vectors('V@1', 'cell'));
    expect(parseScalar('cell:V[1]', ofCells)).toEqual({field: 0, component: 1});
    expect(parseScalar('point:V[1]', ofCells)).toBe(null);
  });

  test('haveTheValuesOfTheirComponentsTogether', () => {
    const fields = marked(vectors('V@0'), {...vectors('V@1'), minimum: [-4, 2], step: 2});
    expect(fields[0]!.instant!.ranges).toEqual([
      [-4, 10],
      [0, 16],
    ]);
    expect(fields[1]!.instant!.own.ranges[1]).toEqual([2, 16]);
  });
});

test('aListThatNamesASeriesOnceLeavesItsInstantsToTheHead', () => {
  const listed = {fields: ['T', 'p'], series: ['T'], firstField: 'T@0.5'};
  expect(keyToBegin(listed, null)).toBe('T@0.5');
  expect(keyToBegin(listed, 2)).toBe('T');
  expect(keyToBegin({fields: ['T@0', 'T@0.5'], series: [], firstField: 'T@0.5'}, 0)).toBe('T@0');
  expect(keyToBegin({fields: ['T@0', 'T@0.5'], series: [], firstField: 'T@0.5'}, null)).toBe(
    'T@0.5',
  );
  expect(keyToBegin({fields: ['p'], series: [], firstField: 'p'}, 2)).toBe('p');
  expect(keyToAsk('T[1]', listed.fields, 2)).toBe('T');
});

test('noSeriesIsAskedForBeforeTheHeadSaysWhichInstantsItHas', () => {
  const requested = new RequestedPart({manifest: null} as unknown as Assembler);
  const address = {mesh: 'fin', url: '', log: '', transport: 'auto' as const};
  const source = {...address, fields: ['T'], limit: kFull};
  requested.begin(source);
  expect([requested.needsHead, requested.keys]).toEqual([false, ['T']]);
  requested.begin({...source, hasSeries: true});
  expect([requested.needsHead, requested.keys]).toEqual([true, []]);
});

test('theInstantNearestToTheTimeIsAskedFor', () => {
  const keys = ['T@0', 'T@0.5', 'T@1', 'cell:T@0', 'cell:T@1', 'V@0', 'V@1', 'p', 'q[0]'];
  expect(instantKey(keys, 'T', 0.25)).toBe('T@0');
  expect(instantKey(keys, 'p', 0)).toBe(undefined);
  expect(keyToAsk('T', keys, null)).toBe('T@0');
  expect(keyToAsk('cell:T', keys, 0.9)).toBe('cell:T@1');
  expect(keyToAsk('V[1]', keys, 0.9)).toBe('V@1');
  expect(keyToAsk('T@0.5', keys, 0.9)).toBe('T@0.5');
  expect(keyToAsk('q[0]', keys, 0)).toBe('q[0]');
  expect(keyToAsk('p[2]', keys, 0)).toBe('p');
  expect(keyToAsk('lost', keys, 0)).toBe('lost');
});
