// Labels: read from a manifest, coloured, listed and named.

import {describe, expect, test} from 'vitest';
import {colorTable, kLabelColors, labelColors, labelGradient} from '../core/picture/color_maps';
import {FieldScale} from '../core/picture/field_scale';
import {LabelScale, labelColorOf, labelsOf, shownLabels} from '../core/picture/labels';
import type {FieldInfo} from '../core/protocol/fields';
import {addLater, readManifest, type Manifest} from '../core/protocol/manifest';
import type {LineValues} from '../core/session/inspector';
import {formatIn} from '../viewer/page/format';
import {tableOf} from '../viewer/panels/line_table';
import {labelName} from '../viewer/panels/panel';
import {fakeHead} from './fakes';

const text = (value: string): number[] => {
  const bytes = new TextEncoder().encode(value);
  return [bytes.length, ...bytes];
};
const name = (value: number, what: string): number[] => [
  ...new Uint8Array(Int32Array.of(value).buffer),
  ...text(what),
];
const columns = (): Uint32Array => Uint32Array.from([5, 4, 3]);

describe('the labels of a manifest', () => {
  const kInt32 = 4,
    kLabelsFollow = 16;
  const kFieldsAt = 64 + 5 + 9 + 4 * 8,
    kBehindName = 2 + 4 * 8;

  /** Fields p (points) and `cells`, and so many labels as `bytes` has. */
  function headWith(bytes: number[], {type = kInt32, cells = ['a', 'b@0']} = {}): Uint8Array {
    const head = fakeHead({fields: ['p'], cellFields: cells, chunks: 1});
    const tableAt = 64 + new DataView(head.buffer).getUint32(24, true);
    let at = kFieldsAt;
    for (const its of ['p', ...cells]) {
      at += text(its).length;
      head[at] = type;
      at += kBehindName;
    }
    head[tableAt - 1] = kLabelsFollow;
    const whole = Uint8Array.from([
      ...head.subarray(0, tableAt),
      ...bytes,
      ...head.subarray(tableAt),
    ]);
    const view = new DataView(whole.buffer);
    view.setUint32(24, tableAt - 64 + bytes.length, true);
    return whole;
  }
  const read = (...words: Parameters<typeof headWith>): Manifest =>
    readManifest(headWith(...words), columns);
  const kNames = [...name(-7, 'air'), ...name(1, 'steel'), ...name(4, '\u00f6l')];

  test('haveNamesByValue', () => {
    const {fields} = read([2, ...text('a'), 3, ...kNames, ...text('b'), 0]);
    expect(fields.map(({labels}) => labels && [...labels])).toEqual([
      undefined,
      [
        [-7, 'air'],
        [1, 'steel'],
        [4, '\u00f6l'],
      ],
      [],
    ]);
  });

  test('belongToLaterInstantsToo', () => {
    const plain = headWith([1, ...text('b'), 1, ...name(2, 'oil')]);
    const tableAt = 64 + new DataView(plain.buffer).getUint32(24, true);
    const series = Uint8Array.from([
      ...plain.subarray(0, tableAt),
      ...[1, 0, 0, 0, 0],
      ...plain.subarray(tableAt + 1),
    ]);
    const view = new DataView(series.buffer);
    view.setUint32(44, 4, true);
    const manifest = readManifest(series, columns);
    const field = [
      ...text('b@1'),
      kInt32,
      8,
      ...new Uint8Array(Float64Array.of(1, 0, 0, 255).buffer),
    ];
    addLater(manifest, Uint8Array.from([1, 1, field.length, ...field]), columns);
    expect(manifest.fields[3]!.labels).toEqual(new Map([[2, 'oil']]));
    expect(manifest.fields[3]!.labels).toBe(manifest.fields[2]!.labels);
  });

  const many = (count: number): number[] => [
    1,
    ...text('a'),
    128 + (count % 128),
    Math.floor(count / 128),
    ...Array.from({length: count}, (_, i) => name(i, 'x')).flat(),
  ];
  test('mayBe4096', () => {
    expect(read(many(4096)).fields[1]!.labels!.size).toBe(4096);
    expect(() => read(many(4097))).toThrow('names of a label');
  });

  test.each<[string, number[], string]>([
    ['of a field without a name', [1, ...text(''), 0], 'in no order'],
    ['there twice', [2, ...text('a'), 0, ...text('a'), 0], 'in no order'],
    ['in no order', [2, ...text('b'), 0, ...text('a'), 0], 'in no order'],
    ['without a name', [1, ...text('a'), 1, ...name(1, '')], 'empty'],
    ['with values in no order', [1, ...text('a'), 2, ...name(1, 'x'), ...name(-1, 'y')], 'order'],
    ['with a value twice', [1, ...text('a'), 2, ...name(1, 'x'), ...name(1, 'y')], 'order'],
    ['cut off', [1, ...text('a'), 9], 'ends too early'],
  ])('%s areRefused', (_, bytes, message) => {
    expect(() => read(bytes)).toThrow(message);
  });

  test('areInTheOrderOfTheirBytes', () => {
    const cells = ['\uff01', '\u{1f600}']; // UTF-16 has them in the other order
    const labels = cells.flatMap((cell) => [...text(cell), 0]);
    expect([...read([2, ...labels], {cells}).labels!.keys()]).toEqual(cells);
    const turned = [...cells].reverse().flatMap((cell) => [...text(cell), 0]);
    expect(() => read([2, ...turned], {cells})).toThrow('in no order');
  });

  test('meanNothingOfOtherFields', () => {
    for (const other of ['c', 'p', 'b@0'])
      expect(read([1, ...text(other), 0]).fields.some(({labels}) => labels)).toBe(false);
    expect(read([1, ...text('a'), 0], {type: 0}).fields[1]!.labels).toBe(undefined);
  });
});

