// The section of streamlines.

import {vectorFields} from '../../core/layers/streamlines_text';
import {latePanel} from './late_panel';

export const streamlinesPanel = latePanel({
  name: 'streamlines',
  suits: (fields) => vectorFields(fields).length > 0,
  load: async (tools, place) => {
    const {StreamlinesControls} = await import('./streamlines_controls');
    return new StreamlinesControls(tools, place);
  },
});
