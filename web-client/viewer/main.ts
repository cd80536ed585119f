// The demo page: the viewer over the whole window, told by the address what to show.

import {QtetViewer} from './qtet_viewer';

declare global {
  interface Window {
    qtetViewer: QtetViewer;
  }
}

/** Query parameter -> attribute of the viewer. */
const kParameters: Record<string, string> = {mesh: 'mesh', field: 'field', colormap: 'colormap', edges: 'edges', clip: 'clip', pauseAfter: 'pause-after'};

customElements.define('qtet-viewer', QtetViewer);
const viewer = document.createElement('qtet-viewer') as QtetViewer;
const query = new URLSearchParams(location.search);
for (const [parameter, attribute] of Object.entries(kParameters)) {
  const value = query.get(parameter);
  if (value !== null && value !== '') viewer.setAttribute(attribute, value);
}
window.qtetViewer = viewer;
document.body.append(viewer);
