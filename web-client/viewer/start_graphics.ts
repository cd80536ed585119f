// Starts the browser's graphics while the viewer's scripts still arrive: without a GPU that takes a
// second and more. The page loads this file, which loads itself again as a worker, so that the page
// waits for nothing. It also preloads the viewer's workers, a round trip behind the main script,
// which is needed first.

import {trustOwnWorkers} from './page/own_workers';

/** By then the viewer has graphics of its own, and these may end. */
const kKeepMs = 15000;

if (typeof document === 'undefined') {
  const graphics =
    typeof OffscreenCanvas === 'undefined' ? null : new OffscreenCanvas(1, 1).getContext('webgl2');
  setTimeout(() => (graphics?.flush(), close()), kKeepMs);
} else {
  trustOwnWorkers();
  const {workers} = document.querySelector<HTMLElement>('script[data-workers]')!.dataset;
  for (const href of workers!.split(' ')) {
    const link = document.createElement('link');
    Object.assign(link, {rel: 'modulepreload', crossOrigin: '', fetchPriority: 'low', href});
    document.head.append(link);
  }
  new Worker(import.meta.url, {type: 'module', name: 'qtet-start'});
}
