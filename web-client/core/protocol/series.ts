// Series: fields that are the instants of one quantity, called NAME@TIME (codec/RECORDS.md,
// "Series"). The rules are those of seriesOf (proto/series.h).

import {fieldKeys, type FieldInfo, type Instant, type SeriesRanges} from './fields';

/** TIME of a name NAME@TIME. */
const kDecimal = /^-?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

type Time = Pick<Instant, 'time' | 'text'>;

/** Times are the same if they differ by less than this share of the larger one. */
const kNearTime = 1e-9;

export function isSameTime(a: number, b: number): boolean {
  return Math.abs(a - b) <= kNearTime * Math.max(Math.abs(a), Math.abs(b));
}

/** The number of the time nearest to the one wanted, the earlier one of two; 0 for -Infinity. */
export function nearestTo(times: readonly {time: number}[], wanted: number): number {
  let best = 0;
  times.forEach(({time}, i) => {
    if (Math.abs(time - wanted) < Math.abs(times[best]!.time - wanted)) best = i;
  });
  return best;
}

/** The parts of NAME@TIME; null for a name that does not end in "@" and a finite number. */
export function instantName(name: string): ({series: string} & Time) | null {
  const at = name.lastIndexOf('@');
  const text = name.slice(at + 1);
  if (at < 1 || !kDecimal.test(text)) return null;
  const time = Number(text);
  const isTooSmall = time === 0 && /^[^e]*[1-9]/i.test(text);
  return Number.isFinite(time) && !isTooSmall ? {series: name.slice(0, at), time, text} : null;
}

type Member = NonNullable<ReturnType<typeof instantName>> & {field: number};

/**
 * Marks the instants of all series of `least` and more, the one of each with the lowest number as
 * shown. They get one range: that of the whole series. May be called again for more fields.
 */
export function markSeries(fields: FieldInfo[], least = 2): void {
  for (const info of fields) {
    if (info.instant) info.range = info.instant.own.range;
    delete info.instant;
  }
  /** By kind and time. */
  const kinds = new Map<string, Map<number, Member>>();
  fields.forEach(({name, association, components, type}, field) => {
    const instant = instantName(name);
    if (!instant) return;
    const kind = JSON.stringify([instant.series, association, components, type]);
    const times = kinds.get(kind) ?? new Map<number, Member>();
    kinds.set(kind, times);
    if (!times.has(instant.time)) times.set(instant.time, {field, ...instant});
  });
  const keys = fieldKeys(fields);
  const series = [...kinds.values()]
    .filter(({size}) => size >= least)
    .map((times) => [...times.values()])
    .sort(
      ([a], [b]) => (isOfCells(fields[a!.field]!) ? 1 : 0) - (isOfCells(fields[b!.field]!) ? 1 : 0),
    );
  const instants = new Set(series.flat().map(({field}) => field));
  const taken = new Set(keys.filter((_, field) => !instants.has(field)));
  for (const members of series) {
    const infos = members.map(({field}) => fields[field]!);
    const {series: name, field: first} = members[0]!;
    const key = freeKey(name, infos[0]!, keys[first]!, taken);
    taken.add(key);
    const range = union(infos.map((info) => info.range));
    const own = infos.map((info) => info.minimum.map((_, c) => rangeOf(info, c)));
    const ranges = infos[0]!.minimum.map((_, c) => union(own.map((its) => its[c]!)));
    const alone = infos.map((info, i) => ({range: info.range, ranges: own[i]!}));
    const areUsual = usualOf(infos.map((info) => info.range));
    const usual = together(alone.filter((_, i) => areUsual[i]));
    const byTime = [...members].sort((a, b) => a.time - b.time).map(({field}) => field);
    infos.forEach((info, i) => {
      const {time, text} = members[i]!;
      const place = {series: key, name, fields: byTime, time, text};
      info.instant = {...place, isShown: false, ranges, own: alone[i]!};
      if (areUsual.includes(false)) info.instant.alike = areUsual[i] ? usual : alone[i]!;
      info.range = range;
    });
  }
  showTime(fields, null);
}

const isOfCells = ({association}: FieldInfo): boolean => association === 'cell';

/** The key of the series that begins with `first`: NAME or cell:NAME, else that of `first`. */
function freeKey(
  name: string,
  first: FieldInfo,
  firstKey: string,
  taken: ReadonlySet<string>,
): string {
  const choices = isOfCells(first) ? [name, `cell:${name}`] : [name];
  return choices.find((key) => !taken.has(key)) ?? firstKey;
}

