import {expect, test} from 'vitest';
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

test('onlyKnownNamesAreNames', () => {
  expect(isColorMapName('cividis')).toBe(true);
  expect(isColorMapName('jet')).toBe(false);
  expect(isColorMapName(null)).toBe(false);
});
