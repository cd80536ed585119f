// The part of core/lines for pictures, once it is loaded.

import type {Assembler} from '../decode/assembler';
import type {Display, MeshArrays} from './display';
import type {LineSoup} from './streamlines';

/** It is loaded with the first request. */
export const lineMaking: {
  /** Null: there are no lines yet. */
  make?: (assembler: Assembler, mesh: MeshArrays, display: Display) => LineSoup | null;
} = {};
