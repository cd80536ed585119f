// The viewer's settings, read from its attributes. Every control writes an attribute, and every
// attribute can be part of a link.

import {isColorMapName, type ColorMapName} from '../../core/picture/color_maps';
import {kClipModes, kMaxPlanes, type ClipMode} from '../../core/picture/display';
import {kMagnitude, scalarRange, type Scalar} from '../../core/picture/field_scale';
import {kMaxLabels} from '../../core/picture/labels';
import {kMaxOpacity, kOpacityPath} from '../../core/picture/transfer';
import {kFull, parseLimit, type Limit} from '../../core/protocol/limit';
import {fieldKeys, type FieldInfo} from '../../core/protocol/manifest';
import type {CameraState} from '../../three/camera';

/** The attributes of a view, in the order of a link. */
export const kViewAttributes = [
  'mesh',
  'field',
  'colormap',
  'range',
  'scale',
  'edges',
  'surface',
  'opacity',
  'clip',
  'clip-mode',
  'iso',
  'threshold',
  'volume',
  'quality',
  'projection',
  'camera',
] as const;
export type ViewAttribute = (typeof kViewAttributes)[number];

/**
 * A plane at a share of the mesh's extent along its normal, which is an axis or any direction of
 * the lattice.
 */
export interface ClipSetting {
  normal: [number, number, number];
  share: number;
}

export interface Settings {
  map: ColorMapName;
  reversed: boolean;
  range: 'auto' | 'full' | 'symmetric' | [number, number];
  logarithmic: boolean;
  edges: boolean;
  surface: boolean;
  opacity: number;
  /** Opacities at even shares of the shown range; null: the volume is not shown. */
  volume: number[] | null;
  /** The volume's opacities are for the mesh to choose. */
  hasFirstOpacities: boolean;
  planes: ClipSetting[];
  mode: ClipMode;
  limit: Limit;
  parallel: boolean;
  camera: CameraState | null;
}

export function readSettings(get: (name: ViewAttribute) => string | null): Settings {
  const [map = '', reversed] = (get('colormap') ?? '').split(/[\s+]+/);
  const mode = get('clip-mode') as ClipMode;
  const opacity = Number(get('opacity') ?? 1);
  return {
    map: isColorMapName(map) ? map : 'viridis',
    reversed: reversed === 'reversed',
    range: parseRange(get('range')),
    logarithmic: get('scale') === 'log',
    edges: get('edges') !== 'off',
    surface: get('surface') !== 'off',
    opacity: opacity > 0 && opacity <= 1 ? opacity : 1,
    ...readVolume(get('volume')),
    planes: parseClip(get('clip')),
    mode: kClipModes.includes(mode) ? mode : 'cut',
    limit: parseLimit(get('quality')) ?? kFull,
    parallel: get('projection') === 'parallel',
    camera: parseCamera(get('camera')),
  };
}

function parseRange(text: string | null): Settings['range'] {
  if (text === 'symmetric' || text === 'full') return text;
  const numbers = parseNumbers(text ?? '');
  return numbers.length === 2 && numbers[0]! < numbers[1]! ? [numbers[0]!, numbers[1]!] : 'auto';
}

/**
 * The shape of a volume's first opacities: low values are faint, so that its whole shape is
 * visible, and high ones dense.
 */
const kFirstOpacities: readonly number[] = [0.03, 0.04, 0.06, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9];

/** The most opacities of a volume: more cannot be told apart in the picture. */
export const kMaxOpacities = 33;

/** The attribute's value if the mesh is to choose. */
export const kAutoVolume = 'auto';
/** The mean optical depth of a volume that is seen at first: its inside shows, and its shape. */
const kFirstDepth = 0.9;

/** `chord` is the mean length of lines through the mesh, as a share of the diagonal; 0: unknown. */
export function firstOpacities(chord: number): number[] {
  const depths = kFirstOpacities.map((opacity) => -Math.log(1 - opacity));
  const mean = depths.reduce((sum, depth) => sum + depth, 0) / depths.length;
  const factor = chord > 0 ? (kFirstDepth * kOpacityPath) / (mean * chord) : 1;
  return depths.map((depth) =>
    Number(Math.min(kMaxOpacity, 1 - Math.exp(-factor * depth)).toFixed(3)),
  );
}

