import {readdir, readFile} from 'node:fs/promises';
import {expect, test} from 'vitest';
import {errorCode, errorText} from '../core/protocol/errors';
import {
  isSegmentList,
  kMaxListBytes,
  kMaxSegments,
  listedInstant,
  readSegmentList,
} from '../core/protocol/segment_list';

const kGolden = new URL('../../tests/golden/lists/', import.meta.url);
const listOf = (segments: unknown): unknown => ({qtet: 'series', segments});
const kTwo = listOf([
  {log: 'flow.0.qtet', times: [0, 0.25, 0.5]},
  {log: 'flow.1.qtet', times: [1, 3]},
]);

function refusal(value: unknown, sizeBytes = 100, code = 'bad-value'): string {
  try {
    readSegmentList(value, sizeBytes);
  } catch (thrown) {
    expect(errorCode(thrown)).toBe(code);
    return errorText(thrown);
  }
  return '';
}

test('theGoldenListsAreValidOrRefused', async () => {
  for (const name of await readdir(new URL('valid/', kGolden)))
    expect(await refusalOfFile(`valid/${name}`), name).toBe('');
  for (const name of await readdir(new URL('must-fail/', kGolden)))
    expect(await refusalOfFile(`must-fail/${name}`), name).not.toBe('');
});

async function refusalOfFile(name: string): Promise<string> {
  const text = await readFile(new URL(name, kGolden), 'utf8');
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return 'no JSON';
  }
  return isSegmentList(value) ? refusal(value, text.length) : 'no list';
}

test('aListHasItsLogsAndTheInstantsOfAll', () => {
  const {logs, instants} = readSegmentList(kTwo, 100);
  expect(logs).toEqual(['flow.0.qtet', 'flow.1.qtet']);
  expect(instants.map(({time}) => time)).toEqual([0, 0.25, 0.5, 1, 3]);
  expect(instants.map(({text}) => text)).toEqual(['0', '0.25', '0.5', '1', '3']);
  expect(instants.map(({segment}) => segment)).toEqual([0, 0, 0, 1, 1]);
});

test('onlyAMarkedObjectIsAList', () => {
  expect(isSegmentList(kTwo)).toBe(true);
  for (const other of [null, [], 'series', {}, {qtet: 'log'}, {meshes: []}])
    expect(isSegmentList(other), JSON.stringify(other)).toBe(false);
});

test('unknownMembersAreIgnored', () => {
  const segment = {log: 'a.qtet', times: [-1e3], cells: 7};
  expect(readSegmentList({qtet: 'series', version: 9, segments: [segment]}, 100).logs).toEqual([
    'a.qtet',
  ]);
});

test('aRefusalNamesThePlaceTheValueAndTheWayOut', () => {
  const cases: [unknown, string][] = [
    [undefined, '"segments" is no array'],
    [{}, '"segments" is no array'],
    [[], 'at least one segment'],
    [[7], 'segments[0] is no object'],
    [[null], 'segments[0] is no object'],
    [[{times: [0]}], 'segments[0].log is undefined'],
    [[{log: 'a.qtet'}], 'segments[0].times is no array'],
    [[{log: 'a.qtet', times: []}], 'segments[0].times is no array of at least one'],
    [[{log: 'a.qtet', times: ['0']}], 'segments[0].times[0] is "0"'],
    [[{log: 'a.qtet', times: [0, null]}], 'segments[0].times[1] is null'],
    [[{log: 'a.qtet', times: [JSON.parse('1e999')]}], 'no finite number'],
    [[{log: 'a.qtet', times: [1, 1]}], 'segments[0].times[1] is 1, but the time before it is 1'],
    [
      [
        {log: 'a.qtet', times: [0, 2]},
        {log: 'b.qtet', times: [1]},
      ],
      'segments[1].times[0] is 1, but the time before it is 2',
    ],
  ];
  for (const [segments, text] of cases) {
    const said = refusal(listOf(segments));
    expect(said).toContain(text);
    expect(said).toMatch(/Correct the list, or make it again\.$/);
  }
});

test('aLogIsANameBesideTheList', () => {
  for (const log of ['a/b.qtet', '../b.qtet', 'a\\b.qtet', 'a..b.qtet', 'a.vtu', '.qtet', '', 7])
    expect(refusal(listOf([{log, times: [0]}])), String(log)).toContain('segments[0].log');
  for (const log of ['\ud800.qtet', 'a\0.qtet', `${'ä'.repeat(126)}.qtet`])
    expect(refusal(listOf([{log, times: [0]}])), log).toContain('segments[0].log');
  for (const log of [`${'ä'.repeat(125)}a.qtet`, '\ud83d\ude00.qtet'])
    expect(refusal(listOf([{log, times: [0]}])), log).toBe('');
  for (const log of ['a b.qtet', 'flow#1?.qtet', '%41.qtet', 'http:x.qtet'])
    expect(refusal(listOf([{log, times: [0]}])), log).toBe('');
});

test('limitsHoldToTheSegmentAndToTheByte', () => {
  const many = (count: number): unknown =>
    listOf(Array.from({length: count}, (_, i) => ({log: `${i}.qtet`, times: [i]})));
  expect(refusal(many(kMaxSegments - 1))).toBe('');
  expect(refusal(many(kMaxSegments))).toBe('');
  expect(refusal(many(kMaxSegments + 1), 100, 'limit-exceeded')).toContain(
    '1025 segments, more than 1024',
  );
  expect(refusal(kTwo, kMaxListBytes)).toBe('');
  expect(refusal(kTwo, kMaxListBytes + 1, 'limit-exceeded')).toContain(
    '4194305 bytes, more than 4194304',
  );
});

test('theNearestInstantDecidesTheSegmentAndTheEarlierOfTwo', () => {
  const list = readSegmentList(kTwo, 100);
  const at = (time: number | null): [number, number] => {
    const instant = listedInstant(list, time);
    return [instant.time, instant.segment];
  };
  expect(at(null)).toEqual([0, 0]);
  expect(at(-5)).toEqual([0, 0]);
  expect(at(0.5)).toEqual([0.5, 0]);
  expect(at(0.7)).toEqual([0.5, 0]);
  expect(at(0.75)).toEqual([0.5, 0]);
  expect(at(0.7500001)).toEqual([1, 1]);
  expect(at(1)).toEqual([1, 1]);
  expect(at(2)).toEqual([1, 1]);
  expect(at(99)).toEqual([3, 1]);
});
