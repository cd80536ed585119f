// The parts of core/lines for pictures. Each is loaded with the first request for it.

import type {Assembler} from '../decode/assembler';
import type {ArrowSoup} from './arrows';
import type {Display, MeshArrays} from './display';
import type {LineSoup} from './streamlines';

export interface PictureMesh extends MeshArrays {
  /** The cells that are not hidden; null means all. */
  kept: Uint8Array | null;
}

type Make<Soup> = (assembler: Assembler, mesh: PictureMesh, display: Display) => Soup | null;

/** They give null while there is nothing to draw yet. */
export const lateMaking: {lines?: Make<LineSoup>; arrows?: Make<ArrowSoup>} = {};