function readVolume(text: string | null): Pick<Settings, 'volume' | 'hasFirstOpacities'> {
  if (text === null) return {volume: null, hasFirstOpacities: false};
  const numbers = parseNumbers(text);
  const isRight =
    numbers.length >= 2 &&
    numbers.length <= kMaxOpacities &&
    numbers.every((value) => value >= 0 && value <= 1);
  return {volume: isRight ? numbers : firstOpacities(0), hasFirstOpacities: !isRight};
}

function parseCamera(text: string | null): CameraState | null {
  const numbers = parseNumbers(text ?? '');
  return numbers.length === 6 ? (numbers as CameraState) : null;
}

/** Reads "1, 2.5 3e-4" as numbers. The result is empty if anything in it is no number. */
export function parseNumbers(text: string): number[] {
  const numbers = text
    .replaceAll('\u2212', '-')
    .split(/[\s,;]+/)
    .filter((word) => word !== '')
    .map(Number);
  return numbers.every(Number.isFinite) ? numbers : [];
}

// ---- clip planes: "x", "-y:0.3", "0.6,-0.8,0:0.4", several with spaces between them

/** The side that is cut away first faces the first camera: front, right and top. */
const kFirstSides = [1, -1, 1];

export function parseClip(text: string | null): ClipSetting[] {
  const planes = (text ?? '')
    .trim()
    .split(/\s+/)
    .map(parsePlane)
    .filter((plane) => plane !== null);
  return planes.slice(0, kMaxPlanes);
}

function parsePlane(word: string): ClipSetting | null {
  const [direction = '', at = '0.5'] = word.split(':');
  const share = Number(at);
  if (at === '' || !(share >= 0 && share <= 1)) return null;
  const axis = /^(-?)([xyz])$/.exec(direction);
  if (axis) return {normal: axisNormal('xyz'.indexOf(axis[2]!), axis[1] === '-'), share};
  const normal = parseNumbers(direction);
  if (normal.length !== 3 || Math.hypot(...normal) === 0) return null;
  const length = Math.hypot(...normal);
  return {normal: normal.map((x) => x / length) as ClipSetting['normal'], share};
}

/** `flipped`: the side away from the first camera is cut away. */
export function axisNormal(axis: number, flipped: boolean): [number, number, number] {
  const normal: [number, number, number] = [0, 0, 0];
  normal[axis] = kFirstSides[axis]! * (flipped ? -1 : 1);
  return normal;
}

/** The plane's axis, -1 for a free plane, and its side. */
export function axisOf({normal}: ClipSetting): {axis: number; flipped: boolean} {
  const axis = normal.findIndex((x) => Math.abs(x) === 1);
  return {axis, flipped: axis >= 0 && normal[axis] !== kFirstSides[axis]};
}

export function clipText(planes: ClipSetting[]): string {
  return planes
    .map((plane) => {
      const {axis, flipped} = axisOf(plane);
      const direction =
        axis >= 0
          ? `${flipped ? '-' : ''}${'xyz'[axis]}`
          : plane.normal.map((x) => Number(x.toFixed(4))).join(',');
      return `${direction}:${Number(plane.share.toFixed(4))}`;
    })
    .join(' ');
}

// ---- fields: "Velocity" (its magnitude), "Velocity[0]" (a component)

export function parseScalar(text: string | null, fields: readonly FieldInfo[]): Scalar | null {
  if (text === null) return null;
  const keys = fieldKeys(fields);
  const whole = keys.indexOf(text);
  if (whole >= 0) return {field: whole, component: kMagnitude};
  const match = /^(.*)\[(\d+)\]$/s.exec(text);
  const field = match ? keys.indexOf(match[1]!) : -1;
  if (field < 0) return null;
  const component = Number(match![2]);
  return {field, component: component < fields[field]!.components ? component : kMagnitude};
}

/** The scalar that colours: the named field, or `firstField`; null if there is none. */
export function shownScalar(
  text: string | null,
  fields: readonly FieldInfo[],
  firstField: number,
): Scalar | null {
  const first = fields.length > 0 ? {field: firstField, component: kMagnitude} : null;
  return parseScalar(text, fields) ?? first;
}

/** The field's key without a component, to ask a server before its fields are known. */
export function scalarKey(text: string): string {
  return text.replace(/\[\d+\]$/, '');
}

