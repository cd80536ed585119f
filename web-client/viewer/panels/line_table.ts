// A line's places and values, and a point's values over time, as CSV.

import type {LineValues} from '../../core/session/inspector';
import type {FieldInfo} from '../../core/protocol/fields';
import {scalarTitle} from './panel';

/** More are noise of the arithmetic: a float has nine, and a large coordinate some more. */
const kDigits = 12;

/** Each row is a place: distance, position, and each component of the fields that are here. */
export function tableOf(places: readonly LineValues[], infos: readonly FieldInfo[]): Blob {
  const here = places.find(({fields}) => fields.length > 0)?.fields ?? [];
  const titles = here.flatMap(({field, values}) =>
    values.map((_, component) => scalarTitle({field, component}, infos)),
  );
  const rows = places.map(({at, position, fields}) => {
    const values = fields.flatMap((its) => its.values);
    return [at, ...position, ...titles.map((_, i) => values[i] ?? NaN)];
  });
  return csvOf([['distance', 'x', 'y', 'z', ...titles], ...rows]);
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
): Blob {
  const titles = infos[field]!.minimum.map((_, component) =>
    scalarTitle({field, component}, infos),
  );
  const rows = times.map((time, i) => [
    time,
    ...titles.map((_, component) => values[i]![component] ?? NaN),
  ]);
  return csvOf([[timeUnit ? `time [${timeUnit}]` : 'time', ...titles], ...rows]);
}

function csvOf(table: (string | number)[][]): Blob {
  return new Blob([table.map((row) => row.map(cell).join(',')).join('\r\n')], {type: 'text/csv'});
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
