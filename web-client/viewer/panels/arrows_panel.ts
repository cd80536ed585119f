// The section of arrows.

import {kArrowComponents} from '../../core/layers/arrows_text';
import {vectorFields} from '../../core/layers/streamlines_text';
import {latePanel} from './late_panel';

export const arrowsPanel = latePanel({
  name: 'arrows',
  suits: (fields) => vectorFields(fields, kArrowComponents).length > 0,
  load: async (tools, place) => {
    const {ArrowsControls} = await import('./arrows_controls');
    return new ArrowsControls(tools, place);
  },
});
