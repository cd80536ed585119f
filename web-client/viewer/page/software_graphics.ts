// Says once in a session that the browser draws without a graphics card.

import {find, onClick} from './find';
import {setMarkup} from './trusted';

/** Renderers that compute pictures on the processor. */
const kSoftware = /swiftshader|llvmpipe|softpipe|microsoft basic render/i;
const kToldKey = 'qtet-software-graphics';

const kNote = `
<div class="card">
  <p>The browser draws without a graphics card, so turning is slow. Turn on graphics acceleration in
    the browser’s settings. On a remote desktop, open the page on your own machine.</p>
  <button type="button" class="dismiss">Close</button>
</div>`;

/** `renderer` as View.renderer. */
export function tellOfSoftwareGraphics(root: ShadowRoot, renderer: string): void {
  if (!kSoftware.test(renderer) || !isFirstTime()) return;
  const note = find(root, '.software-note');
  setMarkup(note, kNote);
  onClick(note, '.dismiss', () => {
    note.replaceChildren();
    find(root, '.scene').focus();
  });
}

function isFirstTime(): boolean {
  try {
    const isFirst = sessionStorage.getItem(kToldKey) === null;
    sessionStorage.setItem(kToldKey, 'told');
    return isFirst;
  } catch {
    return true; // the page may keep nothing
  }
}
