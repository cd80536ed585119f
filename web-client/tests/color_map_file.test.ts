import {expect, test} from 'vitest';
import {colorAt, hexOf, parseStops} from '../core/picture/color_map_text';
import {colorTable, isColorMapName, type ColorMapName} from '../core/picture/color_maps';
import {colorMapOf, readColorMap} from '../viewer/drop/color_map_file';
import {mixOf, type Color} from '../viewer/drop/color_spaces';

const kPoints = [-2, 0, 0, 1, 0, 1, 1, 1, 6, 1, 0, 0];
const of = (map: object): string => colorMapOf([map], 'a.json');

test('theFirstMapOfAFileIsTakenAtSharesOfItsRange', () => {
  const text = of({Name: 'a', RGBPoints: kPoints});
  expect(text).toBe('custom:0=0000ff,0.25=ffffff,1=ff0000');
  expect(isColorMapName(text)).toBe(true);
});

test('manyPointsBecomeFewerThatALinkHolds', () => {
  const points = Array.from({length: 1000}, (_, i) => [i, i / 999, 0, 0]).flat();
  const text = of({RGBPoints: points});
  expect(text.split(',')).toHaveLength(64);
  expect(isColorMapName(text)).toBe(true);
});

test.each([1, 3, 62, 63, 64])('aMapInAnotherSpaceFitsIntoALink %#', (count) => {
  const points = Array.from({length: count + 1}, (_, i) => [i * i, i / count, 0, 1]).flat();
  const text = of({ColorSpace: 'Lab', RGBPoints: points});
  expect(isColorMapName(text)).toBe(true);
  expect(text.split(',').length).toBeGreaterThan(60);
});

test('thePointsOfAMapInAnotherSpaceAreKept', () => {
  const points = [0, 0, 0, 1, 0.00005, 0, 0, 1, 0.1, 1, 0, 0, 0.10015, 0, 1, 0, 1, 1, 1, 0];
  const text = of({ColorSpace: 'HSV', RGBPoints: [0, 0, 0, 1, ...points.slice(8)]});
  for (const stop of ['0=0000ff', '0.1=ff0000', '0.1002=00ff00', '1=ffff00'])
    expect(text.split(/[:,]/)).toContain(stop);
  expect(isColorMapName(of({ColorSpace: 'HSV', RGBPoints: points}))).toBe(true);
});

const kShares = [0, 0.1, 0.3, 0.5, 0.6, 0.9, 1];
const kBlue: Color = [0, 0, 1];
const kRed: Color = [1, 0, 0];
const kGreen: Color = [0, 1, 0];
const kYellow: Color = [1, 1, 0];
const kGrey: Color = [0.5, 0.5, 0.5];
const kWhite: Color = [1, 1, 1];

/** VTK 9.1's vtkColorTransferFunction gives these colours at kShares. */
test.each<[string, boolean, Color, Color, string]>([
  ['Lab', false, kBlue, kYellow, '0000ff 6529ef a45ccd ca8aaa d8a197 f8e74a ffff00'],
  ['CIELAB', false, kGreen, kRed, '00ff00 65ef00 a4ce00 c9ab00 d79800 f74a00 ff0000'],
  ['HSV', false, kBlue, kRed, '0000ff 0066ff 00ffcc 00ff00 66ff00 ff6600 ff0000'],
  ['HSV', true, kBlue, kRed, '0000ff 3300ff 9900ff ff00ff ff00cc ff0033 ff0000'],
  ['HSV', false, [1, 0.2, 0], [1, 0, 0.4], 'ff3300 ffbd00 2eff00 00ffe6 008fff ff00f0 ff0066'],
  ['HSV', true, [1, 0.2, 0], [1, 0, 0.4], 'ff3300 ff2400 ff0500 ff0019 ff0029 ff0057 ff0066'],
  ['HSV', true, [1, 0, 0.4], [1, 0.2, 0], 'ff0066 ff0057 ff0038 ff0019 ff000a ff2400 ff3300'],
  ['HSV', false, kGrey, [0, 0.8, 0], '808080 877c7a 968469 a6a653 99ad45 37c414 00cc00'],
  [
    'Diverging',
    false,
    [0.436, 0.308, 0.631],
    [0.759, 0.334, 0.046],
    '6f4fa1 a167af e0a4c3 dddddd eed2ba dc7e3c c2550c',
  ],
  ['Diverging', false, kBlue, [0.2, 0.2, 0.6], '0000ff 1715f8 2927e7 312fd4 3332c9 3434a6 333399'],
  ['Diverging', false, kWhite, [0.5, 0, 0.6], 'ffffff ffe2e9 ffb6d3 ff93d1 f87ed0 a328a9 800099'],
  ['Diverging', false, [0, 0, 0], kWhite, '000000 1b1b1b 474747 777777 919191 e2e2e2 ffffff'],
])('colorsMixInTheSpace %s as in VTK, wrapped: %s %#', (space, wraps, from, to, known) => {
  const mix = mixOf(space, wraps)!;
  const colors = kShares.map((share) => mix(from, to, share));
  const hex = colors.map((color) => hexOf(color.map((channel) => Math.round(255 * channel))));
  expect(hex.join(' ')).toBe(known);
});

test('huesTakeTheShorterWayOnlyIfTheFileSaysSo', () => {
  const points = {ColorSpace: 'HSV', RGBPoints: [0, ...kBlue, 1, ...kRed]};
  const middleOf = (map: object): string => hexOf(colorAt(parseStops(of(map))!, 0.5));
  expect(middleOf(points)).toBe('04ff04');
  expect(middleOf({...points, HSVWrap: 1})).toBe('fd00fd');
});

test("ParaView's Cool to Warm is the viewer's", () => {
  const from = [59, 76, 192].map((channel) => channel / 255);
  const to = [180, 4, 38].map((channel) => channel / 255);
  const text = of({ColorSpace: 'Diverging', RGBPoints: [0, ...from, 1, ...to]});
  expect(isColorMapName(text)).toBe(true);
  const [table, own] = [colorTable(text as ColorMapName), colorTable('cool-warm')];
  const apart = table.map((channel, i) => Math.abs(channel - own[i]!));
  expect(Math.max(...apart)).toBeLessThanOrEqual(2);
});

test.each([
  [null, /no RGBPoints/],
  [{RGBPoints: 'x'}, /no RGBPoints/],
  [{ColorSpace: 'Step', RGBPoints: kPoints}, /"Step", which is not understood/],
  [{RGBPoints: kPoints.slice(1)}, /not 2 to 4096 rows/],
  [{RGBPoints: [0, 0, 0, 0]}, /not 2 to 4096 rows/],
  [{RGBPoints: [0, 0, 0, '1', 1, 1, 1, 1]}, /not 2 to 4096 rows/],
  [{RGBPoints: new Array(4 * 4097).fill(0)}, /not 2 to 4096 rows/],
  [{RGBPoints: [0, 0, 0, 0, 0, 1, 1, 1]}, /do not ascend/],
  [{RGBPoints: [0, 0, 0, 0, 1, 1, 1, 2]}, /outside 0 to 1/],
])('whatIsNotUnderstoodIsRefusedByName %#', (map, why) => {
  expect(() => colorMapOf([map], 'a.json')).toThrow(why);
});

test.each([
  ['{', /a\.json is no JSON/],
  [' '.repeat(1000001), /over 1 MB/],
])('aFileThatIsDamagedOrTooLargeIsRefused %#', async (text, why) => {
  await expect(readColorMap(new File([text], 'a.json'))).rejects.toThrow(why);
});
