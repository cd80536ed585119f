import {describe, expect, test} from 'vitest';
import {kMagnitude} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import {labelTicks, logTicks} from '../core/picture/ticks';
import {kOpacityPath} from '../core/picture/transfer';
import {
  fieldValuesText,
  parseFieldValues,
  parseScalar,
  scalarText,
  sharesOf,
} from '../core/layers/field_values';
import {parseClip} from '../core/layers/clip';
import {clipText} from '../core/layers/clip_text';
import {kLayerRules} from '../core/layers/layer_rules';
import {firstOpacities} from '../core/layers/volume';
import {markSeries} from '../core/protocol/series';
import type {Manifest} from '../core/protocol/manifest';
import type {Snapshot} from '../core/session/worker_messages';
import {rangeOf} from '../viewer/page/shown_mesh';
import {labelRange, readSettings, shownRange, type Settings} from '../viewer/settings/settings';

const field = (
  name: string,
  components: number,
  association: 'point' | 'cell' = 'point',
): FieldInfo => ({
  name,
  components,
  association,
  step: 1,
  minimum: Array<number>(components).fill(0),
  range: [0, 10],
});
const fields = [field('p', 1), field('U', 3), field('p', 1, 'cell'), field('odd[1]', 1)];

describe('clip planes', () => {
  test.each<[string, string]>([
    ['x', 'x:0.5'],
    ['-y:0.3', '-y:0.3'],
    ['x:0.2 z:1 -y', 'x:0.2 z:1 -y:0.5'],
    ['3,0,4:0.25', '0.6,0,0.8:0.25'],
  ])('%s comeBackAs %s', (text, back) => expect(clipText(parseClip(text), true)).toBe(back));
  test('areNone', () => {
    expect(clipText([], false)).toBeNull();
    expect(clipText([], true)).toBe('none');
    expect(parseClip('none')).toEqual([]);
    expect(kLayerRules.clip[0]('none')).toBe(true);
  });
  test.each(['', 'w', 'x:', 'x:2', '0,0,0:0.5', '1,2:0.5'])('%s isNone', (text) =>
    expect(parseClip(text)).toEqual([]),
  );
  test('areAtMostThree', () => expect(parseClip('x y z x')).toHaveLength(3));
  test('cutAwayTheSideOfTheFirstCamera', () =>
    expect(parseClip('y')[0]!.normal).toEqual([0, -1, 0]));
});

describe('fields', () => {
  test.each<[string, number, number]>([
    ['p', 0, kMagnitude],
    ['U', 1, kMagnitude],
    ['U.z', 1, 2],
    ['cell:p', 2, kMagnitude],
    ['odd[1]', 3, kMagnitude],
  ])('%s isReadAndWritten', (text, index, component) => {
    expect(parseScalar(text, fields)).toEqual({field: index, component});
    expect(scalarText({field: index, component}, fields)).toBe(text);
  });
  test('aComponentHasItsNumberToo', () =>
    expect(parseScalar('U[2]', fields)).toEqual({field: 1, component: 2}));
  test.each(['q', 'q[0]', 'U.xx', ''])('%s isUnknown', (text) =>
    expect(parseScalar(text, fields)).toBeNull(),
  );
  test('aComponentThatIsNotThereIsTheMagnitude', () =>
    expect(parseScalar('U[7]', fields)).toEqual({field: 1, component: kMagnitude}));
  test('withValuesAreReadWrittenAndScaled', () => {
    const values = parseFieldValues('U[0]=5, -10', fields)!;
    expect(values).toEqual({scalar: {field: 1, component: 0}, values: [5, -10]});
    expect(fieldValuesText(values, fields)).toBe('U.x=5,-10');
    expect(sharesOf(values, fields)).toEqual([0.75, 0]);
    expect([
      parseFieldValues('p', fields),
      parseFieldValues('p=', fields),
      parseFieldValues('p=a', fields),
      parseFieldValues('q=1', fields),
    ]).toEqual([null, null, null, null]);
  });
});

