// The viewer's settings, read from its attributes. Every control writes an attribute, and every
// attribute can be part of a link.

import {parseClip, type ClipSetting} from '../../core/layers/clip';
import {parseNumbers, parseScalar} from '../../core/layers/field_values';
import {kLayers, type LayerAttribute} from '../../core/layers/layers';
import {readVolume} from '../../core/layers/volume';
import {parseBeyond} from '../../core/picture/color_map_text';
import {isColorMapName, kLabelColors, type ColorMapName} from '../../core/picture/color_maps';
import {kClipModes, type ClipMode} from '../../core/picture/display';
import {kMagnitude, type Scalar} from '../../core/picture/field_scale';
import {tailsHide} from '../../core/picture/spread';
import {kFull, parseLimit, type Limit} from '../../core/protocol/limit';
import type {FieldInfo} from '../../core/protocol/fields';
import {shownInstant} from '../../core/protocol/series';
import type {CameraState} from '../../webgl/camera';
import {isGround} from './ground';

const kBeforeLayers = [
  'mesh',
  'derived',
  'field',
  'field-title',
  'time',
  'time-range',
  'time-loop',
  'colormap',
  'beyond',
  'range',
  'scale',
  'edges',
  'creases',
  'surface',
  'opacity',
] as const;
const kAfterLayers = [
  'warp',
  'warp-scale',
  'rest-edges',
  'axes',
  'length-unit',
  'ground',
  'points',
  'lines',
  'flux',
  'extremes',
  'quality',
  'projection',
  'camera',
] as const;
export type ViewAttribute =
  (typeof kBeforeLayers)[number] | LayerAttribute | (typeof kAfterLayers)[number];

/** The attributes of a view, in the order of a link. */
export const kViewAttributes: readonly ViewAttribute[] = [
  ...kBeforeLayers,
  ...kLayers.flatMap(({name, more = []}) => [
    name,
    ...more.map((its) => its.name as LayerAttribute),
  ]),
  ...kAfterLayers,
];

/** A legend has two lines. */
const kMaxTitle = 120;
const kMaxUnit = 16;

export interface Settings {
  /** The title of the shown field; null: its name and its unit. */
  title: string | null;
  map: ColorMapName;
  reversed: boolean;
  /** The colours below and above the range; null: those of its ends. */
  beyond: [number[] | null, number[] | null];
  range: 'auto' | 'full' | 'symmetric' | 'instant' | [number, number];
  logarithmic: boolean;
  edges: boolean;
  creases: boolean;
  surface: boolean;
  opacity: number;
  /** The look of streamlines. */
  lines: string;
  /** Opacities at even shares of the shown range; null: the volume is not shown. */
  volume: number[] | null;
  /** The volume's opacities are for the mesh to choose. */
  hasFirstOpacities: boolean;
  planes: ClipSetting[];
  /** The mesh opens with a plane; to remove it takes an attribute. */
  hasFirstCut: boolean;
  mode: ClipMode;
  limit: Limit;
  parallel: boolean;
  camera: CameraState | null;
  /** The field whose vectors move the mesh, or kNoWarp; null: that is for the mesh to choose. */
  warp: string | null;
  /** The factor of the vectors; null: it is for the mesh to choose. */
  warpScale: number | null;
  /** A warp shows the edges of the mesh at rest, too. */
  restEdges: boolean;
  /** A box with numbers stands round the mesh. */
  axes: boolean;
  /** That of coordinates; null: the log may know it. */
  lengthUnit: string | null;
  /** One of kGrounds, or a colour as RRGGBB; null: that of the page. */
  ground: string | null;
  /** The time that is shown of series; null: that which opens. */
  time: number | null;
  /** The times that playing begins and ends at; null: all instants of a series play. */
  timePart: [number, number] | null;
  /** Playing begins again at the end. */
  timeLoops: boolean;
}

export function readSettings(get: (name: ViewAttribute) => string | null): Settings {
  const [map = '', reversed] = (get('colormap') ?? '').split(/[\s+]+/);
  const mode = get('clip-mode') as ClipMode;
  const opacity = Number(get('opacity') ?? 1);
  return {
    title: parseText(get('field-title'), kMaxTitle),
    map: isColorMapName(map) ? map : 'viridis',
    reversed: reversed === 'reversed',
    beyond: parseBeyond(get('beyond') ?? '') ?? [null, null],
    range: parseRange(get('range')),
    logarithmic: get('scale') === 'log',
    edges: get('edges') !== 'off',
    creases: get('creases') !== 'off',
    surface: get('surface') !== 'off',
    opacity: opacity > 0 && opacity <= 1 ? opacity : 1,
    lines: get('streamline-look') ?? '',
    ...readVolume(get('volume')),
    planes: parseClip(get('clip')),
    hasFirstCut: false,
    mode: kClipModes.includes(mode) ? mode : 'cut',
    limit: parseLimit(get('quality')) ?? kFull,
    parallel: get('projection') === 'parallel',
    camera: parseCamera(get('camera')),
    warp: get('warp'),
    warpScale: parseNumber(get('warp-scale')),
    restEdges: get('rest-edges') === 'on',
    axes: get('axes') === 'on',
    ground: parseGround(get('ground')),
    lengthUnit: parseText(get('length-unit'), kMaxUnit),
    time: parseNumber(get('time')),
    timePart: parsePair(get('time-range')),
    timeLoops: get('time-loop') !== 'off',
  };
}

