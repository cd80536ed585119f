// The demo page: the viewer fills the window. The address says what is shown and follows changes,
// so that a link is a picture.

import './element';
import {trustOwnWorkers} from './page/own_workers';
import type {QtetViewer} from './qtet_viewer';
import {kViewAttributes} from './settings/settings';
import {linkTo} from './settings/share';

declare global {
  interface Window {
    qtetViewer: QtetViewer;
  }
}

trustOwnWorkers();
const viewer = document.createElement('qtet-viewer');
/** `qtet publish` puts it into the page: where the list of the folder's meshes is. */
const published = document.querySelector<HTMLMetaElement>('meta[name=qtet-src]');
if (published) viewer.setAttribute('src', published.content);
/** A page that holds its mesh may hold its first view, too: `qtet page --view`. */
const view = document.querySelector<HTMLMetaElement>('meta[name=qtet-view]')?.content ?? '';
const query = new URLSearchParams(location.search || view);
for (const name of ['src', 'transport', ...kViewAttributes]) {
  const value = query.get(name);
  if (value !== null && value !== '') viewer.setAttribute(name, value);
}
viewer.unknown = [...query.keys()];
/** Browsers allow a few hundred changes of the address in half a minute. A slider makes more. */
const kRestMs = 300;
let timer: ReturnType<typeof setTimeout> | undefined;
const src = viewer.getAttribute('src');
const remember = (): void => {
  // No address leads to a file that was dropped.
  if (viewer.getAttribute('src') !== src) return;
  const origin = ['src', 'transport'].flatMap((name) =>
    query.get(name) ? [[name, query.get(name)!] as const] : [],
  );
  try {
    history.replaceState(null, '', linkTo(location.href, new Map([...origin, ...viewer.view])));
  } catch {
    // A page within another one (srcdoc) has no address of its own.
  }
};
for (const type of ['camera-change', 'view-change']) {
  viewer.addEventListener(type, () => {
    clearTimeout(timer);
    timer = setTimeout(remember, kRestMs);
  });
}
window.qtetViewer = viewer;
const main = document.querySelector('main')!;
main.append(viewer);
// Connecting builds the viewer in a task of its own, and the next one takes over what the page
// showed before its script came.
setTimeout(() => {
  main.querySelector('.first')?.remove();
  const poster = main.querySelector('img[slot=poster]');
  if (!poster) return;
  viewer.append(poster);
  // It shows this mesh alone.
  viewer.addEventListener('view-change', ({detail}) => {
    if (detail.name === 'mesh') poster.remove();
  });
});
