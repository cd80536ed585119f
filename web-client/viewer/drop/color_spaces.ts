// How ParaView mixes two colours in its spaces, as vtkColorTransferFunction computes them. Colours
// are in sRGB, from 0 to 1.

type Triple = readonly [number, number, number];
export type Color = Triple;
/** The colour at a share of the way from the first to the second. */
export type Mix = (from: Triple, to: Triple, share: number) => Triple;

const each = (change: (value: number, axis: number) => number, [a, b, c]: Triple): Triple => [
  change(a, 0),
  change(b, 1),
  change(c, 2),
];
const mixed: Mix = (from, to, share) =>
  each((value, axis) => value + share * (to[axis]! - value), from);

// ---- CIELAB of D65

const kToXyz: readonly Triple[] = [
  [0.4124, 0.3576, 0.1805],
  [0.2126, 0.7152, 0.0722],
  [0.0193, 0.1192, 0.9505],
];
const kFromXyz: readonly Triple[] = [
  [3.2406, -1.5372, -0.4986],
  [-0.9689, 1.8758, 0.0415],
  [0.0557, -0.204, 1.057],
];
const kWhite: Triple = [0.9505, 1, 1.089];

const times = (matrix: readonly Triple[], by: Triple): Triple =>
  each((_, row) => matrix[row]!.reduce((sum, x, at) => sum + x * by[at]!, 0), by);

function toLab(color: Triple): Triple {
  const linear = each((c) => (c > 0.04045 ? ((c + 0.055) / 1.055) ** 2.4 : c / 12.92), color);
  const [x, y, z] = each(
    (value, axis) => {
      const share = value / kWhite[axis]!;
      return share > 0.008856 ? Math.cbrt(share) : 7.787 * share + 16 / 116;
    },
    times(kToXyz, linear),
  );
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

function fromLab([lightness, a, b]: Triple): Triple {
  const y = (lightness + 16) / 116;
  const xyz = each(
    (root, axis) => {
      const cube = root ** 3;
      return kWhite[axis]! * (cube > 0.008856 ? cube : (root - 16 / 116) / 7.787);
    },
    [a / 500 + y, y, y - b / 200],
  );
  const color = each(
    (c) => (c > 0.0031308 ? 1.055 * c ** (1 / 2.4) - 0.055 : 12.92 * c),
    times(kFromXyz, xyz),
  );
  const brightest = Math.max(1, ...color);
  return each((channel) => Math.max(0, channel / brightest), color);
}

const mixLab: Mix = (from, to, share) => fromLab(mixed(toLab(from), toLab(to), share));

// ---- Msh: Moreland 2009, "Diverging Color Maps for Scientific Visualization"

/** Polar Lab: magnitude, saturation and hue, the latter two as angles. */
function toMsh([lightness, a, b]: Triple): Triple {
  const magnitude = Math.hypot(lightness, a, b);
  const isGrey = magnitude <= 0.001;
  const saturation = isGrey ? 0 : Math.acos(lightness / magnitude);
  return [magnitude, saturation, saturation > 0.001 ? Math.atan2(b, a) : 0];
}

const fromMsh = ([magnitude, saturation, hue]: Triple): Triple => [
  magnitude * Math.cos(saturation),
  magnitude * Math.sin(saturation) * Math.cos(hue),
  magnitude * Math.sin(saturation) * Math.sin(hue),
];

/** Colours above it are saturated. */
const kSaturated = 0.05;
/** Two hues that are farther apart have white between them. */
const kFarHues = 0.33 * Math.PI;
/** White's magnitude, at least. */
const kWhiteMagnitude = 88;

/** The hue of a colour without one, so that the change from the saturated colour looks even. */
function spunHue([magnitude, saturation, hue]: Triple, greyMagnitude: number): number {
  if (magnitude >= greyMagnitude - 0.1) return hue;
  const spin =
    (saturation * Math.sqrt(greyMagnitude ** 2 - magnitude ** 2)) /
    (magnitude * Math.sin(saturation));
  return hue > -0.3 * Math.PI ? hue + spin : hue - spin; // away from purple
}

const mixDiverging: Mix = (from, to, share) => {
  let [start, end] = [toMsh(toLab(from)), toMsh(toLab(to))];
  const turn = Math.abs(start[2] - end[2]);
  const isFar = Math.min(turn, 2 * Math.PI - turn) > kFarHues;
  if (start[1] > kSaturated && end[1] > kSaturated && isFar) {
    const white: Triple = [Math.max(start[0], end[0], kWhiteMagnitude), 0, 0];
    if (share < 0.5) end = white;
    else start = white;
    share = share < 0.5 ? 2 * share : 2 * share - 1;
  }
  if (start[1] < kSaturated && end[1] > kSaturated)
    start = [start[0], start[1], spunHue(end, start[0])];
  else if (end[1] < kSaturated && start[1] > kSaturated)
    end = [end[0], end[1], spunHue(start, end[0])];
  return fromLab(fromMsh(mixed(start, end, share)));
};

// ---- HSV

function toHsv([red, green, blue]: Triple): Triple {
  const value = Math.max(red, green, blue);
  const span = value - Math.min(red, green, blue);
  if (span === 0) return [0, 0, value];
  const sixths =
    value === red
      ? (green - blue) / span
      : value === green
        ? 2 + (blue - red) / span
        : 4 + (red - green) / span;
  return [(sixths / 6 + 1) % 1, span / value, value];
}

const fromHsv = ([hue, saturation, value]: Triple): Triple =>
  each(
    (from) => {
      const away = (from + 6 * hue + 6) % 6;
      return value * (1 - saturation * Math.max(0, Math.min(away, 4 - away, 1)));
    },
    [5, 3, 1],
  );

const mixHsv: Mix = (from, to, share) => fromHsv(mixed(toHsv(from), toHsv(to), share));

/** Hues take the shorter way round. */
const mixHsvWrapped: Mix = (from, to, share) => {
  const [[a, ...start], [b, ...end]] = [toHsv(from), toHsv(to)];
  const isFar = Math.abs(a - b) > 0.5;
  return fromHsv(
    mixed([isFar && a > b ? a - 1 : a, ...start], [isFar && b > a ? b - 1 : b, ...end], share),
  );
};

/** By the names of ParaView's spaces. CIELAB is Lab in files of others. */
export function mixOf(space: string, wraps: boolean): Mix | null {
  switch (space) {
    case 'RGB':
      return mixed;
    case 'Lab':
    case 'CIELAB':
      return mixLab;
    case 'Diverging':
      return mixDiverging;
    case 'HSV':
      return wraps ? mixHsvWrapped : mixHsv;
    default:
      return null;
  }
}
