// The deformed shape: which field of vectors moves the mesh, and how far.

import {parseScalar, scalarText} from '../../core/layers/field_values';
import {kMagnitude} from '../../core/picture/field_scale';
import type {Warp} from '../../core/picture/warp';
import {sidesOf} from '../../core/protocol/geometry';
import type {FieldInfo} from '../../core/protocol/fields';
import type {Manifest} from '../../core/protocol/manifest';
import type {Settings} from './settings';

/** Names of the displacement of a solid. CalculiX, Code_Aster and others shorten it. */
const kDisplacement = /^(displacements?|displ?|u_?disp|depl)$/i;

/** The largest displacement is seen at true size if it is at least this share of the diagonal. */
const kSeenShare = 0.01;
/** An automatic scale enlarges it to at most this share. */
const kFirstShare = 0.1;
/** Vectors longer than this share of the diagonal are no displacements of this mesh. */
const kLongestShare = 1;

/** The largest displacement at the slider's end, as a share of the diagonal. */
const kMaxShare = 0.4;
/** The slider's end, in automatic scales, is at least this. */
const kMinEnd = 4;

/** The volume of a regular tetrahedron of edge 1. */
const kUnitVolume = Math.SQRT2 / 12;

/** The attribute's text for a mesh that stays at rest. */
export const kNoWarp = 'off';

/** The mesh, as far as a warp needs it. */
export interface Warpable {
  manifest: Manifest | null;
  /** In lattice coordinates; empty: not known yet. */
  bounds: number[];
}

const isVectors = ({association, components}: FieldInfo): boolean =>
  association === 'point' && components === 3;

/** Vectors that have such a name, those of points or of cells. */
export const isDisplacement = ({components, name, instant}: FieldInfo): boolean =>
  components === 3 && kDisplacement.test(instant?.name ?? name);

/** Among keys of fields that of displacements, which may move the first picture; null: none. */
export const displacementKey = (keys: readonly string[]): string | null =>
  keys.find((key) => kDisplacement.test(key)) ?? null;

/** The fields that can move the mesh: displacements first. Series have their shown instant. */
export function warpFields(fields: readonly FieldInfo[]): number[] {
  const usable = [...fields.keys()].filter(
    (field) => isVectors(fields[field]!) && fields[field]!.instant?.isShown !== false,
  );
  const rank = (field: number): number => (isDisplacement(fields[field]!) ? 0 : 1);
  return usable.sort((a, b) => rank(a) - rank(b));
}

/** The field that the attribute's text names; -1 if it names none, or none of vectors of points. */
export function warpField(text: string | null, fields: readonly FieldInfo[]): number {
  const scalar = parseScalar(text, fields);
  const fits = scalar?.component === kMagnitude && isVectors(fields[scalar.field]!);
  return fits ? scalar.field : -1;
}

/** True size if its displacements are seen, else a round number that makes them so. */
export function automaticScale(field: number, {manifest, bounds}: Warpable): number {
  const share = largestShare(field, {manifest, bounds});
  if (share === 0) return 1;
  return share >= kSeenShare && share <= kLongestShare ? 1 : roundBelow(kFirstShare / share);
}

/** The scale at the slider's end. */
export function largestScale(field: number, mesh: Warpable): number {
  const share = largestShare(field, mesh);
  const least = kMinEnd * automaticScale(field, mesh);
  return share > 0 ? Math.max(least, roundBelow(kMaxShare / share)) : least;
}

/**
 * The key of the displacement that moves the mesh if no attribute says otherwise; null: it rests.
 * The largest one must pass an edge of the whole mesh, and must be seen at true size. The mean edge
 * is that of as many regular cells as the mesh has, if they filled its box. A mesh that fills less
 * of its box has shorter edges.
 */
export function firstWarp(mesh: Warpable): string | null {
  const {manifest, bounds} = mesh;
  if (!manifest || bounds.length === 0) return null;
  const {fields, levels} = manifest;
  const field = warpFields(fields).find((its) => isDisplacement(fields[its]!));
  const cells = levels.at(-1)?.tetrahedra ?? 0;
  if (field === undefined || cells === 0) return null;
  const sides = sidesOf(bounds);
  const volume = sides.reduce((product, side) => product * side, 1);
  const edge = Math.cbrt(volume / cells / kUnitVolume) / Math.hypot(...sides);
  const share = largestShare(field, mesh);
  const moves = share > edge && share >= kSeenShare && share <= kLongestShare;
  return moves ? scalarText({field, component: kMagnitude}, fields) : null;
}

/** The longest vector as a share of the diagonal; 0 if that is not known. */
function largestShare(field: number, {manifest, bounds}: Warpable): number {
  if (!manifest || bounds.length === 0) return 0;
  const diagonal = manifest.lattice.step * Math.hypot(...sidesOf(bounds));
  const share = manifest.fields[field]!.range[1] / diagonal;
  return Number.isFinite(share) ? share : 0;
}

/** The next of 1, 2, 5, 10, 20 ... that is not above the number. */
function roundBelow(number: number): number {
  const decade = 10 ** Math.floor(Math.log10(number));
  const digit = [5, 2, 1].find((times) => times * decade <= number * (1 + 1e-9)) ?? 1;
  return Number((digit * decade).toPrecision(1));
}

/** The warp of the settings; null if the mesh stays at rest. */
export function warpOf({warp, warpScale}: Settings, mesh: Warpable): Warp | null {
  const field = warpField(warp, mesh.manifest?.fields ?? []);
  return field < 0 ? null : {field, scale: warpScale ?? automaticScale(field, mesh)};
}