describe('settings', () => {
  const of = (attributes: Record<string, string>): Settings =>
    readSettings((name) => attributes[name] ?? null);
  test('withoutAttributesAreThePlainOnes', () => {
    expect(of({})).toEqual({
      title: null,
      map: 'viridis',
      reversed: false,
      beyond: [null, null],
      range: 'auto',
      logarithmic: false,
      edges: true,
      creases: true,
      surface: true,
      opacity: 1,
      lines: '',
      planes: [],
      hasFirstCut: false,
      mode: 'cut',
      limit: {kind: 'full'},
      parallel: false,
      camera: null,
      warp: null,
      warpScale: null,
      restEdges: false,
      axes: false,
      ground: null,
      lengthUnit: null,
      time: null,
      timePart: null,
      timeLoops: true,
      volume: null,
      hasFirstOpacities: false,
    });
  });
  test('aGroundIsANameOrAColourOfSixDigits', () => {
    for (const right of ['light', 'dark', 'white', '3c3c3c'])
      expect(of({ground: right}).ground).toBe(right);
    for (const wrong of ['#3c3c3c', '3c3c3', '3c3c3c3', 'toString', ''])
      expect(of({ground: wrong}).ground).toBeNull();
  });
  test('aUnitOfLengthHasSixteenLetters', () => {
    expect(of({'length-unit': 'm'.repeat(16)}).lengthUnit).toBe('m'.repeat(16));
    expect(of({'length-unit': 'm'.repeat(17)}).lengthUnit).toBe('m'.repeat(16));
    expect(of({'length-unit': ' '}).lengthUnit).toBeNull();
  });
  test('aVolumeIsOpacitiesOrTheFirstOnesAndNothingElse', () => {
    expect(of({volume: '0,0.5,1'}).volume).toEqual([0, 0.5, 1]);
    for (const text of ['auto', '']) {
      expect(of({volume: text}).volume).toHaveLength(9);
      expect(of({volume: text}).hasFirstOpacities).toBe(true);
    }
    for (const wrong of ['x', 'on', '0.5', '0,2']) {
      expect(of({volume: wrong}).volume).toBeNull();
      expect(of({volume: wrong}).hasFirstOpacities).toBe(false);
    }
  });
  test('aVolumesFirstOpacitiesAreDenserTheThinnerTheMesh', () => {
    const mean = (chord: number): number => {
      const depths = firstOpacities(chord).map((opacity) => -Math.log(1 - opacity) / kOpacityPath);
      return (chord * depths.reduce((sum, depth) => sum + depth, 0)) / depths.length;
    };
    for (const chord of [0.15, 0.3, 0.5]) expect(mean(chord)).toBeCloseTo(1.7, 1);
    expect(Math.max(...firstOpacities(0.001))).toBe(0.99);
  });
  test('aVolumesFirstOpacitiesCountWhatFillsIt', () => {
    // nine tenths of the volume have the lowest values, and one tenth the highest
    const shares = [0.9, 0, 0, 0, 0, 0, 0, 0, 0.1];
    const placeOf = (share: number): number => (9 * share - 0.5) / 8;
    const opacities = firstOpacities(0.3, {shares, placeOf});
    const depths = opacities.map((opacity) => -Math.log(1 - opacity) / kOpacityPath);
    expect(0.3 * (0.9 * depths[0]! + 0.1 * depths[8]!)).toBeCloseTo(1.7, 1);
    expect(depths[8]! / depths[0]!).toBeCloseTo(3, 1);
    // Values beyond the ends of the shown range count for the ends.
    expect(firstOpacities(0.3, {shares: [0.9, 0.1], placeOf: (share) => 9 * share - 4})).toEqual(
      opacities,
    );
    expect(firstOpacities(0.3, {shares: [0, 0], placeOf})).toEqual(firstOpacities(0.3));
  });
  test('areReadFromTheirAttributes', () => {
    expect(
      of({
        colormap: 'turbo reversed',
        range: '1,5',
        scale: 'log',
        edges: 'off',
        creases: 'off',
        surface: 'off',
        opacity: '0.4',
        'rest-edges': 'on',
        'clip-mode': 'cells',
        quality: '1%',
        projection: 'parallel',
        camera: '1,2,3,0,0,0',
      }),
    ).toMatchObject({
      map: 'turbo',
      reversed: true,
      range: [1, 5],
      logarithmic: true,
      edges: false,
      creases: false,
      restEdges: true,
      surface: false,
      opacity: 0.4,
      mode: 'cells',
      limit: {kind: 'error', value: 0.01},
      parallel: true,
      camera: [1, 2, 3, 0, 0, 0],
    });
  });
  test('thatMakeNoSenseAreThePlainOnes', () => {
    expect(
      of({
        colormap: 'jet',
        range: '5,1',
        opacity: '7',
        'clip-mode': 'x',
        quality: 'much',
        camera: '1,2',
      }),
    ).toEqual(of({}));
  });
});