const kNames = new Map([[3, 'steel']]);
const kLabel: FieldInfo = {
  name: 'MaterialIds',
  components: 1,
  association: 'cell',
  isWhole: true,
  step: 1,
  minimum: [-2],
  range: [-2, 1e9],
  labels: kNames,
};

describe('the colours of labels', () => {
  test('followTheNumbersAndRepeat', () => {
    expect(labelsOf(kLabel)).toEqual([0, kLabelColors]);
    expect([-1, 0, 36, 37, 3700].map(labelColorOf)).toEqual([36, 0, 36, 0, 0]);
    expect(new Set([100, 200, 300, 1000, 2000].map(labelColorOf)).size).toBe(5);
    const integers = Int32Array.of(0, 2, 1e9, 1e9 + 1);
    const scale = new LabelScale(integers, kLabel);
    const colors = [...integers].map((_, i) => scale.at(i) * (kLabelColors - 1));
    expect(colors.map(Math.round)).toEqual([-2, 0, 1e9 - 2, 1e9 - 1].map(labelColorOf));
    expect(new LabelScale(Int32Array.of(-(2 ** 31)), kLabel).at(0)).toBeNaN();
  });

  test.each([false, true])('areThoseOfTheMap (reversed %s)', (reversed) => {
    const table = colorTable('labels', reversed);
    const colors = labelColors(reversed);
    colors.forEach((color, i) => {
      const place = ((i + 0.5) / kLabelColors) * 255;
      for (const entry of [Math.floor(place), Math.ceil(place)])
        expect([...table.subarray(4 * entry, 4 * entry + 3)], `label ${i}`).toEqual(color);
    });
    expect(new Set(colors.map(String)).size).toBe(kLabelColors);
    expect(labelGradient(1, reversed)).toContain(`rgb(${colors[0]!.join(' ')})`);
  });
});

test('theLabelsOfAMeshAreListedOnceAndTheFirstOnesByValue', () => {
  const integers = Int32Array.from({length: 40}, (_, i) => 19 - (i >> 1));
  const tetrahedra = Uint32Array.from({length: 160}, (_, i) => i % 4);
  tetrahedra.fill(0, 4 * 38); // holes: the cells of the least label
  expect(shownLabels(new FieldScale(integers, kLabel), tetrahedra, kLabel)).toEqual({
    values: Array.from({length: 12}, (_, i) => i - 1),
    count: 19,
  });
});

test('aValueHasItsName', async () => {
  expect([3, 4, NaN].map((value) => formatIn(kLabel, value))).toEqual([
    'steel (3)',
    '4',
    'missing',
  ]);
  const places: LineValues[] = [3, 4].map((value) => ({
    at: value,
    position: [0, 0, 0],
    fields: [
      {field: 0, values: [value]},
      {field: 1, values: [7]},
    ],
  }));
  const unnamed = {...kLabel, name: 'part', labels: new Map<number, string>()};
  expect((await tableOf(places, [kLabel, unnamed]).text()).split('\r\n')).toEqual([
    '"distance","x","y","z","MaterialIds","MaterialIds, name","part"',
    '3,0,0,0,3,"steel",7',
    '4,0,0,0,4,,7',
  ]);
});

test('theErrorOfALabelIsAShareOfTheVolume', () => {
  const plain: FieldInfo = {...kLabel, name: 'p'};
  delete plain.labels;
  expect(labelName([0], [kLabel, plain])).toBe('MaterialIds');
  expect(labelName([1], [kLabel, plain])).toBeNull();
  expect(labelName([], [kLabel])).toBeNull();
});
