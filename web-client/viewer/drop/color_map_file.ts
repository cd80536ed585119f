// ParaView's colour maps (.json) as text. Loaded when one is dropped. A stranger's file is bounded,
// and what is not understood is refused by name.

import {kMaxStops, stopsText, type ColorStop} from '../../core/picture/color_map_text';
import {mixOf, type Color, type Mix} from './color_spaces';

const kMaxBytes = 1e6;
const kMaxPoints = 4096;
/** Shares that are closer would be one in a link. */
const kMinDistance = 1e-4;

/** A colour at a share of the range. */
interface Point {
  share: number;
  color: Color;
}

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
  const map = Object(first) as Record<string, unknown>;
  const {ColorSpace: space = 'RGB', HSVWrap: wraps = 0, RGBPoints: numbers} = map;
  if (!Array.isArray(numbers)) throw new Error(`${file} has no RGBPoints: it is no colour map.`);
  const mix = mixOf(String(space), Boolean(wraps));
  if (!mix)
    throw new Error(
      `${file} mixes its colours in the space "${String(space).slice(0, 40)}", which is not ` +
        'understood. Save it in the space RGB, Lab, HSV or Diverging.',
    );
  const points = pointsOf(numbers, file);
  const shares = space === 'RGB' && fits(points) ? points.map(({share}) => share) : spread(points);
  return stopsText(shares.map((share) => stopAt(points, share, mix)));
}

/** ParaView's rows of x, red, green, blue, with colours from 0 to 1. */
function pointsOf(numbers: readonly unknown[], file: string): Point[] {
  const isRight = numbers.every((its) => typeof its === 'number' && Number.isFinite(its));
  const count = numbers.length / 4;
  if (!isRight || !Number.isInteger(count) || count < 2 || count > kMaxPoints)
    throw new Error(`${file} has RGBPoints that are not 2 to ${kMaxPoints} rows of four numbers.`);
  const rows = Array.from({length: count}, (_, i) => numbers.slice(4 * i, 4 * i + 4) as number[]);
  const [from, to] = [rows[0]![0]!, rows[count - 1]![0]!];
  const ascend = rows.every(([x], i) => i === 0 || x! > rows[i - 1]![0]!);
  if (!ascend || !rows.every((row) => row.slice(1).every((its) => its >= 0 && its <= 1)))
    throw new Error(`${file} has RGBPoints that do not ascend, or colours outside 0 to 1.`);
  return rows.map(([x, red, green, blue]) => ({
    share: (x! - from) / (to - from),
    color: [red!, green!, blue!],
  }));
}

/** A link holds them as they are. */
const fits = (points: readonly Point[]): boolean =>
  points.length <= kMaxStops &&
  points.every(({share}, i) => i === 0 || share - points[i - 1]!.share >= kMinDistance);

/**
 * As many shares as a link holds, since it mixes in RGB between them. The points are among them if
 * they fit: the rest is spread evenly between two of them.
 */
function spread(points: readonly Point[]): number[] {
  if (!fits(points)) return Array.from({length: kMaxStops}, (_, i) => i / (kMaxStops - 1));
  const more = kMaxStops - points.length;
  return points.flatMap(({share: from}, i) => {
    const width = (points[i + 1]?.share ?? from) - from;
    const parts = 1 + Math.floor(more * width);
    const isNarrow = width < parts * kMinDistance;
    return isNarrow ? [from] : Array.from({length: parts}, (_, k) => from + (k / parts) * width);
  });
}

function stopAt(points: readonly Point[], share: number, mix: Mix): ColorStop {
  const above = Math.max(
    1,
    points.findIndex((point) => point.share >= share),
  );
  const [from, to] = [points[above - 1]!, points[above]!];
  const color = mix(from.color, to.color, (share - from.share) / (to.share - from.share));
  return [share, color.map((channel) => Math.round(255 * channel))];
}
