// The rows of numbers about what is drawn, as texts and as CSV. They are loaded on use.

import {widthOfValues, type FieldInfo} from '../../core/protocol/fields';
import {errorsOfLevel} from '../../core/protocol/limit';
import type {Manifest} from '../../core/protocol/manifest';
import type {Vector} from '../../core/protocol/geometry';
import type {Numbers} from '../../core/session/inspector';
import {formatTo, formatValue, roundedUp} from '../page/format';
import {csvOf, type Same} from './line_table';
import {scalarName} from './panel';

export {timeTitle} from './line_table';
export {cutOf, fileNameOf, originOf} from './origin';

export interface Row {
  title: string;
  /** One, or the three of a vector. */
  values: number[];
  unit: string;
  /** Smaller ones may come from rounding where parts cancel each other. */
  noise?: number;
  /** The known error that is left, as far as a rule gives it. */
  within?: number;
}

/** Values in triangles have 24 bits. */
const kNoise = 1e-6;

/** "kg/m2 · m2": empty if one of them is not known. */
const product = (a: string, b: string): string => (a && b ? `${a}\u00b7${b}` : '');
const power = (unit: string, exponent: string): string => unit && `${unit}${exponent}`;

/** `length` is the unit of lengths; empty: it is not known. */
export function rowsOf(numbers: Numbers, manifest: Manifest, length: string): Row[] {
  const {body, color, cuts, isosurfaces, surface, vector: flux} = numbers;
  const {fields, lattice} = manifest;
  const info = color ? fields[color.field]! : null;
  const isLabel = info?.labels !== undefined;
  const name = color ? scalarName(color, fields) : '';
  const vector = flux ? fields[flux.field]! : null;
  const fluxName = flux ? scalarName(flux, fields).replace(/, magnitude$/, '') : '';
  const [area, volume] = [power(length, '\u00b2'), power(length, '\u00b3')];
  const unit = info?.unit ?? '';
  const known = knownErrors(numbers, manifest);
  const size = (its: {size: number}, exponent: number): number[] => [
    its.size * lattice.step ** exponent,
  ];
  const squared = lattice.step ** 2;
  /** Labels have no mean. */
  const mean = (title: string, its: {mean: number; valued: number}, within?: number): Row[] =>
    isLabel || its.valued === 0
      ? []
      : [{title, values: [its.mean], unit, ...(within !== undefined && {within})}];
  const noiseOf = ({range}: FieldInfo, its: {size: number}): number =>
    kNoise * Math.max(...range.map(Math.abs)) * its.size * squared;
  const through = (title: string, its: {size: number; flux: number | null}): Row[] => {
    if (its.flux === null || !vector) return [];
    const noise = noiseOf(vector, its);
    return [{title, values: [its.flux * squared], unit: product(vector.unit ?? '', area), noise}];
  };
  const rows: Row[] = [];
  if (body) {
    rows.push({title: 'Volume', values: size(body, 3), unit: volume, ...known.volume});
    rows.push(...mean(`Mean of ${name}`, body, known.mean));
    if (!isLabel && body.valued > 0)
      rows.push(
        {title: 'Standard deviation', values: [body.deviation], unit},
        {title: 'Least', values: [body.least!.value], unit},
        {title: 'Largest', values: [body.largest!.value], unit},
      );
    if (color && body.valued < body.size)
      rows.push({
        title: 'Volume with values',
        values: [body.valued * lattice.step ** 3],
        unit: volume,
      });
  }
  if (surface) {
    rows.push({title: 'Area of the surface', values: size(surface, 2), unit: area});
    if (surface.force && !isLabel && info!.components === 1)
      rows.push({
        title: `${name} \u00d7 normal over the surface`,
        values: surface.force.map((x) => x * squared),
        unit: product(unit, area),
        noise: noiseOf(info!, surface),
      });
    rows.push(...through(`Flux of ${fluxName} out of the surface`, surface));
  }
  cuts.forEach((cut, i) => {
    const title = cuts.length > 1 ? `cut ${i + 1}` : 'the cut';
    rows.push({title: `Area of ${title}`, values: size(cut, 2), unit: area});
    rows.push(...mean(`Mean on ${title}`, cut));
    rows.push(
      ...through(`Flux of ${fluxName} through ${title}, along ${directionOf(cut.normal)}`, cut),
    );
  });
  if (isosurfaces) {
    rows.push({title: 'Area of the isosurfaces', values: size(isosurfaces, 2), unit: area});
    rows.push(...mean('Mean on the isosurfaces', isosurfaces));
  }
  return rows;
}

