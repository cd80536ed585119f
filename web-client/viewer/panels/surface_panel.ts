// Edges, creases, the surface and its opacity.

import {find, setText} from '../page/find';
import type {Attributes} from '../page/page';
import type {Settings} from '../settings/settings';
import {toggle} from './markup';
import type {Panel, PanelKind} from './panel';

/** Everything that is drawn unless it is switched off. */
const kSwitches = ['edges', 'creases', 'surface'] as const;

const kMarkup = `
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
  surface and its cells' edges.</p>`;

class SurfacePanel implements Panel {
  constructor(
    private readonly root: ParentNode,
    attributes: Attributes,
  ) {
    for (const name of kSwitches) {
      const input = this.input(name);
      input.addEventListener('change', () => attributes.write(name, input.checked ? null : 'off'));
    }
    const opacity = this.input('opacity');
    opacity.addEventListener('input', () =>
      attributes.write('opacity', String(Number(opacity.value) / 100)),
    );
  }

  update(settings: Settings): void {
    for (const name of kSwitches) this.input(name).checked = settings[name];
    const percent = Math.round(100 * settings.opacity);
    this.input('opacity').value = String(percent);
    setText(find(this.root, '.opacity-text'), `${percent}\u202f%`);
    this.disableHidden(settings);
  }

  /** A volume hides the surface. A slice inside it has edges. */
  private disableHidden({volume, mode, planes}: Settings): void {
    const hint = find(this.root, '.hides-surface');
    hint.hidden = volume === null;
    const hasEdges = mode === 'slice' && planes.length > 0;
    for (const name of [...kSwitches, 'opacity']) {
      const input = this.input(name);
      input.disabled = volume !== null && !(name === 'edges' && hasEdges);
      input.title = input.disabled ? hint.textContent.replace(/\s+/g, ' ') : '';
      if (input.disabled) input.setAttribute('aria-describedby', hint.id);
      else input.removeAttribute('aria-describedby');
    }
  }

  private input(name: string): HTMLInputElement {
    return find(this.root, `input[name=${name}]`);
  }
}

export const surfacePanel: PanelKind = {
  markup: kMarkup,
  make: ({page}) => new SurfacePanel(page.root, page),
};
