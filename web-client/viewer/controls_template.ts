// The markup of the controls, cards and dialogs that come behind the first picture.

import type {FieldLayer} from '../core/layers/layer';
import {fieldLayers} from '../core/layers/layers';
import {kColorMapNames} from '../core/picture/color_maps';
import {kDirections} from '../webgl/directions';
import {kKeyHelp} from './page/keys';

const kMapTitles = {
  viridis: 'Viridis',
  cividis: 'Cividis',
  'cool-warm': 'Cool-warm',
  turbo: 'Turbo',
  grey: 'Grey',
  labels: 'One colour a label',
};
const kModeTitles = {cut: 'Flat', cells: 'Cells', slice: 'Slice'};
const kToolTitles = {none: 'Turn', point: 'Point', line: 'Line'};

const swatches = [...kColorMapNames, 'labels' as const]
  .map((name) => {
    const title = kMapTitles[name];
    return `
  <label class="swatch ${name}" title="${title}"${name === 'labels' ? ' hidden' : ''}>
    <input type="radio" name="colormap" value="${name}" aria-label="${title}">
    <span></span>
  </label>`;
  })
  .join('');

const segments = (name: string, titles: Record<string, string>): string =>
  Object.entries(titles)
    .map(([value, title], i) => {
      const checked = i === 0 ? ' checked' : '';
      const input = `<input type="radio" name="${name}" value="${value}"${checked}>`;
      return `<label>${input}<span>${title}</span></label>`;
    })
    .join('');

const toggle = (name: string, title: string, checked = false): string =>
  `<label class="switch"><span class="name">${title}</span>` +
  `<input type="checkbox" role="switch" name="${name}"${checked ? ' checked' : ''}></label>`;

/** The controls of a layer (value_panel.ts). */
function controls({name, control}: FieldLayer): string {
  const {title, fieldLabel, sliders, valuesLabel, hiddenHint} = control;
  const ranges = sliders
    .map((label) => `<input type="range" min="0" max="1000" aria-label="${label}">`)
    .join('\n        ');
  const hint = `
        <p class="hint ${name}-hidden" hidden>${hiddenHint}
          <button type="button" class="see-through">See through it</button></p>`;
  return `${toggle(name, title)}
      <div class="${name} sub" hidden>
        <select name="${name}-field" aria-label="${fieldLabel}"></select>
        ${ranges}
        <label class="row">
          <span class="name">${valuesLabel}</span>
          <input type="text" name="${name}-values" autocomplete="off">
        </label>${hiddenHint === undefined ? '' : hint}
      </div>`;
}

const directions = kDirections
  .map((direction) => {
    const text = direction.replace('-', '\u2212');
    const label = `aria-label="Look from ${direction}"`;
    return `<button type="button" class="look" value="${direction}" ${label}>${text}</button>`;
  })
  .join('');

const keys = kKeyHelp
  .map(([key, what]) => {
    const caps = key.split(' ').map((k) => (k === '…' ? k : `<kbd>${k}</kbd>`));
    return `<div><dt>${caps.join(' ')}</dt><dd>${what}</dd></div>`;
  })
  .join('');

/** The known error against bytes. */
const curves = ['ahead', 'reached', 'here']
  .map((name) => `<path class="${name}" vector-effect="non-scaling-stroke"/>`)
  .join('');

const closeIcon =
  '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M5 5l10 10M15 5 5 15"/></svg>';

/** A section that folds, and keeps its state under `name` (folds.ts). */
const section = (name: string, title: string, open: boolean, content: string): string => `
    <details data-fold="${name}"${open ? ' open' : ''}>
      <summary>${title}</summary>
      <div class="sub">${content}
      </div>
    </details>`;

