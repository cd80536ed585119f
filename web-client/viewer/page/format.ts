// Numbers for people: grouped digits, bytes in decimal units, and percentages that never reach 100
// too early.

import type {FieldInfo} from '../../core/protocol/fields';

const kCounts = new Intl.NumberFormat('en', {maximumFractionDigits: 0});
const kByteUnits = ['B', 'kB', 'MB', 'GB', 'TB'];

/** 1234567 as "1 234 567", with thin spaces that do not break. */
export function formatCount(count: number): string {
  return kCounts.format(count).replaceAll(',', '\u202f');
}

/** Three significant digits in steps of 1000, as network rates are counted: "1.23 MB". */
export function formatBytes(bytes: number): string {
  let value = bytes;
  let unit = 0;
  while (value >= 999.5 && unit + 1 < kByteUnits.length) {
    value /= 1000;
    ++unit;
  }
  const text = unit === 0 ? String(Math.round(value)) : value.toPrecision(3);
  return `${text}\u00a0${kByteUnits[unit]}`;
}

/** Rounds down, so that 100 means everything. */
export function percentOf(part: number, whole: number): number {
  return whole > 0 ? Math.min(100, Math.floor((100 * part) / whole)) : 0;
}

/** A relative error: "1.2 %", "0.034 %". A log knows three digits. */
export function formatError(error: number): string {
  if (error === 0) return '0\u202f%';
  const percent = 100 * error;
  if (percent >= 0.001) return `${Number(percent.toPrecision(2))}\u202f%`;
  return `${percent.toExponential(1).replaceAll('-', '\u2212')}\u202f%`;
}

/** A number above 0 with two digits, rounded up. */
export function roundedUp(bound: number): number {
  const digit = 10 ** (Math.floor(Math.log10(bound)) - 1);
  return Number((Math.ceil(bound / digit) * digit).toPrecision(2));
}

/**
 * "T is within 0.05 K at the last level", with two digits, rounded up. Before it, the largest error
 * of the level on the screen, as sampled; 0 where that is the last one, or not known.
 */
export function formatWithin(info: FieldInfo, error: number, now = 0): string {
  const name = info.instant?.name ?? info.name;
  const bound = (of: number): string => `${roundedUp(of)}${info.unit ? `\u202f${info.unit}` : ''}`;
  const last = error === 0 ? 'exact' : `within ${bound(error)}`;
  return now === 0
    ? `${name} is ${last} at the last level`
    : `${name} is at most ${bound(now)} off now, as sampled, and ${last} at the last level`;
}

/** "4 s", "2 min", "1.5 h". */
export function formatDuration(seconds: number): string {
  if (seconds < 90) return `${Math.max(1, Math.round(seconds))}\u202fs`;
  if (seconds < 5400) return `${Math.round(seconds / 60)}\u202fmin`;
  return `${(seconds / 3600).toFixed(1)}\u202fh`;
}

/** Larger numbers are written with a power of ten, and those that need more decimals. */
const kPlainBelow = 1e9;
const kMaxDecimals = 8;
/** A double holds no more digits. */
const kMaxDigits = 15;
/** Fields and places are shown to this share of their extent. */
const kShownShare = 1e-4;

const decimalsOf = (resolution: number): number =>
  Math.min(20, Math.max(0, Math.ceil(-Math.log10(resolution) - 1e-9)));

/**
 * A number with the decimals that `resolution` (above 0) needs: 101325.03 of values that differ by
 * 0.01. Less than half of the resolution is written as zero.
 */
export function formatTo(value: number, resolution: number): string {
  if (Number.isNaN(value)) return 'missing';
  const magnitude = Math.abs(value) < resolution / 2 ? 0 : Math.abs(value);
  const decimals = decimalsOf(resolution);
  const isPlain = magnitude < kPlainBelow && (decimals <= kMaxDecimals || magnitude === 0);
  const digits = Math.floor(Math.log10(Math.max(magnitude / resolution, 10)) + 1e-9);
  const text = isPlain
    ? magnitude.toFixed(Math.min(decimals, kMaxDecimals))
    : magnitude.toExponential(Math.min(digits, kMaxDigits)).replaceAll('-', '\u2212');
  return value < 0 && Number(magnitude.toFixed(decimals)) !== 0 ? `\u2212${text}` : text;
}

/** The number for a box that is edited: no more decimals than formatTo's, and no zeros behind. */
export function roundTo(value: number, resolution: number): number {
  return resolution > 0 ? Number(value.toFixed(decimalsOf(resolution))) : value;
}

/** How fine the values of a field are shown: as fine as they differ. Labels are whole. */
export function resolutionOf({association, components, isWhole, range, step}: FieldInfo): number {
  const span = components > 1 ? range[1] : range[1] - range[0];
  if (isWhole) return association === 'cell' ? 1 : 0.01;
  return Math.max(step, kShownShare * span, Number.MIN_VALUE);
}

/** A value of a field, of a label with its name: "steel (3)". */
export function formatIn(info: FieldInfo, value: number): string {
  const number = formatTo(value, resolutionOf(info));
  const name = info.labels?.get(Math.round(value));
  return name === undefined ? number : `${name} (${number})`;
}

/** A number of unknown extent, to five digits. */
export function formatValue(value: number): string {
  const magnitude = Math.abs(value);
  return formatTo(value, magnitude > 0 ? 10 ** (Math.floor(Math.log10(magnitude)) - 4) : 1);
}

/** "× 50": how many times something is enlarged. */
export const formatFactor = (factor: number): string =>
  `\u00d7\u202f${Number(factor.toPrecision(3))}`.replace('-', '\u2212');

/** A coordinate on an axis of length `span`, to a thousandth of it. */
export function formatCoordinate(value: number, span: number): string {
  return formatTo(value, span / 1000);
}
