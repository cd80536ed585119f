import {expect, test} from 'vitest';
import {parseBeyond} from '../core/picture/color_map_text';
import {
  colorGradient,
  colorTable,
  isColorMapName,
  kColorMapNames,
  type ColorMapName,
} from '../core/picture/color_maps';

const entry = (name: ColorMapName, i: number): number[] => [
  ...colorTable(name).subarray(4 * i, 4 * i + 3),
];

test('everyTableHas256OpaqueEntries', () => {
  for (const name of kColorMapNames) {
    const table = colorTable(name);
    expect(table).toHaveLength(1024);
    for (let i = 0; i < 256; ++i) expect(table[4 * i + 3]).toBe(255);
  }
});

test('theEndsAndMiddlesAreThePublishedColours', () => {
  expect([entry('viridis', 0), entry('viridis', 128), entry('viridis', 255)]).toEqual([
    [68, 1, 84],
    [33, 145, 140],
    [253, 231, 37],
  ]);
  expect([entry('cividis', 0), entry('cividis', 255)]).toEqual([
    [0, 34, 78],
    [254, 232, 56],
  ]);
  expect([entry('cool-warm', 0), entry('cool-warm', 128), entry('cool-warm', 255)]).toEqual([
    [59, 76, 192],
    [221, 220, 220],
    [180, 4, 38],
  ]);
});

test('neighbouringEntriesAreNearlyTheSame', () => {
  for (const name of kColorMapNames) {
    for (let i = 1; i < 256; ++i) {
      const before = entry(name, i - 1);
      for (const [c, value] of entry(name, i).entries())
        expect(Math.abs(value - before[c]!)).toBeLessThanOrEqual(name === 'turbo' ? 14 : 8);
    }
  }
});

test('viridisAndCividisGrowLighterAllTheWay', () => {
  const lightness = (rgb: number[]): number =>
    0.2126 * (rgb[0]! / 255) ** 2.2 +
    0.7152 * (rgb[1]! / 255) ** 2.2 +
    0.0722 * (rgb[2]! / 255) ** 2.2;
  for (const name of ['viridis', 'cividis'] as const) {
    for (let i = 8; i < 256; i += 8)
      expect(lightness(entry(name, i))).toBeGreaterThan(lightness(entry(name, i - 8)));
  }
});

test('gradientsRunFromTheFirstToTheLastEntry', () => {
  const gradient = colorGradient('viridis', false, 5);
  expect(gradient).toMatch(/^linear-gradient\(90deg, rgb\(68 1 84\), .*rgb\(253 231 37\)\)$/);
  expect(gradient.split('rgb(')).toHaveLength(6);
});

test('stepsHaveOneColourEachAndBothEndsOfTheMap', () => {
  const table = colorTable('grey/4');
  const reds = Array.from({length: 256}, (_, i) => table[4 * i]!);
  expect([...new Set(reds)]).toEqual([26, 96, 166, 236]);
  expect([reds[63], reds[64]]).toEqual([26, 96]);
  const turned = colorTable('grey/4', true);
  expect([turned[0], turned[4 * 255]]).toEqual([236, 26]);
  expect(colorGradient('grey/2')).toBe(
    'linear-gradient(90deg, rgb(26 26 26) 0%, rgb(26 26 26) 50%, ' +
      'rgb(236 236 236) 50%, rgb(236 236 236) 100%)',
  );
});

test('ownColoursAreMixedBetweenTheirShares', () => {
  const table = colorTable('custom:0=000000,0.5=ff0000,1=ffffff');
  const at = (i: number): number[] => [...table.subarray(4 * i, 4 * i + 3)];
  expect([at(0), at(51), at(255)]).toEqual([
    [0, 0, 0],
    [102, 0, 0],
    [255, 255, 255],
  ]);
});

test.each([
  ['viridis/8', true],
  ['viridis/1', false],
  ['viridis/64', true],
  ['viridis/65', false],
  ['viridis/8/8', false],
  ['labels/8', false],
  ['custom:0=000000,1=ffffff', true],
  ['custom:0=000000,1=ffffff/5', true],
  ['custom:0=000000', false],
  ['custom:0.5=000000,0.5=ffffff', false],
  ['custom:0=000000,1.1=ffffff', false],
  ['custom:0=000,1=ffffff', false],
  ['custom:=000000,1=ffffff', false],
  [`custom:${Array.from({length: 64}, (_, i) => `${i / 64}=000000`).join()}`, true],
  [`custom:${Array.from({length: 65}, (_, i) => `${i / 65}=000000`).join()}`, false],
])('ofTextsOnlyMapsAreTaken %s', (text, isRight) => {
  expect(isColorMapName(text)).toBe(isRight);
});

test('coloursBeyondTheRangeAreTwoOfWhichOneMayBeMissing', () => {
  expect(parseBeyond('ff0000,00ff00')).toEqual([
    [255, 0, 0],
    [0, 255, 0],
  ]);
  expect(parseBeyond(',0000ff')).toEqual([null, [0, 0, 255]]);
  for (const wrong of ['', ',', 'ff0000', 'red,', 'ff0000,00ff00,0000ff'])
    expect(parseBeyond(wrong)).toBeNull();
});

test('onlyKnownNamesAreNames', () => {
  expect(isColorMapName('cividis')).toBe(true);
  expect(isColorMapName('jet')).toBe(false);
  expect(isColorMapName(null)).toBe(false);
});