function parseRange(text: string | null): Settings['range'] {
  if (text === 'symmetric' || text === 'full' || text === 'instant') return text;
  return parsePair(text) ?? 'auto';
}

/** Two numbers, the smaller first. */
function parsePair(text: string | null): [number, number] | null {
  const [low, high, more] = parseNumbers(text ?? '');
  const isPair = low !== undefined && high !== undefined && more === undefined && low < high;
  return isPair ? [low, high] : null;
}

const parseGround = (text: string | null): string | null =>
  text !== null && isGround(text) ? text : null;

/** Null instead of an empty text. */
function parseText(text: string | null, max: number): string | null {
  const its = text?.trim().slice(0, max) ?? '';
  return its === '' ? null : its;
}

function parseCamera(text: string | null): CameraState | null {
  const numbers = parseNumbers(text ?? '');
  return numbers.length === 6 ? (numbers as CameraState) : null;
}

function parseNumber(text: string | null): number | null {
  const numbers = parseNumbers(text ?? '');
  return numbers.length === 1 ? numbers[0]! : null;
}

// ---- the field that colours

/** The scalar that colours: the named field, or `firstField`; null if there is none. */
export function shownScalar(
  text: string | null,
  fields: readonly FieldInfo[],
  firstField: number,
): Scalar | null {
  const field = shownInstant(fields, firstField);
  const first = fields.length > 0 ? {field, component: kMagnitude} : null;
  return parseScalar(text, fields) ?? first;
}

// ---- the range that the colours span

/** The map `labels` spans kLabelColors numbers, with each in the middle of its colour. */
export function labelRange([first, count]: [number, number]): Omit<ShownRange, 'hasMissing'> {
  const low = first - 0.5;
  return {low, high: low + kLabelColors, logarithmic: false, hides: 'none', labels: count};
}

export interface ShownRange {
  low: number;
  high: number;
  logarithmic: boolean;
  /** The values that a logarithmic scale hides: none, those below `low`, or all of them. */
  hides: 'none' | 'low' | 'all';
  /** Whole numbers from low + 0.5 on, each with a colour of its own. */
  labels?: number;
  /** Few values lie outside. The first and the last end are open if some lie beyond them. */
  openEnds?: [boolean, boolean];
  /** Some values are missing: the legend explains their colour. */
  hasMissing: boolean;
}

/** An end of the colours that is nearer to that of all values becomes it: half of a colour. */
const kAtEnd = 1 / 512;

function middleRange(
  extent: [number, number],
  middle: [number, number],
): Omit<ShownRange, 'hasMissing'> {
  const least = kAtEnd * (middle[1] - middle[0]);
  const openEnds = [middle[0] - extent[0] > least, extent[1] - middle[1] > least] as const;
  const [low, high] = openEnds.map((isOpen, end) => (isOpen ? middle : extent)[end]!);
  return {low: low!, high: high!, logarithmic: false, hides: 'none', openEnds: [...openEnds]};
}

/**
 * `extent` is the range of the values that occur, `middle` that of most of them. An automatic range
 * is `middle` if the few others would take too many colours. A logarithmic range
 * from 0 starts at a ten-thousandth of its end. `hides` then says what this hides, or why there is
 * none. One from below 0 is linear about 0 (log_scale.ts).
 */
export function shownRange(
  {range, logarithmic}: Settings,
  extent: [number, number],
  middle: [number, number] = extent,
): Omit<ShownRange, 'hasMissing'> {
  if (range === 'auto' && !logarithmic && tailsHide(middle, extent))
    return middleRange(extent, middle);
  const max = Math.max(Math.abs(extent[0]), Math.abs(extent[1]));
  const isWhole = typeof range === 'string' && range !== 'symmetric';
  const [low, high] = isWhole ? extent : range === 'symmetric' ? [-max, max] : range;
  if (!logarithmic) return {low, high, logarithmic: false, hides: 'none'};
  if (low < 0 && low < high) return {low, high, logarithmic: true, hides: 'none'};
  if (high <= 0) return {low, high, logarithmic: false, hides: 'all'};
  const kDecades = 1e-4;
  const from = low > 0 ? low : high * kDecades;
  if (from >= high) return {low, high, logarithmic: false, hides: 'all'};
  return {low: from, high, logarithmic: true, hides: low > 0 ? 'none' : 'low'};
}
