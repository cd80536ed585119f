// The controls of a layer: a field and values of it.

import {
  fieldValuesText,
  parseNumbers,
  parseScalar,
  sharesOf,
  type FieldValues,
} from '../../core/layers/field_values';
import {fieldLayers, type ListedFieldLayer} from '../../core/layers/layers';
import {scalarRange, kMagnitude, type Scalar} from '../../core/picture/field_scale';
import type {FieldInfo} from '../../core/protocol/fields';
import {roundTo} from '../page/format';
import type {Attributes} from '../page/page';
import type {Settings} from '../settings/settings';
import {toggle} from './markup';
import {kValueControls} from './value_controls';
import {fillScalars} from './field_menu';
import type {Panel, PanelKind, Scene} from './panel';

const kSteps = 1000;
/** Values are shown to this share of the field's range. */
const kShownShare = 1e-4;
/** The surface's opacity through which isosurfaces are seen well. */
const kSeeThrough = '0.25';

function markupOf({name}: ListedFieldLayer): string {
  const {title, fieldLabel, sliders, valuesLabel, hiddenHint} = kValueControls[name]!;
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

class ValuePanel implements Panel {
  private fields: readonly FieldInfo[] = [];
  private readonly on: HTMLInputElement;
  private readonly body: HTMLElement;
  private readonly select: HTMLSelectElement;
  private readonly numbers: HTMLInputElement;
  private readonly sliders: HTMLInputElement[];

  constructor(
    private readonly root: ShadowRoot,
    private readonly attributes: Attributes,
    private readonly layer: ListedFieldLayer,
  ) {
    const {name} = layer;
    this.on = root.querySelector(`input[name=${name}]`)!;
    this.body = root.querySelector(`.${name}`)!;
    this.select = this.body.querySelector('select')!;
    this.numbers = this.body.querySelector('input[type=text]')!;
    this.sliders = [...this.body.querySelectorAll<HTMLInputElement>('input[type=range]')];
    this.on.addEventListener('change', () => this.toggle());
    this.select.addEventListener('change', () =>
      this.choose(parseScalar(this.select.value, this.fields)),
    );
    this.numbers.addEventListener('change', () => this.type());
    for (const slider of this.sliders) slider.addEventListener('input', () => this.slide(slider));
    this.body
      .querySelector('.see-through')
      ?.addEventListener('click', () => attributes.write('opacity', kSeeThrough));
  }

  update(settings: Settings, scene: Scene | null): void {
    this.fields = scene?.manifest.fields ?? [];
    const usable = this.fields.some((info) => this.canShow(info));
    const now = this.value();
    this.on.disabled = !usable;
    this.on.checked = now !== null;
    this.body.hidden = now === null;
    const hidden = this.body.querySelector<HTMLElement>('.hint');
    if (hidden) hidden.hidden = !hidesInside(settings);
    if (!now) return;
    fillScalars(this.select, this.fields, now.scalar, this.layer.pointsOnly);
    if (this.root.activeElement !== this.numbers)
      this.numbers.value = now.values.map((value) => this.rounded(value, now.scalar)).join(', ');
    sharesOf(now, this.fields)
      .slice(0, this.sliders.length)
      .forEach((share, i) => {
        this.sliders[i]!.value = String(Math.round(kSteps * share));
        this.sliders[i]!.setAttribute(
          'aria-valuetext',
          String(this.rounded(now.values[i]!, now.scalar)),
        );
      });
  }

  /** The value of the attribute; null if it is empty or does not fit the mesh. */
  value(): FieldValues | null {
    return this.layer.read(this.attributes.read(this.layer.name), this.fields);
  }

  private canShow({association}: FieldInfo): boolean {
    return !this.layer.pointsOnly || association === 'point';
  }

  private rounded(value: number, {field, component}: Scalar): number {
    const [low, high] = scalarRange(this.fields[field]!, component);
    return roundTo(value, kShownShare * (high - low));
  }

  private toggle(): void {
    if (!this.on.checked) return this.attributes.write(this.layer.name, null);
    const shown = parseScalar(this.attributes.read('field'), this.fields);
    const fits = shown && this.canShow(this.fields[shown.field]!);
    const first = this.fields.findIndex((info) => this.canShow(info));
    this.choose(fits ? shown : {field: first, component: kMagnitude});
  }

  private choose(scalar: Scalar | null): void {
    if (!scalar) return;
    const [low, high] = scalarRange(this.fields[scalar.field]!, scalar.component);
    const values = kValueControls[this.layer.name]!.firstShares.map(
      (share) => low + share * (high - low),
    );
    this.write({scalar, values});
  }

  private type(): void {
    const now = this.value();
    const values = parseNumbers(this.numbers.value);
    const control = kValueControls[this.layer.name]!;
    const valid = control.areRight(values);
    this.numbers.setCustomValidity(valid ? '' : control.expected);
    if (valid && now) this.write({scalar: now.scalar, values});
    else this.numbers.reportValidity();
  }

  private slide(moved: HTMLInputElement): void {
    const now = this.value();
    if (!now) return;
    const [low, high] = scalarRange(this.fields[now.scalar.field]!, now.scalar.component);
    const at = (slider: HTMLInputElement): number =>
      low + (Number(slider.value) / kSteps) * (high - low);
    if (this.sliders.length === 1)
      return this.write({scalar: now.scalar, values: [at(moved), ...now.values.slice(1)]});
    const i = this.sliders.indexOf(moved);
    const other = at(this.sliders[1 - i]!);
    this.write({
      scalar: now.scalar,
      values: i === 0 ? [Math.min(at(moved), other), other] : [other, Math.max(at(moved), other)],
    });
  }

  private write(values: FieldValues): void {
    this.attributes.write(this.layer.name, fieldValuesText(values, this.fields));
  }
}

/** An opaque surface without a cut lets nothing inside be seen. */
function hidesInside({surface, opacity, planes, volume}: Settings): boolean {
  return surface && opacity === 1 && planes.length === 0 && volume === null;
}

/** Those of layers that draw, or of those that only hide. */
export const valuePanels = (draws: boolean): PanelKind[] =>
  fieldLayers()
    .filter(({draw}) => (draw !== undefined) === draws)
    .map((layer) => ({
      markup: markupOf(layer),
      make: ({page}) => new ValuePanel(page.root, page, layer),
    }));