/** The panel's sections. */
export const kControls = `    ${section(
  'colours',
  'Field and colours',
  true,
  `
      <label class="field">
        <span class="name">Field</span><select name="field" disabled></select>
      </label>
      <fieldset class="swatches"><legend class="name">Colours</legend>${swatches}</fieldset>
      <div class="row wrap">
        <label class="toggle"><input type="checkbox" name="reversed"><span>Reversed</span></label>
        <label class="toggle"><input type="checkbox" name="log"><span>Log scale</span></label>
      </div>
      <div class="row">
        <span class="name">Range</span>
        <select name="range" class="small" aria-label="Range of the colours">
          <option value="auto">Automatic</option>
          <option value="full">All values</option>
          <option value="symmetric">Symmetric</option>
          <option value="instant">This instant</option>
          <option value="fixed">Fixed</option>
        </select>
      </div>
      <div class="row range-fixed" hidden>
        <input type="text" inputmode="decimal" name="range-low" aria-label="Start of the range">
        <span class="name">to</span>
        <input type="text" inputmode="decimal" name="range-high" aria-label="End of the range">
      </div>
      <div class="histogram"></div>`,
)}
    ${section(
      'surface',
      'Surface',
      true,
      `
      ${toggle('edges', 'Cell edges', true)}
      ${toggle('creases', 'Creases', true)}
      ${toggle('surface', 'Surface', true)}
      <div class="field">
        <span class="row">
          <span class="name">Opacity</span><output class="opacity-text"></output>
        </span>
        <input type="range" name="opacity" min="5" max="100" step="5" value="100"
          aria-label="Opacity">
      </div>
      <p class="hint hides-surface" id="hides-surface" hidden>The volume takes the place of the
        surface and its cells' edges.</p>`,
    )}
    ${section(
      'deform',
      'Deform',
      true,
      `
      ${toggle('warp', 'Deformed shape')}
      <div class="warp sub" hidden>
        <select name="warp-field" aria-label="Vectors that move the mesh"></select>
        <label class="row">
          <span class="name">Scale \u00d7</span>
          <input type="text" inputmode="decimal" name="warp-scale" autocomplete="off">
        </label>
        <input type="range" name="warp-slider" min="0" aria-label="Scale of the deformed shape">
        <div class="buttons">
          <button type="button" class="true-size">True size</button>
          <button type="button" class="automatic">Automatic</button>
        </div>
        ${toggle('rest-edges', 'Edges at rest')}
      </div>`,
    )}
    ${section(
      'inside',
      'Inside',
      true,
      `
      ${toggle('clip', 'Clip')}
      <div class="clip" hidden>
        <fieldset class="segments clip-modes">
          <legend class="visually-hidden">What a clip leaves</legend>
          ${segments('clip-mode', kModeTitles)}
        </fieldset>
        <div class="planes"></div>
        <button type="button" class="add-plane">Add a plane</button>
      </div>
      ${fieldLayers()
        .filter(({draw}) => draw)
        .map(controls)
        .join('')}
      ${toggle('volume', 'Volume')}
      <div class="volume sub" hidden>
        <div class="bars" role="group" aria-label="Transfer function"></div>
        <p class="hint working" hidden>Drawing all cells and pixels</p>
        <div class="row buttons">
          <button type="button" class="fainter">Fainter</button>
          <button type="button" class="denser">Denser</button>
        </div>
      </div>
      ${fieldLayers()
        .filter(({draw}) => !draw)
        .map(controls)
        .join('')}`,
    )}
    ${section(
      'pointer',
      'Pointer',
      true,
      `
      <fieldset class="segments tools">
        <legend class="visually-hidden">Pointer</legend>
        ${segments('tool', kToolTitles)}
      </fieldset>`,
    )}
    ${section(
      'level',
      'Level of detail',
      false,
      `
        <label class="field">
          <span class="name">Refine</span>
          <select name="limit">
            <option value="full">all of it</option>
            <option value="error">until the error is</option>
            <option value="cells">until there are</option>
            <option value="bytes">until it took</option>
          </select>
        </label>
        <label class="row limit-value" hidden>
          <input type="text" inputmode="decimal" name="limit-value" aria-label="Limit">
          <span class="limit-unit name"></span>
        </label>
        <div class="row buttons">
          <button type="button" class="coarser">Coarser</button>
          <button type="button" class="finer">Finer</button>
        </div>
        <figure class="curve" hidden>
          <svg viewBox="0 -1 100 42" preserveAspectRatio="none" aria-hidden="true">${curves}</svg>
          <figcaption></figcaption>
        </figure>`,
    )}
    ${section(
      'view',
      'View',
      false,
      `
        <div class="looks" role="group" aria-label="Standard views">${directions}</div>
        ${toggle('parallel', 'Parallel projection')}`,
    )}
    ${section(
      'file',
      'File',
      false,
      `
        <input type="file" class="visually-hidden" name="file" multiple tabindex="-1"
          aria-label="A log, or a mesh with the files that it names">
        <div class="buttons">
          <button type="button" class="open-file">Open</button>
          <button type="button" class="save-log">Save log</button>
          <button type="button" class="save-page">Save page</button>
        </div>
        <p class="hint">Open a log or a mesh of this machine, or drop it on the page. It stays
          here.</p>`,
    )}
    <details class="statistics" data-fold="statistics">
      <summary>Statistics</summary>
      <dl class="sub">
        <div><dt>Frame</dt><dd class="frame-ms">&ndash;</dd></div>
        <div><dt>Picture in the worker</dt><dd class="cost-ms">&ndash;</dd></div>
        <div><dt>Refining</dt><dd class="cell-rate">&ndash;</dd></div>
        <div><dt>Level</dt><dd class="level">&ndash;</dd></div>
        <div><dt>Vertices</dt><dd class="vertices">&ndash;</dd></div>
        <div><dt>Boundary triangles</dt><dd class="triangles">&ndash;</dd></div>
      </dl>
    </details>`;

/** Over the picture. */
export const kCards = `
<div class="hover" part="hint" aria-hidden="true" hidden></div>
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
