// The ground behind the mesh, as the attribute says it: a name, or a colour as RRGGBB.

import {parseHex} from '../../core/picture/color_map_text';

/** style.css has a rule for each. */
export const kGrounds = ['light', 'dark', 'white'];

export const isGround = (text: string): boolean =>
  kGrounds.includes(text) || parseHex(text) !== null;
