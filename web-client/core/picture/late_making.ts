// The makers of lines, arrows and volumes. They are loaded with the first display that has some.

import type {Assembler} from '../decode/assembler';
import type {ArrowSoup} from './arrows';
import type {Display, MeshArrays} from './display';
import type {LineSoup} from './streamlines';
import type {volumeCells} from './volume_cells';

export interface PictureMesh extends MeshArrays {
  /** The cells that are not hidden; null means all. */
  kept: Uint8Array | null;
}

type Make<Soup> = (assembler: Assembler, mesh: PictureMesh, display: Display) => Soup | null;

export const lateMaking: {
  /** They give null while there is nothing to draw yet. */
  lines?: Make<LineSoup>;
  arrows?: Make<ArrowSoup>;
  volume?: typeof volumeCells;
} = {};
