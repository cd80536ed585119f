// The numbers beside a colour bar: round steps of 1, 2 or 5, written short, with one power of ten
// taken out where it helps.

import {linearPart, placeOn} from './log_scale';

export interface Tick {
  /** In [0, 1] along the bar. */
  at: number;
  label: string;
}

export interface Ticks {
  ticks: Tick[];
  /**
   * The factor of all labels and the number added to them, as text ("× 10⁵", "+ 101325"); empty for
   * neither.
   */
  factor: string;
}

const kSuperscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';
/** Values from 10^-3 to below 10^5 are written plainly. */
const kPlainFrom = -3;
const kPlainBelow = 5;
const kMinus = '\u2212';

/** The max digits of a label. A part that all labels share is written once instead. */
const kMaxDigits = 5;

/**
 * At max `max` (2 or more) ticks inside [low, high]. A range without width gives one tick, at the
 * beginning, where its colour is.
 */
export function niceTicks(low: number, high: number, max: number): Ticks {
  const largest = Math.max(Math.abs(low), Math.abs(high));
  const exponent = largest > 0 ? Math.floor(Math.log10(largest) + 1e-9) : 0;
  const power = exponent < kPlainFrom || exponent >= kPlainBelow ? exponent : 0;
  const unit = 10 ** power;
  const factor = power === 0 ? '' : `× 10${superscript(power)}`;
  if (!(high > low)) return {ticks: [{at: 0, label: label(low / unit, 3, true)}], factor};
  const step = niceStep(low / unit, high / unit, max);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const digits = Math.floor(Math.log10(Math.max(largest / unit, 1))) + 1 + decimals;
  if (digits > kMaxDigits) {
    const base = firstTick(low / unit, step) * step * unit;
    const {ticks, factor: small} = niceTicks(low - base, high - base, max);
    const sign = base < 0 ? kMinus : '+';
    const common = label(Math.abs(base), Math.max(0, Math.min(decimals - power, 20)), true);
    if (base !== 0) return {ticks, factor: `${small} ${sign} ${common}`.trim()};
  }
  const ticks: Tick[] = [];
  for (let i = firstTick(low / unit, step); i <= lastTick(high / unit, step); ++i) {
    const at = (i * step * unit - low) / (high - low);
    ticks.push({at: Math.min(1, Math.max(0, at)), label: label(i * step, decimals, false)});
  }
  return {ticks, factor};
}

/**
 * The same for a logarithmic bar: powers of ten, and 2 and 5 times them if these are few. A bar of
 * both signs has 0, too. REQUIRES: low < high, low is not 0.
 */
export function logTicks(low: number, high: number, max: number): Ticks {
  if (low < 0) return signedTicks(low, high, max);
  const from = Math.floor(Math.log10(low) - 1e-9);
  const to = Math.ceil(Math.log10(high) + 1e-9);
  const at = (value: number): number => placeOn({low, high, logarithmic: true}, value);
  if (high < 10 * low) {
    // hardly curved: the numbers of a linear bar, at their logarithmic places
    const {ticks, factor} = niceTicks(low, high, max);
    return {ticks: ticks.map((tick) => ({...tick, at: at(low + tick.at * (high - low))})), factor};
  }
  const choose = (factors: number[], every: number): Tick[] => {
    const ticks: Tick[] = [];
    for (let power = from; power <= to; ++power) {
      if (power % every !== 0) continue;
      for (const factor of factors) {
        const value = factor * 10 ** power;
        if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9))
          ticks.push({at: Math.min(1, Math.max(0, at(value))), label: powerLabel(factor, power)});
      }
    }
    return ticks;
  };
  const fine = choose([1, 2, 5], 1);
  if (fine.length <= max && fine.length > 0) return {ticks: fine, factor: ''};
  for (let every = 1; ; ++every) {
    const ticks = choose([1], every);
    if (ticks.length <= max)
      return {ticks: ticks.length > 0 ? ticks : choose([1], 1).slice(0, max), factor: ''};
  }
}

/** Powers of ten of both signs that are not in the linear part, every n-th of many, and 0. */
function signedTicks(low: number, high: number, max: number): Ticks {
  const scale = {low, high, logarithmic: true};
  const linear = linearPart(scale);
  const from = Math.ceil(Math.log10(linear) - 1e-9);
  const to = Math.floor(Math.log10(Math.max(-low, high)) + 1e-9);
  for (let every = 1; ; ++every) {
    const powers = Array.from(
      {length: Math.ceil((to - from + 1) / every)},
      (_, i) => to - every * i,
    );
    const ticks = [
      ...powers.map((power): [number, string] => [-(10 ** power), kMinus + powerLabel(1, power)]),
      [0, '0'] as const,
      ...powers.reverse().map((power): [number, string] => [10 ** power, powerLabel(1, power)]),
    ]
      .map(([value, text]) => ({at: placeOn(scale, value), label: text}))
      .filter(({at}) => at >= -1e-9 && at <= 1 + 1e-9);
    if (ticks.length <= max || every > to - from) return {ticks, factor: ''};
  }
}

/** Whole numbers from `first` on, in the middles of `count` equal parts; every n-th of many. */
export function labelTicks(first: number, count: number, max: number): Ticks {
  const every = Math.ceil(count / max);
  const ticks: Tick[] = [];
  for (let i = 0; i < count; i += every)
    ticks.push({at: (i + 0.5) / count, label: label(first + i, 0, false)});
  return {ticks, factor: ''};
}

function powerLabel(factor: number, power: number): string {
  if (power >= kPlainFrom && power < kPlainBelow)
    return label(factor * 10 ** power, Math.max(0, -power), false);
  return factor === 1 ? `10${superscript(power)}` : `${factor}·10${superscript(power)}`;
}

/**
 * The smallest step of 1, 2 or 5 times a power of ten with at max `max` ticks inside [low, high].
 */
function niceStep(low: number, high: number, max: number): number {
  const power = 10 ** (Math.floor(Math.log10((high - low) / max)) - 1);
  for (let unit = power; ; unit *= 10) {
    for (const factor of [1, 2, 5]) {
      const step = factor * unit;
      if (lastTick(high, step) - firstTick(low, step) + 1 <= max) return step;
    }
  }
}

function firstTick(low: number, step: number): number {
  return Math.ceil(low / step - 1e-6);
}
function lastTick(high: number, step: number): number {
  return Math.floor(high / step + 1e-6);
}

function label(value: number, decimals: number, short: boolean): string {
  const fixed = Math.abs(value).toFixed(Math.min(decimals, 20));
  const digits = short ? String(Number(fixed)) : fixed;
  return value < 0 && Number(digits) !== 0 ? kMinus + digits : digits;
}

function superscript(power: number): string {
  const digits = String(Math.abs(power)).replace(/\d/g, (digit) => kSuperscripts[Number(digit)]!);
  return power < 0 ? `⁻${digits}` : digits;
}
