// Numbers for people: grouped digits, bytes in decimal units, percent that never says 100 too early.

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

/** Rounds down: 100 means all of it. */
export function percentOf(part: number, whole: number): number {
  return whole > 0 ? Math.min(100, Math.floor((100 * part) / whole)) : 0;
}

/** A coordinate on an axis of length `span`, to a thousandth of that: next to zero is zero. */
export function formatCoordinate(value: number, span: number): string {
  const magnitude = Math.max(Math.abs(value), span);
  if (magnitude >= 1e5 || magnitude < 1e-2) return (Math.abs(value) < span / 2000 ? 0 : value).toExponential(2).replaceAll('-', '\u2212');
  const decimals = Math.max(0, Math.ceil(-Math.log10(span / 1000) - 1e-9));
  const text = Math.abs(value).toFixed(Math.min(decimals, 8));
  return value < 0 && Number(text) !== 0 ? `\u2212${text}` : text;
}
