import {expect, test} from 'vitest';
import type {LineValues} from '../core/session/inspector';
import type {FieldInfo} from '../core/protocol/fields';
import {markSeries} from '../core/protocol/series';
import {tableOf, timeTableOf} from '../viewer/panels/line_table';

const info = (name: string, components: number): FieldInfo => ({
  name,
  components,
  association: 'point',
  step: 1,
  minimum: [],
  range: [0, 1],
});
const kFields = [info('p', 1), info('absent', 1), info('a "b"', 2)];

test('eachRowIsAPlaceWithAllFieldsThatAreHere', async () => {
  const places: LineValues[] = [
    {
      at: 0,
      position: [1, 2, 3],
      fields: [
        {field: 0, values: [0.1 + 0.2]},
        {field: 2, values: [4, NaN]},
      ],
    },
    {at: 0.5, position: [1, 2, 3.5], fields: []},
  ];
  expect((await tableOf(places, kFields).text()).split('\r\n')).toEqual([
    '"distance","x","y","z","p","a ""b"", x","a ""b"", y"',
    '0,1,2,3,0.3,4,',
    '0.5,1,2,3.5,,,',
  ]);
});

test('eachRowOverTimeIsAnInstantWithItsComponents', async () => {
  const fields = ['u@0', 'u@0.5'].map((name) => ({...info(name, 2), minimum: [0, 0]}));
  markSeries(fields);
  const table = {field: 1, times: [0, 0.5], values: [[1, 2], []]};
  const inUnits = fields.map((its) => ({...its, unit: 'm/s'}));
  expect((await timeTableOf(table, inUnits, 'ms').text()).split('\r\n')[0]).toBe(
    '"time [ms]","u, x [m/s]","u, y [m/s]"',
  );
  expect((await timeTableOf(table, fields).text()).split('\r\n')).toEqual([
    '"time","u, x","u, y"',
    '0,1,2',
    '0.5,,',
  ]);
});

test('theLastColumnsSayWhereTheValuesComeFrom', async () => {
  const places: LineValues[] = [0, 1].map((at) => ({
    at,
    position: [1, 2, 3],
    fields: [{field: 0, values: [5]}],
  }));
  const same = [
    ['time [s]', 0.5],
    ['mesh', '=a'],
  ] as const;
  expect((await tableOf(places, kFields, same).text()).split('\r\n')).toEqual([
    '"distance","x","y","z","p","time [s]","mesh"',
    `0,1,2,3,5,0.5,"'=a"`,
    `1,1,2,3,5,0.5,"'=a"`,
  ]);
});

test('noNameIsAFormulaAndNumbersAreNumbers', async () => {
  for (const name of ['=1+1', '+a', '-a', '@a', '\ta', '\ra']) {
    const places = [{at: -1, position: [0, 0, 0], fields: [{field: 0, values: [-1.5]}]}];
    const text = await tableOf(places as LineValues[], [info(name, 1)]).text();
    expect(text).toBe(`"distance","x","y","z","'${name}"\r\n-1,0,0,0,-1.5`);
  }
});

test('aLineBesideTheMeshHasNoRows', async () => {
  expect(await tableOf([], kFields).text()).toBe('"distance","x","y","z"');
});
