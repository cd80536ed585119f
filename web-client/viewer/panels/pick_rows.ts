// The texts about a point of the mesh.

import type {Scalar} from '../../core/picture/field_scale';
import type {Vector} from '../../core/protocol/geometry';
import type {Manifest} from '../../core/protocol/manifest';
import type {Pick} from '../../core/session/inspector';
import {formatCount, formatIn, formatTo} from '../page/format';
import {hoverText} from './hover';
import {withUnit} from './panel';

/** Places are shown to this share of the lattice's span. */
const kPlaceShare = 1e-4;

/** Rounds to a ten-thousandth of the lattice's span. */
export function placeText(place: Vector, {lattice: {bits, step}}: Manifest): string {
  return place.map((x) => formatTo(x, kPlaceShare * step * 2 ** bits)).join(', ');
}

export function pickTitle(pick: Pick, color: Scalar | null, {fields}: Manifest): string {
  return (color && hoverText(pick, color, fields)) ?? 'Point';
}

export function pickRows(pick: Pick, manifest: Manifest): [string, string][] {
  const {fields} = manifest;
  const rows: [string, string][] = [['Position', placeText(pick.position, manifest)]];
  if (pick.rest) rows.push(['Position at rest', placeText(pick.rest.position, manifest)]);
  for (const {field, values} of pick.fields) {
    const info = fields[field];
    // there may be a thousand instants, and a derived field may have gone
    if (!info || info.instant?.isShown === false) continue;
    const format = (value: number): string => formatIn(info, value);
    rows.push([withUnit(info.title ?? info.name, info), values.map(format).join(', ')]);
    if (values.length > 1)
      rows.push([withUnit(`${info.name}, magnitude`, info), format(Math.hypot(...values))]);
  }
  rows.push(['Cell', formatCount(pick.cell)]);
  rows.push(['Its corners', pick.corners.map(formatCount).join(', ')]);
  return rows;
}