const union = (ranges: [number, number][]): [number, number] => [
  Math.min(...ranges.map(([low]) => low)),
  Math.max(...ranges.map(([, high]) => high)),
];

function together(all: SeriesRanges[]): SeriesRanges {
  return {
    range: union(all.map(({range}) => range)),
    ranges: (all[0]?.ranges ?? []).map((_, c) => union(all.map(({ranges}) => ranges[c]!))),
  };
}

/** Values that span more than so many times the range of most instants are outlying. */
const kOutlyingRange = 4;

/**
 * Which instants are not outlying (simplify/SERIES.md, "Scales"): the nearer half, seen from the
 * first, and all up to the first outlying one.
 */
function usualOf(ranges: [number, number][]): boolean[] {
  const span = ([low, high]: [number, number]): number => high - low;
  const reaches = ranges.map((range) => span(union([ranges[0]!, range])));
  const order = [...ranges.keys()].sort((a, b) => reaches[a]! - reaches[b]! || a - b);
  const areUsual = ranges.map(() => false);
  let box = ranges[0]!;
  for (const [place, i] of order.entries()) {
    const more = union([box, ranges[i]!]);
    const isOutlying = span(box) > 0 && span(more) > kOutlyingRange * span(box);
    if (isOutlying && 2 * place >= ranges.length) break;
    box = more;
    areUsual[i] = true;
  }
  return areUsual;
}

/** The values that a component can have. */
function rangeOf({minimum, step, bits = 0}: FieldInfo, component: number): [number, number] {
  const low = minimum[component]!;
  return [low, low + step * (2 ** bits - 1)];
}

/** The instants of all series, each time once, ascending. */
export function timesOf(fields: readonly FieldInfo[]): Time[] {
  const times = new Map<number, string>();
  for (const {instant} of fields) if (instant) times.set(instant.time, instant.text);
  return [...times].map(([time, text]) => ({time, text})).sort((a, b) => a.time - b.time);
}

/** The time of a mesh that opens with the field: its own, or that of a series; null: no series. */
export function openingTime(fields: readonly FieldInfo[], field: number): Time | null {
  return fields[field]?.instant ?? fields.find(({instant}) => instant)?.instant ?? null;
}

/**
 * Lets each series' key mean its instant nearest to the time; null: that of the lowest number,
 * which stands in the head.
 */
export function showTime(fields: readonly FieldInfo[], time: number | null): void {
  const shown = new Map<string, Instant>();
  for (const {instant} of fields) {
    if (!instant) continue;
    instant.isShown = false;
    const best = shown.get(instant.series);
    if (!best || isNearer(instant, best, time)) shown.set(instant.series, instant);
  }
  for (const instant of shown.values()) instant.isShown = true;
}

/** The earlier one of two that are equally near; without a time none is nearer. */
function isNearer(a: Time, b: Time, time: number | null): boolean {
  if (time === null) return false;
  const more = Math.abs(a.time - time) - Math.abs(b.time - time);
  return more < 0 || (more === 0 && a.time < b.time);
}

/**
 * Among a mesh's keys that of the series' instant nearest to the time, without a time the first;
 * undefined for none.
 */
export function instantKey(
  keys: readonly string[],
  seriesKey: string,
  time: number | null,
): string | undefined {
  let best: {key: string; instant: Time} | undefined;
  for (const key of keys) {
    const instant = instantName(key);
    if (instant?.series !== seriesKey) continue;
    if (!best || isNearer(instant, best.instant, time)) best = {key, instant};
  }
  return best?.key;
}

/** The instant that is shown of the series with this key; -1 if there is no such series. */
export function fieldOfSeries(fields: readonly FieldInfo[], key: string): number {
  return fields.findIndex(({instant}) => instant?.isShown === true && instant.series === key);
}

/** The fields that are the instants of the series with this key, by time. */
export function instantsOf(fields: readonly FieldInfo[], key: string): readonly number[] {
  return fields.find(({instant}) => instant?.series === key)?.instant?.fields ?? [];
}

/** The instant that is shown of the field's series; a field of none is itself. */
export function shownInstant(fields: readonly FieldInfo[], field: number): number {
  const instant = fields[field]?.instant;
  return instant ? fieldOfSeries(fields, instant.series) : field;
}
