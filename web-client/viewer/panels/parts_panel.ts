// The section of parts.

import {partFields} from '../../core/layers/parts_text';
import {latePanel} from './late_panel';

export const partsPanel = latePanel({
  name: 'parts',
  suits: (fields) => partFields(fields).length > 0,
  load: async (tools, place) => {
    const {PartsList} = await import('./parts_list');
    return new PartsList(tools, place);
  },
});
