// Field, colour map, scale and range.

import {parseNumbers} from '../../core/layers/field_values';
import {
  colorGradient,
  kColorMapNames,
  labelGradient,
  type ColorMapName,
} from '../../core/picture/color_maps';
import {labelsOf} from '../../core/picture/labels';
import {roundTo} from '../page/format';
import type {Attributes} from '../page/page';
import {shownScalar, type Settings, type ShownRange} from '../settings/settings';
import {fillScalars, type Panel, type PanelKind, type Scene} from './panel';

/** The labels in their map's swatch. */
const kShownLabels = 5;
const kMapTitles = {
  viridis: 'Viridis',
  cividis: 'Cividis',
  'cool-warm': 'Cool-warm',
  turbo: 'Turbo',
  grey: 'Grey',
  labels: 'One colour a label',
};
/** The ends of the range are shown to this share of it. */
const kRangeShare = 1e-4;

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

const kMarkup = `
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
</div>`;

function gradientOf(map: string): string {
  return map === 'labels' ? labelGradient(kShownLabels) : colorGradient(map as ColorMapName);
}

class ColorPanel implements Panel {
  /** The fixed ranges of fields that were left. */
  private readonly ranges = new Map<string, string>();
  /** The field in the menu. */
  private field = '';
  /** A fixed range was chosen before there were values: the first one is kept. */
  private awaitsRange = false;

  constructor(
    private readonly root: ParentNode,
    private readonly attributes: Attributes,
  ) {
    for (const swatch of root.querySelectorAll<HTMLInputElement>('input[name=colormap]'))
      (swatch.nextElementSibling as HTMLElement).style.background = gradientOf(swatch.value);
    this.on('select[name=field]', (select) => this.chooseField(select.value));
    this.on('.swatches', () => this.writeMap());
    this.on('input[name=reversed]', () => this.writeMap());
    this.on('input[name=log]', (input) =>
      attributes.write('scale', (input as HTMLInputElement).checked ? 'log' : null),
    );
    this.on('select[name=range]', (select) => this.writeRange(select.value));
    for (const end of ['low', 'high'])
      this.on(`input[name=range-${end}]`, () => this.writeRange('fixed'));
  }

  update(settings: Settings, scene: Scene | null): void {
    for (const swatch of this.root.querySelectorAll<HTMLInputElement>('input[name=colormap]'))
      swatch.checked = swatch.value === settings.map;
    this.input('reversed').checked = settings.reversed;
    this.input('log').checked = settings.logarithmic;
    const fields = scene?.manifest.fields ?? [];
    const chosen = shownScalar(this.attributes.read('field'), fields, scene?.firstField ?? 0);
    const labels = chosen && labelsOf(fields[chosen.field]!);
    this.chooseRange(settings, chosen !== null && fields[chosen.field]!.instant !== undefined);
    this.find('.swatch.labels').hidden = !labels;
    const menu = this.find<HTMLSelectElement>('select[name=field]');
    fillScalars(menu, fields, chosen);
    this.field = menu.value;
  }

  /** Only a series can have the range of an instant. */
  private chooseRange({range}: Settings, isSeries: boolean): void {
    const fixed = typeof range !== 'string' || this.awaitsRange;
    const option = this.find<HTMLOptionElement>('option[value=instant]');
    option.hidden = option.disabled = !isSeries;
    const word = range === 'instant' && !isSeries ? 'auto' : String(range);
    this.find<HTMLSelectElement>('select[name=range]').value = fixed ? 'fixed' : word;
    this.find('.range-fixed').hidden = !fixed;
  }

  /** Shows the current range, which a fixed one starts from. */
  showRange({low, high}: ShownRange): void {
    const active = (this.root as ShadowRoot).activeElement;
    for (const [name, value] of [
      ['range-low', low],
      ['range-high', high],
    ] as const) {
      const text = String(roundTo(value, kRangeShare * (high - low)));
      const input = this.input(name);
      if (input !== active && input.value !== text) input.value = text;
    }
    if (!this.awaitsRange) return;
    this.awaitsRange = false;
    this.writeRange('fixed');
  }

  /** Numbers mean nothing for another field: a fixed range stays behind, and comes back. */
  private chooseField(field: string): void {
    const range = this.attributes.read('range');
    if (range !== null && parseNumbers(range).length === 2) {
      this.ranges.set(this.field, range);
      this.attributes.write('range', null);
    }
    this.attributes.write('field-title', null);
    this.attributes.write('field', field);
    const kept = this.ranges.get(field);
    if (kept !== undefined) this.attributes.write('range', kept);
  }

  private writeMap(): void {
    const map = this.root.querySelector<HTMLInputElement>('input[name=colormap]:checked')!.value;
    this.attributes.write('colormap', this.input('reversed').checked ? `${map} reversed` : map);
  }

  private writeRange(kind: string): void {
    const isUnknown = ['low', 'high'].every((end) => this.input(`range-${end}`).value === '');
    this.awaitsRange = kind === 'fixed' && isUnknown;
    if (this.awaitsRange) return void (this.find('.range-fixed').hidden = false);
    if (kind !== 'fixed') {
      this.attributes.write('range', kind === 'auto' ? null : kind);
      return;
    }
    const text = `${this.input('range-low').value},${this.input('range-high').value}`;
    const [low, high] = parseNumbers(text);
    const valid = low !== undefined && high !== undefined && low < high;
    this.input('range-high').setCustomValidity(
      valid ? '' : 'The end of the range has to be above its start.',
    );
    if (valid) this.attributes.write('range', `${low},${high}`);
    else this.input('range-high').reportValidity();
  }

  private on(
    selector: string,
    action: (control: HTMLInputElement | HTMLSelectElement) => void,
  ): void {
    this.find(selector).addEventListener('change', (event) =>
      action(event.currentTarget as HTMLInputElement),
    );
  }
  private find<T extends HTMLElement = HTMLElement>(selector: string): T {
    return this.root.querySelector<T>(selector)!;
  }
  private input(name: string): HTMLInputElement {
    return this.find<HTMLInputElement>(`input[name=${name}]`);
  }
}

export const colorPanel: PanelKind = {
  markup: kMarkup,
  make: ({page}) => new ColorPanel(page.root, page),
};
