// A line's places and values, and a point's values over time, as CSV.

import type {LineValues} from '../../core/session/inspector';
import type {FieldInfo} from '../../core/protocol/fields';
import {scalarTitle} from './panel';

/** More are noise of the arithmetic: a float has nine, and a large coordinate some more. */
const kDigits = 12;

/** Columns behind the others, by their titles. They say the same in each row. */
export type Same = readonly (readonly [title: string, value: string | number])[];

/**
 * Each row is a place: distance, position, and each component of the fields that are here. Behind a
 * label with names stands the value's name.
 */
export function tableOf(
  places: readonly LineValues[],
  infos: readonly FieldInfo[],
  same: Same = [],
): Blob {
  const here = places.find(({fields}) => fields.length > 0)?.fields ?? [];
  const titles = here.flatMap(({field, values}) => titlesOf(field, values, infos));
  const rows = places.map(({at, position, fields}) => {
    const values = fields.flatMap((its) => withNames(its.values, infos[its.field]!));
    return [at, ...position, ...titles.map((_, i) => values[i] ?? NaN)];
  });
  return csvOf([['distance', 'x', 'y', 'z', ...titles], ...rows], same);
}

/** By instant its time, and one value a component; none of an instant that is not here. */
export interface TimeTable {
  /** One of the instants. */
  field: number;
  times: readonly number[];
  values: readonly number[][];
}

/** Each row is an instant: its time, and each component. */
export function timeTableOf(
  {field, times, values}: TimeTable,
  infos: readonly FieldInfo[],
  timeUnit?: string,
  same: Same = [],
): Blob {
  const info = infos[field]!;
  const titles = titlesOf(field, info.minimum, infos);
  const rows = times.map((time, i) => {
    const its = withNames(values[i]!, info);
    return [time, ...titles.map((_, component) => its[component] ?? NaN)];
  });
  return csvOf([[timeTitle(timeUnit), ...titles], ...rows], same);
}

export const timeTitle = (unit?: string): string => (unit ? `time [${unit}]` : 'time');

function titlesOf(
  field: number,
  components: readonly number[],
  infos: readonly FieldInfo[],
): string[] {
  const titles = components.map((_, component) => scalarTitle({field, component}, infos));
  return hasNames(infos[field]!) ? [...titles, `${titles[0]!}, name`] : titles;
}

function withNames(values: readonly number[], info: FieldInfo): (string | number)[] {
  return hasNames(info) && values.length > 0
    ? [...values, info.labels?.get(values[0]!) ?? NaN]
    : [...values];
}

const hasNames = ({labels}: FieldInfo): boolean => labels !== undefined && labels.size > 0;

/** The first row has the titles. */
export function csvOf(table: (string | number)[][], same: Same): Blob {
  const rows = table.map((row, i) => [
    ...row,
    ...same.map(([title, value]) => (i > 0 ? value : title)),
  ]);
  return new Blob([rows.map((row) => row.map(cell).join(',')).join('\r\n')], {type: 'text/csv'});
}

/**
 * A missing value is an empty cell. A name is a stranger's: behind an apostrophe no spreadsheet
 * takes it for a formula (OWASP, "CSV Injection").
 */
function cell(value: string | number): string {
  if (typeof value === 'string')
    return `"${/^[=+\-@\t\r]/.test(value) ? "'" : ''}${value.replaceAll('"', '""')}"`;
  return Number.isNaN(value) ? '' : String(Number(value.toPrecision(kDigits)));
}
