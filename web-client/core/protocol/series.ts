// Series: fields that are the instants of one quantity, called NAME@TIME (codec/RECORDS.md,
// "Series").

import {fieldKeys, type FieldInfo, type Instant} from './fields';

/** TIME of a name NAME@TIME. */
const kDecimal = /^-?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

/**
 * Marks the instants of all series of two and more, the first of each as shown. They get one range:
 * that of the whole series.
 */
export function markSeries(fields: FieldInfo[]): void {
  const members = new Map<string, FieldInfo[]>();
  fieldKeys(fields).forEach((key, field) => {
    const at = key.lastIndexOf('@');
    const text = key.slice(at + 1);
    const time = kDecimal.test(text) ? Number(text) : NaN;
    if (at < 1 || !Number.isFinite(time)) return;
    const info = fields[field]!;
    info.instant = {series: key.slice(0, at), time, text, isShown: false};
    const {association, components} = info;
    const kind = JSON.stringify([info.instant.series, association, components]);
    members.set(kind, [...(members.get(kind) ?? []), info]);
  });
  for (const infos of members.values()) {
    if (infos.length < 2) {
      for (const info of infos) delete info.instant;
      continue;
    }
    const ranges = infos.map(({range}) => range);
    const all: [number, number] = [
      Math.min(...ranges.map(([low]) => low)),
      Math.max(...ranges.map(([, high]) => high)),
    ];
    for (const info of infos) info.range = all;
  }
  showTime(fields, null);
}

/** The instants of all series, each time once, ascending. */
export function timesOf(fields: readonly FieldInfo[]): {time: number; text: string}[] {
  const times = new Map<number, string>();
  for (const {instant} of fields) if (instant) times.set(instant.time, instant.text);
  return [...times].map(([time, text]) => ({time, text})).sort((a, b) => a.time - b.time);
}

/** Lets each series' key mean its instant nearest to the time; null: the first one. */
export function showTime(fields: readonly FieldInfo[], time: number | null): void {
  const nearest = new Map<string, Instant>();
  const distance = (instant: Instant): number =>
    time === null ? instant.time : Math.abs(instant.time - time);
  for (const {instant, association} of fields) {
    if (!instant) continue;
    instant.isShown = false;
    const kind = `${association} ${instant.series}`;
    const best = nearest.get(kind);
    const isNearer = !best || distance(instant) < distance(best);
    const isEarlier = best && distance(instant) === distance(best) && instant.time < best.time;
    if (isNearer || isEarlier) nearest.set(kind, instant);
  }
  for (const instant of nearest.values()) instant.isShown = true;
}

/** The instant that is shown of the field's series; a field of none is itself. */
export function shownInstant(fields: readonly FieldInfo[], field: number): number {
  const info = fields[field];
  if (!info?.instant) return field;
  return fields.findIndex(
    ({instant, association}) =>
      instant?.isShown === true &&
      instant.series === info.instant!.series &&
      association === info.association,
  );
}
