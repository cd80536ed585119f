// How far to refine: fully, or up to a number of cells or bytes or an error. Coarser and finer
// change the cells by a factor of two.

import {parseNumbers} from '../../core/layers/field_values';
import {errorOfLevel, limitText, type Limit} from '../../core/protocol/limit';
import type {Page} from '../page/page';
import {shownScalar, type Settings} from '../settings/settings';
import type {Panel, PanelKind, PanelsHost} from './panel';

const kUnits = {full: '', cells: 'cells', bytes: 'kB', error: '%'};
/** Factors from the shown unit to the limit's own. */
const kFactors = {full: 1, cells: 1, bytes: 1000, error: 0.01};

/** The known error against bytes. */
const curves = ['ahead', 'reached', 'here']
  .map((name) => `<path class="${name}" vector-effect="non-scaling-stroke"/>`)
  .join('');

const kMarkup = `
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
</figure>`;

class LevelPanel implements Panel {
  private limit: Limit = {kind: 'full'};
  private readonly select: HTMLSelectElement;
  private readonly input: HTMLInputElement;

  constructor(
    private readonly page: Page,
    host: Pick<PanelsHost, 'mesh'>,
  ) {
    const {root} = page;
    this.select = root.querySelector('select[name=limit]')!;
    this.input = root.querySelector('input[name=limit-value]')!;
    this.select.addEventListener('change', () => {
      const kind = this.select.value as Limit['kind'];
      const {progress, manifest, firstField} = host.mesh;
      const {statistics} = progress;
      const {bytes, tetrahedra, level} = statistics;
      const color = shownScalar(page.read('field'), manifest?.fields ?? [], firstField);
      const fields = color ? [color.field] : [];
      // Starts from the mesh as it is now.
      const error = errorOfLevel(manifest?.levels, level, fields) ?? 0;
      const value = {
        cells: tetrahedra,
        bytes,
        error: error > 0 ? Number(error.toPrecision(2)) : 0.01,
      };
      this.set(kind === 'full' ? {kind} : {kind, value: Math.max(value[kind], Number.MIN_VALUE)});
    });
    this.input.addEventListener('change', () => {
      const [value = 0] = parseNumbers(this.input.value);
      const kind = this.select.value as Limit['kind'];
      if (kind !== 'full' && value > 0) this.set({kind, value: value * kFactors[kind]});
    });
    const scale = (factor: number): void => {
      const {statistics} = host.mesh.progress;
      const cells = Math.round(statistics.tetrahedra * factor);
      this.set(
        cells >= statistics.total.tetrahedra
          ? {kind: 'full'}
          : {kind: 'cells', value: Math.max(1, cells)},
      );
    };
    root.querySelector('.coarser')!.addEventListener('click', () => scale(0.5));
    root.querySelector('.finer')!.addEventListener('click', () => scale(2));
  }

  update({limit}: Settings): void {
    this.limit = limit;
    this.select.value = limit.kind;
    this.page.root.querySelector<HTMLElement>('.limit-value')!.hidden = limit.kind === 'full';
    this.page.root.querySelector('.limit-unit')!.textContent = kUnits[limit.kind];
    if (limit.kind !== 'full' && this.page.root.activeElement !== this.input)
      this.input.value = String(Number((limit.value / kFactors[limit.kind]).toPrecision(4)));
  }

  private set(limit: Limit): void {
    if (limitText(limit) !== limitText(this.limit))
      this.page.write('quality', limit.kind === 'full' ? null : limitText(limit));
  }
}

export const levelPanel: PanelKind = {
  markup: kMarkup,
  make: ({page, host}) => new LevelPanel(page, host),
};