describe('the range of the colours', () => {
  const range = (
    settings: Partial<Settings>,
    extent: [number, number],
  ): ReturnType<typeof shownRange> =>
    shownRange({...readSettings(() => null), ...settings}, extent);
  const linear = {logarithmic: false, hides: 'none'};
  test('isWhatOccursOrSymmetricOrFixed', () => {
    expect(range({}, [-1, 4])).toEqual({low: -1, high: 4, ...linear});
    expect(range({range: 'symmetric'}, [-1, 4])).toEqual({low: -4, high: 4, ...linear});
    expect(range({range: [2, 3]}, [-1, 4])).toEqual({low: 2, high: 3, ...linear});
  });
  test('isThatOfTheInstantOnRequest', () => {
    const infos = [field('T@0', 1), field('T@1', 1), field('T@2', 1), field('p', 1)];
    infos[1]!.range = [3, 5];
    infos[2]!.range = [4, 4];
    markSeries(infos);
    const [low, high] = infos[0]!.range;
    const ofField = (index: number): ReturnType<typeof rangeOf> => {
      const color = {field: index, component: kMagnitude};
      const snapshot = {color, scaleRange: infos[index]!.range, extent: [0, 1], middle: [0, 1]};
      const settings = readSettings((name) => (name === 'range' ? 'instant' : null));
      return rangeOf(snapshot as unknown as Snapshot, {fields: infos} as Manifest, settings);
    };
    expect(ofField(1)).toEqual({low: 3, high: 5, ...linear});
    expect(ofField(2)).toEqual({low, high, ...linear});
    expect(ofField(3)).toEqual({low: infos[3]!.range[0], high: infos[3]!.range[1], ...linear});
  });
  test('isLogarithmicOnBothSidesOfZeroAndTellsWhatItHides', () => {
    const of = (low: number, high: number): ReturnType<typeof shownRange> =>
      range({logarithmic: true}, [low, high]);
    expect(of(1, 100)).toEqual({low: 1, high: 100, logarithmic: true, hides: 'none'});
    expect(of(0, 100)).toEqual({low: 0.01, high: 100, logarithmic: true, hides: 'low'});
    expect(of(-1, 100)).toEqual({low: -1, high: 100, logarithmic: true, hides: 'none'});
    expect(of(-5, -1)).toEqual({low: -5, high: -1, logarithmic: true, hides: 'none'});
    expect(of(0, 0)).toEqual({low: 0, high: 0, logarithmic: false, hides: 'all'});
  });
});

describe('an automatic range', () => {
  const auto = (
    middle: [number, number],
    settings: Partial<Settings> = {},
  ): ReturnType<typeof shownRange> =>
    shownRange({...readSettings(() => null), ...settings}, [0, 100], middle);
  test('leavesTheTailsOutIfTheyWouldHideTheRest', () => {
    expect(auto([10, 20])).toMatchObject({low: 10, high: 20, openEnds: [true, true]});
    expect(auto([10, 79])).toMatchObject({low: 10, high: 79, openEnds: [true, true]});
    expect(auto([10, 80])).toMatchObject({low: 0, high: 100});
    expect(auto([5, 5])).toMatchObject({low: 0, high: 100});
  });
  test('isOpenWhereValuesLieBeyond', () => {
    expect(auto([0.09, 50])).toMatchObject({low: 0, high: 50, openEnds: [false, true]});
    expect(auto([50, 99.91])).toMatchObject({low: 50, high: 100, openEnds: [true, false]});
    expect(auto([10, 80]).openEnds).toBeUndefined();
  });
  test('isWholeIfThatIsAskedFor', () => {
    expect(auto([10, 20], {range: 'full'})).toMatchObject({low: 0, high: 100});
    expect(auto([10, 20], {logarithmic: true}).high).toBe(100);
  });
  test('ofLabelsHasEachInTheMiddleOfItsColour', () => {
    expect(labelRange([3, 4])).toMatchObject({low: 2.5, high: 39.5, labels: 4});
    expect(labelTicks(3, 4, 20).ticks.map(({at, label}) => [at, label])).toEqual([
      [0.125, '3'],
      [0.375, '4'],
      [0.625, '5'],
      [0.875, '6'],
    ]);
  });
});

describe('logarithmic ticks', () => {
  test.each<[number, number, string[]]>([
    [1, 100, ['1', '2', '5', '10', '20', '50', '100']],
    [1e-6, 1e6, ['10⁻⁶', '10⁻⁴', '0.01', '1', '100', '10000', '10⁶']],
    [3, 4, ['3.0', '3.2', '3.4', '3.6', '3.8', '4.0']],
    [-10, 1000, ['−10', '−1', '0', '1', '10', '100', '1000']],
    [-1000, -10, ['−1000', '−100', '−10']],
  ])('from %d to %d', (low, high, labels) => {
    const {ticks} = logTicks(low, high, 7);
    expect(ticks.map(({label}) => label)).toEqual(labels);
    for (const {at} of ticks) expect(at >= 0 && at <= 1).toBe(true);
  });
});
