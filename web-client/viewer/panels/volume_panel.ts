// The transfer function: a row of opacities over the colours. Each is a slider, so that keyboard,
// touch and screen readers can edit it.

import {kAutoVolume} from '../../core/layers/volume';
import {colorGradient} from '../../core/picture/color_maps';
import type {Attributes} from '../page/page';
import type {Settings} from '../settings/settings';
import {toggle} from './markup';
import type {Panel, PanelKind, Scene} from './panel';

const kSteps = 100;

const kMarkup = `
${toggle('volume', 'Volume')}
<div class="volume sub" hidden>
  <div class="bars" role="group" aria-label="Transfer function"></div>
  <p class="hint working" hidden>Drawing all cells and pixels</p>
  <div class="row buttons">
    <button type="button" class="fainter">Fainter</button>
    <button type="button" class="denser">Denser</button>
  </div>
</div>`;

class VolumePanel implements Panel {
  private readonly on: HTMLInputElement;
  private readonly body: HTMLElement;
  private readonly bars: HTMLElement;
  private opacities: number[] = [];

  constructor(
    root: ParentNode,
    private readonly attributes: Attributes,
  ) {
    this.on = root.querySelector('input[name=volume]')!;
    this.body = root.querySelector('.volume')!;
    this.bars = this.body.querySelector('.bars')!;
    this.on.addEventListener('change', () =>
      attributes.write('volume', this.on.checked ? kAutoVolume : null),
    );
    this.body.querySelector('.fainter')!.addEventListener('click', () => this.scale(0.7));
    this.body.querySelector('.denser')!.addEventListener('click', () => this.scale(1 / 0.7));
  }

  update({volume, map, reversed}: Settings, scene: Scene | null): void {
    this.on.disabled = scene !== null && scene.manifest.fields.length === 0;
    this.on.checked = volume !== null;
    this.body.hidden = volume === null;
    if (!volume) return;
    this.opacities = volume;
    if (this.bars.children.length !== volume.length)
      this.bars.replaceChildren(...volume.map((_, i) => this.slider(i)));
    this.bars.style.backgroundImage = colorGradient(map, reversed);
    volume.forEach((opacity, i) => {
      const slider = this.bars.children[i] as HTMLInputElement;
      slider.value = String(Math.round(kSteps * opacity));
      slider.setAttribute('aria-valuetext', `${slider.value} %`);
    });
  }

  private slider(i: number): HTMLInputElement {
    const slider = Object.assign(document.createElement('input'), {
      type: 'range',
      min: '0',
      max: String(kSteps),
      step: '1',
    });
    slider.setAttribute(
      'aria-label',
      `Opacity at ${Math.round((100 * i) / (this.opacities.length - 1))} % of the range`,
    );
    slider.setAttribute('aria-orientation', 'vertical');
    slider.addEventListener('input', () =>
      this.write(
        this.opacities.map((opacity, k) => (k === i ? Number(slider.value) / kSteps : opacity)),
      ),
    );
    return slider;
  }

  /** Opacity 0 stays 0, so that hidden values stay hidden. */
  private scale(factor: number): void {
    this.write(this.opacities.map((opacity) => 1 - (1 - Math.min(opacity, 0.99)) ** factor));
  }

  private write(opacities: number[]): void {
    this.attributes.write('volume', opacities.map((opacity) => Number(opacity.toFixed(3))).join());
  }
}

export const volumePanel: PanelKind = {
  markup: kMarkup,
  make: ({page}) => new VolumePanel(page.root, page),
};
