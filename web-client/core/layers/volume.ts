// The volume: the cells themselves, translucent. Its attribute holds the opacities of the transfer
// function.

import type {Ray, Stretch} from '../picture/cell_ray';
import type {Display, MeshArrays} from '../picture/display';
import {kMaxOpacity, kOpacityPath} from '../picture/transfer';
import {parseNumbers} from './field_values';
import type {Layer, LayerWork} from './layer';

export interface VolumeSetting {
  /** Opacities at even shares of the shown range; null: the volume is not shown. */
  volume: number[] | null;
  /** The volume's opacities are for the mesh to choose. */
  hasFirstOpacities: boolean;
}

/** The count of a volume's first opacities. */
const kKnots = 9;
/**
 * Values that fill less than this share of an even part of the volume are as dense as if they
 * filled it. Otherwise single cells would shine.
 */
const kMinShare = 0.1;

/** The most opacities of a volume: more cannot be told apart in the picture. */
export const kMaxOpacities = 33;

/** The attribute's value if the mesh is to choose. */
export const kAutoVolume = 'auto';
/** The mean optical depth of a volume that is seen at first: its inside shows, and its shape. */
const kFirstDepth = 1.7;
/** The mean length of lines through a mesh that is not known yet. */
const kUnknownChord = 0.25;

export interface Amounts {
  /** The shares of the volume in even parts of the values. */
  shares: readonly number[];
  /** The place on the shown range, of a share of the values. */
  placeOf: (share: number) => number;
}

/**
 * Opacities that make a mean line of sight kFirstDepth deep, whatever values the mesh has. Values
 * that fill less of it are denser, by the root of the amount: they would not be seen otherwise.
 *
 * `chord` is the mean length of lines through the mesh, as a share of the diagonal; 0: unknown.
 * `amounts` is null if the values are not known.
 */
export function firstOpacities(chord: number, amounts: Amounts | null = null): number[] {
  const shares = amounts ? sharesAtKnots(amounts) : [];
  const all = shares.reduce((sum, share) => sum + share, 0);
  const filled = Array.from({length: kKnots}, (_, k) => (all > 0 ? shares[k]! / all : 1 / kKnots));
  const shape = filled.map((share) => Math.max(share * kKnots, kMinShare) ** -0.5);
  const mean = shape.reduce((sum, depth, k) => sum + filled[k]! * depth, 0);
  const factor = (kFirstDepth * kOpacityPath) / (mean * (chord > 0 ? chord : kUnknownChord));
  return shape.map((depth) =>
    Number(Math.min(kMaxOpacity, 1 - Math.exp(-factor * depth)).toFixed(3)),
  );
}

/** Each amount counts for the two knots beside its value. */
function sharesAtKnots({shares: amounts, placeOf}: Amounts): number[] {
  const shares = new Array<number>(kKnots).fill(0);
  amounts.forEach((amount, i) => {
    const place = placeOf((i + 0.5) / amounts.length);
    const at = Math.min(1, Math.max(0, place)) * (kKnots - 1);
    const below = Math.min(kKnots - 2, Math.floor(at));
    shares[below]! += amount * (below + 1 - at);
    shares[below + 1]! += amount * (at - below);
  });
  return shares;
}

export function readVolume(text: string | null): VolumeSetting {
  if (text === null || !isVolume(text)) return {volume: null, hasFirstOpacities: false};
  const given = opacitiesIn(text);
  return {volume: given ?? firstOpacities(0), hasFirstOpacities: !given};
}

function opacitiesIn(text: string): number[] | null {
  const numbers = parseNumbers(text);
  const areOpacities =
    numbers.length >= 2 &&
    numbers.length <= kMaxOpacities &&
    numbers.every((value) => value >= 0 && value <= 1);
  return areOpacities ? numbers : null;
}

export function isVolume(text: string): boolean {
  return text === '' || text === kAutoVolume || opacitiesIn(text) !== null;
}

export const volume = {
  name: 'volume',
  requestOf: (display: Display): true | null => display.volume || null,
} as const satisfies Layer;

export const volumeWork = {
  layer: volume,

  seenFrom: (_: MeshArrays, display: Display, __: Ray, stretch: Stretch): number =>
    display.volume ? stretch.from : Infinity,
} satisfies LayerWork;
