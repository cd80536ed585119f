// Arrows: vectors at places. Its attributes are read by arrows_text.ts, and its arrows are made by
// core/lines. Both are loaded on use.

import type {Display} from '../picture/display';
import type {Layer} from './layer';

export const arrows = {
  name: 'arrows',
  more: [
    {name: 'arrow-places'},
    {name: 'arrow-density'},
    {name: 'arrow-length'},
    {name: 'arrow-size'},
    {name: 'arrow-color'},
  ],
  requestOf: (display: Display) => display.arrows ?? null,
} as const satisfies Layer;
