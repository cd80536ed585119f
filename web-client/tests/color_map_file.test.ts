import {expect, test} from 'vitest';
import {isColorMapName} from '../core/picture/color_maps';
import {colorMapOf, readColorMap} from '../viewer/drop/color_map_file';

const kPoints = [-2, 0, 0, 1, 0, 1, 1, 1, 6, 1, 0, 0];
const of = (map: object): string => colorMapOf([map], 'a.json');

test('theFirstMapOfAFileIsTakenAtSharesOfItsRange', () => {
  const text = of({Name: 'a', ColorSpace: 'Lab', RGBPoints: kPoints});
  expect(text).toBe('custom:0=0000ff,0.25=ffffff,1=ff0000');
  expect(isColorMapName(text)).toBe(true);
});

test('manyPointsBecomeFewerThatALinkHolds', () => {
  const points = Array.from({length: 1000}, (_, i) => [i, i / 999, 0, 0]).flat();
  const text = of({RGBPoints: points});
  expect(text.split(',')).toHaveLength(64);
  expect(isColorMapName(text)).toBe(true);
});

test.each([
  [null, /no RGBPoints/],
  [{RGBPoints: 'x'}, /no RGBPoints/],
  [{ColorSpace: 'Diverging', RGBPoints: kPoints}, /"Diverging", which is not understood/],
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
