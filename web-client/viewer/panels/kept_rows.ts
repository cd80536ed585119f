// The rows of kept points and lines: their values, and the distances and angles between them. A
// title begins with a word of the viewer: a spreadsheet takes no name for a formula.

import {kMagnitude, type Scalar} from '../../core/picture/field_scale';
import {largestRoundingError, widthOfValues} from '../../core/protocol/fields';
import type {Vector} from '../../core/protocol/geometry';
import {errorsOfLevel} from '../../core/protocol/limit';
import type {Manifest} from '../../core/protocol/manifest';
import type {KeptValues, Pick} from '../../core/session/inspector';
import type {Kept} from '../settings/points';
import {valueOf} from './hover';
import type {Row} from './numbers_table';
import {scalarName} from './panel';
import {titleOf} from './pin';

export interface KeptScene {
  points: readonly Kept[];
  lines: readonly Kept[];
  values: KeptValues;
  color: Scalar | null;
  manifest: Manifest;
  level: number;
  /** The unit of lengths; empty: it is not known. */
  unit: string;
}

/** Numbers of points and lines. */
export interface Chosen {
  points: ReadonlySet<number>;
  lines: ReadonlySet<number>;
}

const kDegrees = 180 / Math.PI;

/** The largest error that is left in a value, as far as it is known. It is sampled. */
export function withinOf(field: number, {manifest, level}: KeptScene): number | undefined {
  const {fields, levels, original} = manifest;
  const info = fields[field]!;
  if (info.labels) return undefined;
  const isLast = level === levels.length - 1 && !original;
  if (isLast) return info.derived ? undefined : largestRoundingError(info);
  const most = (errorsOfLevel(levels, level)?.fields[field]?.max ?? NaN) * widthOfValues(info);
  return Number.isFinite(most) ? most : undefined;
}

/** Places, values and lengths. `hasAll`: those of all fields that are here, at points. */
export function valueRows(scene: KeptScene, hasAll: boolean): Row[] {
  const {color, lines, manifest, points, unit, values} = scene;
  const rows: Row[] = [];
  points.forEach((kept, i) => {
    const pick = values.points[i];
    const title = titleOf('points', kept, i);
    rows.push({title: `Place of ${title}`, values: drawnAt(kept, pick), unit});
    if (!pick) return;
    if (pick.rest) rows.push({title: `Place at rest of ${title}`, values: kept.places[0]!, unit});
    const scalars = hasAll ? scalarsOf(pick, manifest) : color ? [color] : [];
    for (const scalar of scalars) rows.push(...valueRow(scalar, pick, title, scene));
  });
  lines.forEach((kept, i) => {
    const line = values.lines[i];
    const title = titleOf('lines', kept, i);
    if (!line) return;
    rows.push({title: `Length of ${title}`, values: [line.length], unit});
    const info = color && manifest.fields[color.field];
    if (!info || info.labels || Number.isNaN(line.mean)) return;
    const name = scalarName(color, manifest.fields);
    const numbers = {Mean: line.mean, Least: line.least, Largest: line.largest};
    const of = bounded(color.field, scene);
    for (const [word, value] of Object.entries(numbers))
      rows.push({title: `${word} of ${name} along ${title}`, values: [value], ...of});
  });
  return rows;
}

function valueRow(scalar: Scalar, pick: Pick, title: string, scene: KeptScene): Row[] {
  const value = valueOf(pick, scalar);
  const name = scalarName(scalar, scene.manifest.fields);
  if (value === null) return [];
  return [
    {title: `Value of ${name} at ${title}`, values: [value], ...bounded(scalar.field, scene)},
  ];
}

function bounded(field: number, scene: KeptScene): Omit<Row, 'title' | 'values'> {
  const within = withinOf(field, scene);
  const unit = scene.manifest.fields[field]!.unit ?? '';
  return within === undefined ? {unit} : {unit, within};
}

/** Each component, and the magnitude of a vector. A series has the shown instant alone. */
function scalarsOf({fields}: Pick, manifest: Manifest): Scalar[] {
  return fields.flatMap(({field, values}) => {
    const info = manifest.fields[field];
    if (!info || info.instant?.isShown === false) return [];
    const parts = values.length > 1 ? [...values.keys()] : [];
    const whole = values.length === 1 || values.length === 3 ? [kMagnitude] : [];
    return [...parts, ...whole].map((component) => ({field, component}));
  });
}

/** Where a warp moves it. */
const drawnAt = ({places}: Kept, pick: Pick | null | undefined): Vector =>
  pick?.rest ? pick.position : places[0]!;

/**
 * The distance from each point to the next one, the angle at each between two others, and that from
 * each line to the next one. The chosen ones alone count, if these are two or more.
 */
export function measuredRows({points, lines, values, unit}: KeptScene, chosen: Chosen): Row[] {
  const at = measured(points.length, chosen.points).map((i) => ({
    title: titleOf('points', points[i]!, i),
    place: drawnAt(points[i]!, values.points[i]),
  }));
  const ways = measured(lines.length, chosen.lines).flatMap((i) => {
    const ends = values.lines[i]?.ends;
    const title = titleOf('lines', lines[i]!, i);
    return ends ? [{title, way: between(ends[0].position, ends[1].position)}] : [];
  });
  const distances = at.slice(1).map((to, i): Row => ({
    title: `Distance from ${at[i]!.title} to ${to.title}`,
    values: [Math.hypot(...between(at[i]!.place, to.place))],
    unit,
  }));
  const corners = at.slice(2).map((to, i): Row => {
    const [from, middle] = [at[i]!, at[i + 1]!];
    const its = angle(between(middle.place, from.place), between(middle.place, to.place));
    const title = `Angle at ${middle.title}, from ${from.title} to ${to.title}`;
    return {title, values: [its], unit: '\u00b0'};
  });
  const turns = ways.slice(1).map(({title, way}, i): Row => {
    const its = angle(ways[i]!.way, way);
    const name = `Angle between ${ways[i]!.title} and ${title}`;
    return {title: name, values: [Math.min(its, 180 - its)], unit: '\u00b0'};
  });
  return [...distances, ...corners, ...turns];
}

function measured(count: number, chosen: ReadonlySet<number>): number[] {
  const all = Array.from({length: count}, (_, i) => i);
  const some = all.filter((i) => chosen.has(i));
  return some.length > 1 ? some : all;
}

const between = (from: Vector, to: Vector): Vector =>
  to.map((x, axis) => x - from[axis]!) as Vector;

/** In degrees; NaN if one of them has no length. It is exact near 0 and 180 degrees, too. */
export function angle(a: Vector, b: Vector): number {
  const [p, q] = [Math.hypot(...a), Math.hypot(...b)];
  if (p === 0 || q === 0) return NaN;
  const [x, y] = [a.map((its) => its / p), b.map((its) => its / q)];
  const apart = Math.hypot(...x.map((its, axis) => its - y[axis]!));
  const together = Math.hypot(...x.map((its, axis) => its + y[axis]!));
  return 2 * Math.atan2(apart, together) * kDegrees;
}
