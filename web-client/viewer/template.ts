// The markup that the first picture needs. All controls are native: they work with keyboard, touch
// and screen readers. controls_template.ts has the rest.

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

export const kTemplate = `
<slot name="poster"></slot>
<canvas class="scene" part="canvas" tabindex="0" role="application" aria-label="3D view"></canvas>
<div class="layer" aria-hidden="true"><svg class="marks" part="marks"></svg></div>
<div class="visually-hidden live" role="status" aria-live="polite"></div>

<section class="card time" part="time" aria-label="Time" hidden></section>

<figure class="card legend" part="legend" hidden>
  <figcaption><span class="legend-name"></span><span class="legend-factor"></span></figcaption>
  <div class="legend-bar"></div>
  <div class="legend-ticks"></div>
  <ul class="legend-labels" role="list" hidden></ul>
  <div class="legend-note" hidden></div>
  <div class="legend-warp" hidden></div>
  <div class="legend-missing" hidden><i></i>No value</div>
</figure>

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
  <div class="actions" role="toolbar" aria-label="Actions" inert>${actions}
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

  <div class="controls" id="controls"></div>
  </div>
</aside>

<div class="card notice" part="notice" role="alert" hidden>
  <p></p>
  <div>
    <button type="button" class="retry">Try again</button>
    <button type="button" class="dismiss">Close</button>
  </div>
</div>`;