/** "−y", or "(0.6, −0.8, 0)". */
function directionOf(normal: Vector): string {
  const axis = normal.findIndex((x) => Math.abs(x) === 1);
  if (axis >= 0) return `${normal[axis]! < 0 ? '\u2212' : '+'}${'xyz'[axis]!}`;
  return `(${normal.map((x) => formatTo(x, 1e-3)).join(', ')})`;
}

/**
 * A level lacks parts of the original, and has others too much. They change a mean by no more than
 * the larger share of the volume times the range. Elsewhere the rms bounds the change. The log
 * knows both of the whole mesh alone.
 */
function knownErrors(
  {body, color, isWhole, level}: Numbers,
  {fields, levels, lattice}: Manifest,
): {volume?: {within: number}; mean?: number} {
  const error = isWhole && body ? errorsOfLevel(levels, level) : undefined;
  if (!error || !body) return {};
  const {volumeGained: more, volumeLost: less} = error;
  const share = Math.max(more, less);
  const volume = {within: (body.size * lattice.step ** 3 * share) / (1 - less + more)};
  const info = color && fields[color.field];
  if (!info) return {volume};
  const mean =
    (error.fields[color.field]?.mean ?? NaN) * widthOfValues(info) + share * spanOf(info);
  const isKnown = Number.isFinite(mean) && body.valued === body.size;
  return isKnown ? {volume, mean} : {volume};
}

/** No two values of it, or of a component, are further apart. */
const spanOf = ({components, range: [low, high]}: FieldInfo): number =>
  components === 1 ? high - low : 2 * high;

/** Five digits, but none below what rounding leaves. */
export function valueText({values, noise = 0}: Row): string {
  const most = Math.max(...values.map(Math.abs));
  if (values.length === 1 && !(most < noise)) return formatValue(most === 0 ? 0 : values[0]!);
  const digit = most > noise ? 10 ** (Math.floor(Math.log10(most)) - 4) : 1;
  return values.map((x) => (Math.abs(x) < noise ? '0' : formatTo(x, digit))).join(', ');
}

/** "within 0.012"; empty: no error is left, or it is not known. */
export const withinText = ({within = 0, unit}: Row): string =>
  within > 0 ? `within ${roundedUp(within)}${unit && `\u202f${unit}`}` : '';

/** Writes the rows into a list of terms. */
export function fillRows(list: HTMLElement, rows: readonly Row[]): void {
  list.replaceChildren(
    ...rows.map((row) => {
      const line = document.createElement('div');
      const value = document.createElement('dd');
      const [unit, within] = [document.createElement('span'), document.createElement('small')];
      unit.textContent = row.unit && `\u202f${row.unit}`;
      within.textContent = withinText(row);
      value.append(valueText(row), unit, within);
      line.append(Object.assign(document.createElement('dt'), {textContent: row.title}), value);
      return line;
    }),
  );
}

/** Lines with tabs, for spreadsheets and reports. */
export const textOfRows = (rows: readonly Row[]): string =>
  rows
    .map((row) =>
      [row.title, valueText(row), row.unit, withinText(row)]
        .join('\t')
        .replaceAll('\u2212', '-')
        .trim(),
    )
    .join('\n');

/** A row for each number; those of vectors have their axes in the title. */
export function tableOfRows(rows: readonly Row[], same: Same): Blob {
  const lines = rows.flatMap(({title, values, unit, within = NaN}) =>
    values.map((value, axis) => [
      `${title}${values.length > 1 ? `, ${'xyz'[axis]!}` : ''}`,
      value,
      unit,
      within,
    ]),
  );
  return csvOf([['quantity', 'value', 'unit', 'within'], ...lines], same);
}
