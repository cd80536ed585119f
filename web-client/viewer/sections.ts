// The sections of the panel, and the panels in them. Another panel takes a file and a line here.

import {filePanel} from './drop/file_panel';
import {arrowsPanel} from './panels/arrows_panel';
import {axesPanel} from './panels/axes_panel';
import {clipPanel} from './panels/clip_panel';
import {colorPanel, stepsPanel} from './panels/color_panel';
import {groundPanel} from './panels/ground_panel';
import {histogramPanel} from './panels/histogram_panel';
import {kToolMarkup} from './panels/inspect';
import {levelPanel} from './panels/level_panel';
import {numbersPanel} from './panels/numbers_panel';
import type {PanelKind} from './panels/panel';
import {ownFieldsPanel} from './panels/own_fields_panel';
import {partsPanel} from './panels/parts_panel';
import {pinsPanel} from './panels/pins';
import {streamlinesPanel} from './panels/streamlines_panel';
import {statisticsPanel} from './panels/statistics_panel';
import {surfacePanel} from './panels/surface_panel';
import {valuePanels} from './panels/value_panel';
import {viewPanel} from './panels/view_panel';
import {volumePanel} from './panels/volume_panel';
import {warpPanel} from './panels/warp_panel';

interface Section {
  /** Its state, open or folded, is kept under this name (folds.ts). */
  name: string;
  title: string;
  isFolded?: true;
  panels: PanelKind[];
}

const kSections: readonly Section[] = [
  {name: 'colours', title: 'Field and colours', panels: [colorPanel, histogramPanel, stepsPanel]},
  {name: 'own-fields', title: 'Own fields', isFolded: true, panels: [ownFieldsPanel]},
  {name: 'surface', title: 'Surface', panels: [surfacePanel]},
  {name: 'parts', title: 'Parts', isFolded: true, panels: [partsPanel]},
  {name: 'deform', title: 'Deform', panels: [warpPanel]},
  {
    name: 'inside',
    title: 'Inside',
    panels: [clipPanel, ...valuePanels(true), volumePanel, ...valuePanels(false)],
  },
  {name: 'streamlines', title: 'Streamlines', isFolded: true, panels: [streamlinesPanel]},
  {name: 'arrows', title: 'Arrows', isFolded: true, panels: [arrowsPanel]},
  {name: 'pointer', title: 'Pointer', panels: [{markup: kToolMarkup}, pinsPanel]},
  {name: 'numbers', title: 'Numbers', isFolded: true, panels: [numbersPanel]},
  {name: 'level', title: 'Level of detail', isFolded: true, panels: [levelPanel]},
  {name: 'view', title: 'View', isFolded: true, panels: [viewPanel, axesPanel, groundPanel]},
  {name: 'file', title: 'File', isFolded: true, panels: [filePanel]},
  {name: 'statistics', title: 'Statistics', isFolded: true, panels: [statisticsPanel]},
];

export const kPanelKinds: readonly PanelKind[] = kSections.flatMap(({panels}) => panels);

export const kControls = kSections
  .map(
    ({name, title, isFolded, panels}) => `
<details data-fold="${name}"${isFolded ? '' : ' open'}>
  <summary>${title}</summary>
  <div class="sub">${panels.map(({markup}) => markup).join('')}
  </div>
</details>`,
  )
  .join('');
