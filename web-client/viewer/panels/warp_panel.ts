// The controls of the deformed shape: the vectors that move the mesh, their scale, and the edges at
// rest.

import {parseNumbers, scalarText} from '../../core/layers/field_values';
import {kMagnitude} from '../../core/picture/field_scale';
import {find, onClick} from '../page/find';
import {formatFactor} from '../page/format';
import type {Attributes} from '../page/page';
import {fillSelect} from '../page/select';
import type {Settings} from '../settings/settings';
import {firstWarp, kNoWarp, largestScale, warpFields, warpOf} from '../settings/warp';
import {toggle} from './markup';
import {scalarName, type Panel, type PanelKind, type Scene} from './panel';

const kSteps = 400;

const kMarkup = `
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
</div>`;

class WarpPanel implements Panel {
  private readonly section: HTMLElement;
  private readonly on: HTMLInputElement;
  private readonly body: HTMLElement;
  private readonly select: HTMLSelectElement;
  private readonly slider: HTMLInputElement;
  private readonly number: HTMLInputElement;
  private readonly restEdges: HTMLInputElement;
  /** The keys of the fields that can move the mesh. */
  private keys: string[] = [];
  /** The warp without an attribute: a key, or kNoWarp. */
  private first = kNoWarp;
  /** The scale at the slider's end. */
  private end = 1;

  constructor(
    private readonly root: ShadowRoot,
    private readonly attributes: Attributes,
  ) {
    this.section = find(root, '[data-fold=deform]');
    this.on = find(root, 'input[name=warp]');
    this.body = find(root, '.warp');
    this.select = find(this.body, 'select');
    this.slider = find(this.body, 'input[type=range]');
    this.number = find(this.body, 'input[type=text]');
    this.restEdges = find(this.body, 'input[name=rest-edges]');
    this.slider.max = String(kSteps);
    this.on.addEventListener('change', () =>
      this.choose(this.on.checked ? (this.keys[0] ?? kNoWarp) : kNoWarp),
    );
    this.select.addEventListener('change', () => this.choose(this.select.value));
    this.slider.addEventListener('input', () =>
      this.scale((Number(this.slider.value) / kSteps) * this.end),
    );
    this.number.addEventListener('change', () => this.type());
    this.restEdges.addEventListener('change', () =>
      attributes.write('rest-edges', this.restEdges.checked ? 'on' : null),
    );
    onClick(this.body, '.true-size', () => this.scale(1));
    onClick(this.body, '.automatic', () => attributes.write('warp-scale', null));
  }

  update(settings: Settings, scene: Scene | null): void {
    const fields = scene?.manifest.fields ?? [];
    const usable = warpFields(fields).map((field) => ({field, component: kMagnitude}));
    this.keys = usable.map((scalar) => scalarText(scalar, fields));
    this.first = (scene && firstWarp(scene)) ?? kNoWarp;
    this.section.hidden = usable.length === 0;
    const warp = scene && warpOf(settings, scene);
    this.on.checked = warp !== null;
    this.body.hidden = warp === null;
    this.restEdges.checked = settings.restEdges;
    if (!warp) return;
    const titles = usable.map((scalar) => scalarName(scalar, fields).replace(/, magnitude$/, ''));
    fillSelect(
      this.select,
      this.keys.map((value, i) => ({value, title: titles[i]!})),
      scalarText({field: warp.field, component: kMagnitude}, fields),
    );
    this.select.disabled = usable.length < 2;
    this.end = largestScale(warp.field, scene);
    this.showScale(warp.scale, settings.warpScale === null);
  }

  private showScale(scale: number, isAutomatic: boolean): void {
    this.slider.value = String(Math.round((kSteps * scale) / this.end));
    this.slider.setAttribute('aria-valuetext', formatFactor(scale));
    if (this.root.activeElement !== this.number) this.number.value = String(scale);
    find<HTMLButtonElement>(this.body, '.true-size').disabled = scale === 1;
    find<HTMLButtonElement>(this.body, '.automatic').disabled = isAutomatic;
  }

  /** A scale that suits other vectors means nothing for these. */
  private choose(key: string): void {
    this.attributes.write('warp-scale', null);
    this.attributes.write('warp', key === this.first ? null : key);
  }

  private type(): void {
    const [scale, ...more] = parseNumbers(this.number.value);
    const isRight = scale !== undefined && more.length === 0;
    this.number.setCustomValidity(
      isRight ? '' : 'A number: 1 is the true size, 0 the shape at rest',
    );
    if (isRight) this.scale(scale);
    else this.number.reportValidity();
  }

  private scale(scale: number): void {
    this.attributes.write('warp-scale', String(Number(scale.toPrecision(3))));
  }
}

export const warpPanel: PanelKind = {
  markup: kMarkup,
  make: ({page}) => new WarpPanel(page.root, page),
};