export function scalarText(scalar: Scalar, fields: readonly FieldInfo[]): string {
  const key = fieldKeys(fields)[scalar.field] ?? '';
  return scalar.component === kMagnitude ? key : `${key}[${scalar.component}]`;
}

// ---- values of a field: "Density=0.5,0.7"

export interface FieldValues {
  scalar: Scalar;
  values: number[];
}

export function parseFieldValues(
  text: string | null,
  fields: readonly FieldInfo[],
): FieldValues | null {
  const at = text?.lastIndexOf('=') ?? -1;
  if (at < 0) return null;
  const scalar = parseScalar(text!.slice(0, at), fields);
  const values = parseNumbers(text!.slice(at + 1));
  return scalar && values.length > 0 ? {scalar, values} : null;
}

/**
 * Reads isosurfaces, which need a point field, or a threshold, which needs two values. Null if the
 * text is empty or does not fit the mesh.
 */
export function fieldValuesOf(
  kind: 'iso' | 'threshold',
  text: string | null,
  fields: readonly FieldInfo[],
): FieldValues | null {
  const value = parseFieldValues(text, fields);
  if (!value) return null;
  const fits =
    kind === 'iso'
      ? fields[value.scalar.field]!.association === 'point'
      : value.values.length === 2;
  return fits ? value : null;
}

/** Small differences of large values stay: 101325.03. */
const kLinkDigits = 9;

export function fieldValuesText(
  {scalar, values}: FieldValues,
  fields: readonly FieldInfo[],
): string {
  const numbers = values.map((value) => Number(value.toPrecision(kLinkDigits)));
  return `${scalarText(scalar, fields)}=${numbers.join(',')}`;
}

/** The values as shares of the field's scalarRange. */
export function sharesOf({scalar, values}: FieldValues, fields: readonly FieldInfo[]): number[] {
  const [low, high] = scalarRange(fields[scalar.field]!, scalar.component);
  return values.map((value) => (high > low ? (value - low) / (high - low) : 0));
}

// ---- the range that the colours span

/** The map `labels` spans kMaxLabels numbers, with each in the middle of its colour. */
export function labelRange([first, count]: [number, number]): Omit<ShownRange, 'hasMissing'> {
  const low = first - 0.5;
  return {low, high: low + kMaxLabels, logarithmic: false, hides: 'none', labels: count};
}

/** If the middle 96 % of the values take less of the range, the tails hide them. */
const kMinMiddle = 0.4;

export interface ShownRange {
  low: number;
  high: number;
  logarithmic: boolean;
  /** The values that a logarithmic scale hides: none, those below `low`, or all of them. */
  hides: 'none' | 'low' | 'all';
  /** Whole numbers from low + 0.5 on, each with a colour of its own. */
  labels?: number;
  /** A few values lie outside. */
  isMiddle?: boolean;
  /** Some values are missing: the legend explains their colour. */
  hasMissing: boolean;
}

/**
 * `extent` is the range of the values that occur, `middle` that of most of them. An automatic range
 * is `middle` (`isMiddle`) if the few others would take most of the colours. A logarithmic range
 * starts above 0, if necessary at a ten-thousandth of its end; `hides` then says what this hides,
 * or why there is none.
 */
export function shownRange(
  {range, logarithmic}: Settings,
  extent: [number, number],
  middle: [number, number] = extent,
): Omit<ShownRange, 'hasMissing'> {
  const tailsHide = middle[1] - middle[0] < kMinMiddle * (extent[1] - extent[0]);
  if (range === 'auto' && !logarithmic && tailsHide && middle[0] < middle[1])
    return {low: middle[0], high: middle[1], logarithmic, hides: 'none', isMiddle: true};
  const max = Math.max(Math.abs(extent[0]), Math.abs(extent[1]));
  const isWhole = range === 'auto' || range === 'full';
  const [low, high] = isWhole ? extent : range === 'symmetric' ? [-max, max] : range;
  if (!logarithmic) return {low, high, logarithmic: false, hides: 'none'};
  if (high <= 0) return {low, high, logarithmic: false, hides: 'all'};
  const kDecades = 1e-4;
  const from = low > 0 ? low : high * kDecades;
  if (from >= high) return {low, high, logarithmic: false, hides: 'all'};
  return {low: from, high, logarithmic: true, hides: low > 0 ? 'none' : 'low'};
}
