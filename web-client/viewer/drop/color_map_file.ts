// ParaView's colour maps (.json) as text. Loaded when one is dropped. A stranger's file is bounded,
// and what is not understood is refused by name.

import {colorAt, kMaxStops, stopsText, type ColorStop} from '../../core/picture/color_map_text';

const kMaxBytes = 1e6;
const kMaxPoints = 4096;
/** Between two of these colours the mixture is the same in each space. */
const kSpaces = ['RGB', 'Lab', 'CIELAB'];

/** The text of the file's first map. Throws an Error with a sentence. */
export async function readColorMap(file: Blob & {readonly name: string}): Promise<string> {
  if (file.size > kMaxBytes) throw new Error(`${file.name} has over 1 MB: it is no colour map.`);
  let json: unknown;
  try {
    json = JSON.parse(await file.text());
  } catch {
    throw new Error(`${file.name} is no JSON, or it is damaged.`);
  }
  return colorMapOf(json, file.name);
}

export function colorMapOf(json: unknown, file: string): string {
  const [first] = Array.isArray(json) ? (json as unknown[]) : [json];
  const {ColorSpace: space = 'RGB', RGBPoints: points} = Object(first) as Record<string, unknown>;
  if (!Array.isArray(points)) throw new Error(`${file} has no RGBPoints: it is no colour map.`);
  if (!kSpaces.includes(String(space)))
    throw new Error(
      `${file} mixes its colours in the space "${String(space).slice(0, 40)}", which is not ` +
        'understood. Save it in the space RGB or Lab.',
    );
  return stopsText(fewer(stopsOf(points, file)));
}

/** ParaView's rows of x, red, green, blue, with colours from 0 to 1. */
function stopsOf(points: readonly unknown[], file: string): ColorStop[] {
  const isRight = points.every((its) => typeof its === 'number' && Number.isFinite(its));
  const count = points.length / 4;
  if (!isRight || !Number.isInteger(count) || count < 2 || count > kMaxPoints)
    throw new Error(`${file} has RGBPoints that are not 2 to ${kMaxPoints} rows of four numbers.`);
  const rows = Array.from({length: count}, (_, i) => points.slice(4 * i, 4 * i + 4) as number[]);
  const [from, to] = [rows[0]![0]!, rows[count - 1]![0]!];
  const ascend = rows.every(([x], i) => i === 0 || x! > rows[i - 1]![0]!);
  if (!ascend || !rows.every((row) => row.slice(1).every((its) => its >= 0 && its <= 1)))
    throw new Error(`${file} has RGBPoints that do not ascend, or colours outside 0 to 1.`);
  return rows.map(([x, ...color]) => [
    (x! - from) / (to - from),
    color.map((channel) => Math.round(255 * channel)),
  ]);
}

/** Few enough for a link. */
function fewer(stops: ColorStop[]): ColorStop[] {
  const isClose = stops.some(([share], i) => i > 0 && share - stops[i - 1]![0] < 1e-4);
  if (stops.length <= kMaxStops && !isClose) return stops;
  return Array.from({length: kMaxStops}, (_, i) => {
    const share = i / (kMaxStops - 1);
    return [share, colorAt(stops, share)];
  });
}
