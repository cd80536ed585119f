// Numbers for people: grouped digits, bytes in decimal units, and percentages that never reach 100
// too early.

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

/** "4 s", "2 min", "1.5 h". */
export function formatDuration(seconds: number): string {
  if (seconds < 90) return `${Math.max(1, Math.round(seconds))}\u202fs`;
  if (seconds < 5400) return `${Math.round(seconds / 60)}\u202fmin`;
  return `${(seconds / 3600).toFixed(1)}\u202fh`;
}

/** A value of a field or a position, to five digits. */
export function formatValue(value: number): string {
  if (Number.isNaN(value)) return 'missing';
  const magnitude = Math.abs(value);
  const text =
    magnitude !== 0 && (magnitude >= 1e5 || magnitude < 1e-3)
      ? value.toExponential(4)
      : String(Number(value.toPrecision(5)));
  return text.replaceAll('-', '\u2212');
}

/**
 * A coordinate on an axis of length `span`, to a thousandth of it, however far from the origin it
 * lies. Almost zero is written as zero.
 */
export function formatCoordinate(value: number, span: number): string {
  const magnitude = Math.max(Math.abs(value), span);
  if (span >= 1e5 || magnitude < 1e-2) {
    const more = Math.max(0, Math.ceil(Math.log10(magnitude / span) - 1e-9));
    return (Math.abs(value) < span / 2000 ? 0 : value)
      .toExponential(Math.min(2 + more, 16))
      .replaceAll('-', '\u2212');
  }
  const decimals = Math.max(0, Math.ceil(-Math.log10(span / 1000) - 1e-9));
  const text = Math.abs(value).toFixed(Math.min(decimals, 8));
  return value < 0 && Number(text) !== 0 ? `\u2212${text}` : text;
}
