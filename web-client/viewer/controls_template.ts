// The markup of the cards and dialogs that come behind the first picture.

import {kKeyHelp} from './page/keys';

const keys = kKeyHelp
  .map(([key, what]) => {
    const caps = key.split(' ').map((k) => (k === '…' ? k : `<kbd>${k}</kbd>`));
    return `<div><dt>${caps.join(' ')}</dt><dd>${what}</dd></div>`;
  })
  .join('');

const closeIcon =
  '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M5 5l10 10M15 5 5 15"/></svg>';

/** Over the picture. */
export const kCards = `
<div class="hover" part="hint" aria-hidden="true" hidden></div>
<div class="software-note" role="status"></div>
<p class="card tool-hint" part="hint" hidden></p>
<section class="card result" part="result" aria-label="What was pointed at" hidden>
  <div class="row">
    <h2></h2>
    <button type="button" class="icon close-result" aria-label="Close">${closeIcon}</button>
  </div>
  <dl></dl>
  <div class="plot"></div>
  <p class="hint readout"></p>
  <div class="row source">
    <p class="hint status"></p>
    <button type="button" class="exact" title="The values of the whole mesh" hidden>Exact</button>
  </div>
  <div class="buttons">
    <button type="button" class="copy-result">Copy</button>
    <button type="button" class="keep-point" hidden>Keep</button>
    <button type="button" class="over-time" hidden>Over time</button>
    <button type="button" class="save-table" hidden>Save as CSV</button>
  </div>
</section>`;

export const kCube = `
<svg class="orientation-cube" viewBox="-30 -30 60 60" role="toolbar"
  aria-label="Look along an axis"></svg>`;

export const kDialogs = `
<dialog class="help-dialog" aria-label="Keys">
  <form method="dialog" class="row">
    <h2>Keys</h2>
    <button class="icon" aria-label="Close">${closeIcon}</button>
  </form>
  <dl class="keys">${keys}</dl>
  <p class="hint">They work while the picture has the focus. Drag turns, the wheel or two fingers
    zoom, the right button or two fingers move.</p>
</dialog>
<dialog class="share-dialog" aria-label="Share">
  <form method="dialog" class="row">
    <h2>Share</h2>
    <button class="icon" aria-label="Close">${closeIcon}</button>
  </form>
  <label class="field">
    <span class="name">Link to this picture</span><input type="text" name="link" readonly>
  </label>
  <label class="field">
    <span class="name">Lines for another page</span>
    <textarea name="snippet" rows="6" readonly></textarea>
  </label>
  <div class="buttons">
    <button type="button" class="copy-link">Copy link</button>
    <button type="button" class="copy-snippet">Copy lines</button>
  </div>
</dialog>`;
