// Streamlines: lines along a field of vectors. Its attributes are read by streamlines_text.ts, and
// its lines are made by core/lines. Both are loaded on use.

import type {Display} from '../picture/display';
import type {Layer} from './layer';

export const streamlines = {
  name: 'streamlines',
  more: [
    {name: 'streamline-kind'},
    {name: 'seeds'},
    {name: 'streamline-look'},
    {name: 'streamline-limits'},
  ],
  requestOf: (display: Display) => display.streamlines ?? null,
} as const satisfies Layer;
