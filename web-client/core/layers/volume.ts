// The volume: the cells themselves, translucent. Its attribute holds the opacities of the transfer
// function.

import type {Ray, Stretch} from '../picture/cell_ray';
import type {Display, MeshArrays} from '../picture/display';
import {kMaxOpacity, kOpacityPath} from '../picture/transfer';
import {parseNumbers} from './field_values';
import type {Layer} from './layer';

export interface VolumeSetting {
  /** Opacities at even shares of the shown range; null: the volume is not shown. */
  volume: number[] | null;
  /** The volume's opacities are for the mesh to choose. */
  hasFirstOpacities: boolean;
}

/**
 * The shape of a volume's first opacities: low values are faint, so that its whole shape is
 * visible, and high ones dense.
 */
const kFirstOpacities: readonly number[] = [0.03, 0.04, 0.06, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9];

/** The most opacities of a volume: more cannot be told apart in the picture. */
export const kMaxOpacities = 33;

/** The attribute's value if the mesh is to choose. */
export const kAutoVolume = 'auto';
/** The mean optical depth of a volume that is seen at first: its inside shows, and its shape. */
const kFirstDepth = 0.9;

/** `chord` is the mean length of lines through the mesh, as a share of the diagonal; 0: unknown. */
export function firstOpacities(chord: number): number[] {
  const depths = kFirstOpacities.map((opacity) => -Math.log(1 - opacity));
  const mean = depths.reduce((sum, depth) => sum + depth, 0) / depths.length;
  const factor = chord > 0 ? (kFirstDepth * kOpacityPath) / (mean * chord) : 1;
  return depths.map((depth) =>
    Number(Math.min(kMaxOpacity, 1 - Math.exp(-factor * depth)).toFixed(3)),
  );
}

export function readVolume(text: string | null): VolumeSetting {
  if (text === null) return {volume: null, hasFirstOpacities: false};
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

function isRight(text: string): boolean {
  return text === '' || text === kAutoVolume || opacitiesIn(text) !== null;
}

export const volume = {
  name: 'volume',
  isRight,
  expected: `2 to ${kMaxOpacities} opacities from 0 to 1, or ${kAutoVolume}`,
  requestOf: (display: Display): true | null => display.volume || null,
  seenFrom: (_: MeshArrays, display: Display, __: Ray, stretch: Stretch): number =>
    display.volume ? stretch.from : Infinity,
} as const satisfies Layer;
