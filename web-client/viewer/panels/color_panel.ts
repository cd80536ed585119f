// Field, colour map, scale and range.

import {parseNumbers} from '../../core/layers/field_values';
import {
  colorGradient,
  kColorMapNames,
  labelGradient,
  type ColorMapName,
} from '../../core/picture/color_maps';
import {hexOf, isSteps, splitColorMap} from '../../core/picture/color_map_text';
import {labelsOf} from '../../core/picture/labels';
import {find} from '../page/find';
import {roundTo} from '../page/format';
import type {Attributes} from '../page/page';
import {shownScalar, type Settings, type ShownRange} from '../settings/settings';
import {fillScalars} from './field_menu';
import type {Panel, PanelKind, Scene} from './panel';

/** The labels in their map's swatch. */
const kShownLabels = 5;
const kMapTitles = {
  viridis: 'Viridis',
  cividis: 'Cividis',
  'cool-warm': 'Cool-warm',
  turbo: 'Turbo',
  grey: 'Grey',
  labels: 'One colour a label',
  custom: 'Own colours',
};
/** The ends of the range are shown to this share of it. */
const kRangeShare = 1e-4;

const kRare = ['labels', 'custom'] as const;
/** The first choice of a panel. */
const kBeyond = '8c8c8c,ff00ff';

const swatches = [...kColorMapNames, ...kRare]
  .map((name) => {
    const title = kMapTitles[name];
    const hidden = (kRare as readonly string[]).includes(name) ? ' hidden' : '';
    return `
  <label class="swatch ${name}" title="${title}"${hidden}>
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

/** It stands below the histogram, which a low sheet shows as well. */
const kStepsMarkup = `
<div class="row">
  <label class="row"><span class="name">Steps</span><input type="text" name="steps"
    class="steps" inputmode="numeric" placeholder="none" autocomplete="off"></label>
  <label class="toggle" title="Colours of values beyond the range"><input type="checkbox"
    name="beyond"><span>Beyond</span></label>
  <input type="color" name="below" aria-label="Colour below the range" hidden>
  <input type="color" name="above" aria-label="Colour above the range" hidden>
</div>`;

/** Gives a swatch the colours of its map. */
function paint(swatch: HTMLInputElement): void {
  const {value} = swatch;
  const isLabels = value === 'labels';
  (swatch.nextElementSibling as HTMLElement).style.background = isLabels
    ? labelGradient(kShownLabels)
    : colorGradient(value as ColorMapName);
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
      if (swatch.value !== 'custom') paint(swatch);
    this.on('input[name=steps]', () => this.writeMap());
    this.on('input[name=beyond]', (box) =>
      attributes.write('beyond', (box as HTMLInputElement).checked ? kBeyond : null),
    );
    for (const end of ['below', 'above'])
      this.on(`input[name=${end}]`, () =>
        attributes.write(
          'beyond',
          ['below', 'above'].map((name) => this.input(name).value.slice(1)).join(),
        ),
      );
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
    const [map, steps] = splitColorMap(settings.map);
    if (map.startsWith('custom:')) this.offerOwn(map);
    for (const swatch of this.root.querySelectorAll<HTMLInputElement>('input[name=colormap]'))
      swatch.checked = swatch.value === map;
    this.input('steps').value = steps > 0 ? String(steps) : '';
    this.input('steps').disabled = map === 'labels';
    this.showBeyond(settings);
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

  /** Own colours stay among the choices. */
  private offerOwn(map: string): void {
    const label = this.find('.swatch.custom');
    const swatch = find<HTMLInputElement>(label, 'input');
    label.hidden = false;
    if (swatch.value === map) return;
    swatch.value = map;
    paint(swatch);
  }

  private showBeyond({beyond}: Settings): void {
    const isOn = beyond.some((color) => color !== null);
    this.input('beyond').checked = isOn;
    for (const [i, name] of ['below', 'above'].entries()) {
      const input = this.input(name);
      input.hidden = !isOn;
      const color = beyond[i];
      input.value = `#${color ? hexOf(color) : kBeyond.split(',')[i]!}`;
    }
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
    const {value} = this.find<HTMLInputElement>('input[name=colormap]:checked');
    const steps = this.input('steps').value.trim();
    const isRight = steps === '' || isSteps(steps);
    this.input('steps').setCustomValidity(isRight ? '' : 'Steps are a number from 2 to 64.');
    if (!isRight) return void this.input('steps').reportValidity();
    const map = steps === '' || value === 'labels' ? value : `${value}/${steps}`;
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
/** Its controls are served by colorPanel. */
export const stepsPanel: PanelKind = {markup: kStepsMarkup};
