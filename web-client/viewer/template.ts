// The viewer's markup. All controls are native: they work with keyboard, touch and screen readers.

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

/** name: [title, the key that does the same, path of the icon]. */
const kActions: Record<string, [string, string, string]> = {
  pause: ['Pause', 'Space', 'M7.5 5v10M12.5 5v10'],
  reset: ['Reset view', 'Home', 'M3.5 10 10 4l6.5 6M5.5 8.5V16h9V8.5'],
  picture: ['Save picture', 'P', 'M10 3v9M6.5 8.5 10 12l3.5-3.5M4 16h12'],
  share: ['Share', '', 'M8 3.5 10 2l2 1.5M10 2v10M6 8H4.5v8.5h11V8H14'],
  fullscreen: ['Full screen', 'W', 'M4 8V4h4M12 4h4v4M16 12v4h-4M8 16H4v-4'],
  help: ['Keys', '?', 'M7 7.5a3 3 0 1 1 4.2 2.7c-.8.4-1.2 1-1.2 2M10 15.6v.1'],
};

const actions = Object.entries(kActions)
  .map(([name, [title, key, path]]) => {
    const tip = key === '' ? title : `${title} (${key})`;
    return `
    <button type="button" class="icon ${name}" aria-label="${title}" title="${tip}">
      <svg viewBox="0 0 20 20" aria-hidden="true"><path d="${path}"/></svg>
    </button>`;
  })
  .join('');

/** A section that folds, and keeps its state under `name` (folds.ts). */
const section = (name: string, title: string, open: boolean, content: string): string => `
    <details data-fold="${name}"${open ? ' open' : ''}>
      <summary>${title}</summary>
      <div class="sub">${content}
      </div>
    </details>`;

export const kTemplate = `
<slot name="poster"></slot>
<canvas class="scene" part="canvas" tabindex="0" role="application" aria-label="3D view"></canvas>
<div class="layer" aria-hidden="true"><svg class="marks" part="marks"></svg></div>
<div class="hover" part="hint" aria-hidden="true" hidden></div>
<div class="visually-hidden live" role="status" aria-live="polite"></div>

<figure class="card legend" part="legend" hidden>
  <figcaption><span class="legend-name"></span><span class="legend-factor"></span></figcaption>
  <div class="legend-bar"></div>
  <div class="legend-ticks"></div>
  <div class="legend-note" hidden></div>
  <div class="legend-missing" hidden><i></i>No value</div>
</figure>

<p class="card tool-hint" part="hint" hidden></p>
<section class="card result" part="result" aria-label="What was pointed at" hidden>
  <div class="row">
    <h2></h2>
    <button type="button" class="icon close-result" aria-label="Close">${closeIcon}</button>
  </div>
  <dl></dl>
  <div class="plot"></div>
  <p class="hint"></p>
  <div class="buttons">
    <button type="button" class="copy-result">Copy</button>
    <button type="button" class="save-table" hidden>Save as CSV</button>
  </div>
</section>

<aside class="card panel" part="panel" aria-label="Mesh and display">
  <header>
    <div class="title">
      <label class="mesh-menu" hidden>
        <span class="visually-hidden">Mesh</span><select name="mesh"></select>
      </label>
      <h1 class="mesh-name">&nbsp;</h1>
    </div>
    <button type="button" class="icon fold" aria-expanded="true" aria-controls="controls"
      aria-label="Controls">
      <svg viewBox="0 0 20 20" aria-hidden="true">
        <path d="M3 6.5h7m5 0h2M3 13.5h2m5 0h7"/>
        <circle cx="12.5" cy="6.5" r="2.2"/><circle cx="7.5" cy="13.5" r="2.2"/>
      </svg>
    </button>
  </header>
  <div class="actions" role="toolbar" aria-label="Actions">${actions}
  </div>

  <div class="body">
  <slot name="progress"><section class="progress" part="progress" aria-label="Progress">
    <div class="row">
      <span class="state"><i class="dot"></i><span class="state-text">Connecting</span></span>
      <span class="row"><output class="percent">0 %</output>
        <button type="button" class="icon unfold" aria-label="Figures" aria-expanded="true" hidden>
          <svg viewBox="0 0 20 20" aria-hidden="true"><path d="M6 8l4 4 4-4"/></svg>
        </button></span>
    </div>
    <div class="bar" role="progressbar" aria-label="Part of the mesh that is here"
      aria-valuemin="0" aria-valuemax="100" aria-valuenow="0"><i></i></div>
    <p class="state-note"></p>
    <dl>
      <div><dt>Data</dt><dd class="bytes">&ndash;</dd></div>
      <div><dt>Cells</dt><dd class="cells">&ndash;</dd></div>
      <div class="error-row" hidden><dt>Error left</dt><dd class="error-left"></dd></div>
      <div class="eta-row" hidden><dt>Ready in</dt><dd class="eta"></dd></div>
    </dl>
  </section></slot>

  <div class="controls" id="controls">
    ${section(
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
      ${toggle('surface', 'Surface', true)}
      <div class="field">
        <span class="row">
          <span class="name" id="opacity-name">Opacity</span><output class="opacity-text"></output>
        </span>
        <input type="range" name="opacity" min="5" max="100" step="5" value="100"
          aria-labelledby="opacity-name">
      </div>
      <p class="hint hides-surface" id="hides-surface" hidden>The volume takes the place of the
        surface and its cells' edges.</p>`,
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
    </details>

  </div>
  </div>
</aside>

<svg class="orientation-cube" viewBox="-30 -30 60 60" role="toolbar"
  aria-label="Look along an axis"></svg>

<div class="card notice" part="notice" role="alert" hidden>
  <p></p>
  <div>
    <button type="button" class="retry">Try again</button>
    <button type="button" class="dismiss">Close</button>
  </div>
</div>

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
