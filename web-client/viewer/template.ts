// The viewer's markup. Native controls throughout: they bring keyboard, touch and screen readers along.

import {colorGradient, kColorMapNames} from '../core/color_maps';

const kMapTitles = {viridis: 'Viridis', cividis: 'Cividis', 'cool-warm': 'Cool-warm'};

const swatches = kColorMapNames.map((name) => `
  <label class="swatch" title="${kMapTitles[name]}">
    <input type="radio" name="colormap" value="${name}" aria-label="${kMapTitles[name]}">
    <span style="background:${colorGradient(name)}"></span>
  </label>`).join('');

const axes = ['x', 'y', 'z'].map((axis) => `
  <label><input type="radio" name="axis" value="${axis}"${axis === 'x' ? ' checked' : ''}><span>${axis.toUpperCase()}</span></label>`).join('');

export const kTemplate = `
<canvas part="canvas" tabindex="0" role="img" aria-label="3D view"></canvas>

<svg class="triad" viewBox="-30 -30 60 60" aria-hidden="true"></svg>

<figure class="card legend" hidden>
  <figcaption><span class="legend-name"></span><span class="legend-factor"></span></figcaption>
  <div class="legend-bar"></div>
  <div class="legend-ticks"></div>
</figure>

<aside class="card panel" aria-label="Mesh and display">
  <header>
    <div class="title">
      <label class="mesh-menu" hidden><span class="visually-hidden">Mesh</span><select name="mesh"></select></label>
      <h1 class="mesh-name">&nbsp;</h1>
    </div>
    <button type="button" class="icon fold" aria-expanded="true" aria-controls="controls" aria-label="Controls">
      <svg viewBox="0 0 20 20" aria-hidden="true"><path d="M3 6.5h7m5 0h2M3 13.5h2m5 0h7"/><circle cx="12.5" cy="6.5" r="2.2"/><circle cx="7.5" cy="13.5" r="2.2"/></svg>
    </button>
  </header>

  <section class="progress" aria-label="Progress">
    <div class="row">
      <span class="state" role="status"><i class="dot"></i><span class="state-text">Connecting</span></span>
      <output class="percent">0 %</output>
    </div>
    <div class="bar" role="progressbar" aria-label="Part of the mesh that is here" aria-valuemin="0" aria-valuemax="100" aria-valuenow="0"><i></i></div>
    <dl>
      <div><dt>Data</dt><dd class="bytes">&ndash;</dd></div>
      <div><dt>Cells</dt><dd class="cells">&ndash;</dd></div>
    </dl>
  </section>

  <div class="controls" id="controls">
    <section>
      <label class="field"><span class="name">Field</span><select name="field" disabled></select></label>
      <fieldset class="swatches"><legend class="name">Colours</legend>${swatches}</fieldset>
    </section>
    <section>
      <label class="switch"><span class="name">Cell edges</span><input type="checkbox" role="switch" name="edges" checked></label>
      <label class="switch"><span class="name">Clip</span><input type="checkbox" role="switch" name="clip"></label>
      <div class="clip" hidden>
        <div class="row">
          <fieldset class="segments"><legend class="visually-hidden">Clip across axis</legend>${axes}</fieldset>
          <label class="toggle"><input type="checkbox" name="flip"><span>Flip</span></label>
          <output class="position"></output>
        </div>
        <input type="range" name="position" min="0" max="1000" value="500" aria-label="Position of the clip plane">
      </div>
    </section>
    <footer>
      <button type="button" class="reset">Reset view</button>
      <button type="button" class="pause" hidden>Pause</button>
    </footer>
  </div>
</aside>

<div class="card notice" role="alert" hidden>
  <p></p>
  <div><button type="button" class="retry">Try again</button><button type="button" class="dismiss">Close</button></div>
</div>`;
