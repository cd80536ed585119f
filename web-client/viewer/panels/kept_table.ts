// The table of kept points and lines: names to edit, values of the shown field, and the distances
// and angles between them.

import type {KeptValues} from '../../core/session/inspector';
import {copy} from '../page/copy';
import {find, onClick, setAttribute, setText} from '../page/find';
import {formatValue, roundedUp} from '../page/format';
import {save} from '../page/save';
import {adopt, setMarkup} from '../page/trusted';
import {lengthUnit} from '../settings/length_unit';
import {keptText, kMaxName, plainName, type Kept, type KeptName} from '../settings/points';
import {textOfValue, valueText} from './hover';
import styles from './kept.css?inline';
import {measuredRows, valueRows, withinOf, type KeptScene} from './kept_rows';
import {toggle} from './markup';
import {
  cutOf,
  fileNameOf,
  fillRows,
  originOf,
  tableOfRows,
  textOfRows,
  type Row,
} from './numbers_table';
import type {PanelTools} from './panel';
import {placeText} from './pick_rows';
import {nounOf, pinColor, pinSign, titleOf} from './pin';

const kMarkup = `
<ul aria-label="Kept points and lines"></ul>
<p class="hint kept-within"></p>
<dl class="numbers"></dl>
${toggle('kept-all', 'All fields in copies')}
<div class="buttons">
  <button type="button" class="copy-kept">Copy</button>
  <button type="button" class="save-kept">Save as CSV</button>
</div>`;
const kRow = `
<label class="measured"><input type="checkbox"><span aria-hidden="true"></span></label>
<input type="text" autocomplete="off" spellcheck="false" maxlength="${kMaxName}">
<output></output>
<button type="button" class="icon">\u00d7</button>
<small></small>`;

export class KeptTable {
  private readonly list: HTMLElement;
  private kept: Record<KeptName, readonly Kept[]> = {points: [], lines: []};
  private readonly chosen = {points: new Set<number>(), lines: new Set<number>()};
  private scene: KeptScene | null = null;

  constructor(
    private readonly tools: PanelTools,
    private readonly place: HTMLElement,
  ) {
    const {page} = tools;
    adopt(page.root, styles);
    setMarkup(place, kMarkup);
    this.list = find(place, 'ul');
    onClick(
      place,
      '.copy-kept',
      () => void copy(textOfRows(this.rows), (text) => page.announce(text)),
    );
    onClick(place, '.save-kept', () => this.save());
  }

  /** `values` may be older than `kept`. */
  show(kept: {points: readonly Kept[]; lines: readonly Kept[]}, values: KeptValues): void {
    const {host} = this.tools;
    const {manifest} = host.mesh;
    const {length} = [...kept.points, ...kept.lines];
    this.place.hidden = length === 0;
    this.fitRows(kept);
    if (!manifest) return;
    this.scene = {
      ...kept,
      values,
      color: manifest.fields[values.color?.field ?? -1] ? values.color : null,
      manifest,
      level: values.level,
      unit: lengthUnit(host.settings, manifest),
    };
    this.fill(this.scene);
  }

  clear(): void {
    this.scene = null;
    for (const part of this.place.querySelectorAll('output, small')) part.textContent = '';
    find(this.place, 'dl').replaceChildren();
  }

  private get rows(): Row[] {
    const {chosen, scene} = this;
    const hasAll = find<HTMLInputElement>(this.place, '[name=kept-all]').checked;
    return scene ? [...valueRows(scene, hasAll), ...measuredRows(scene, chosen)] : [];
  }

  /** Rows stay while there are as many as before: the focus does, too. */
  private fitRows(kept: Record<KeptName, readonly Kept[]>): void {
    const isSame = (['points', 'lines'] as const).every(
      (kind) => kept[kind].length === this.kept[kind].length,
    );
    this.kept = kept;
    if (isSame) return;
    for (const set of Object.values(this.chosen)) set.clear();
    this.list.replaceChildren(
      ...kept.points.map((_, i) => this.rowOf('points', i)),
      ...kept.lines.map((_, i) => this.rowOf('lines', i)),
    );
  }

  private rowOf(kind: KeptName, i: number): HTMLElement {
    const row = document.createElement('li');
    setMarkup(row, kRow);
    row.style.setProperty('--pin', pinColor(kind, i));
    find(row, 'span').textContent = pinSign(kind, i);
    const chosen = this.chosen[kind];
    find<HTMLInputElement>(row, '[type=checkbox]').addEventListener('change', (event) => {
      if ((event.target as HTMLInputElement).checked) chosen.add(i);
      else chosen.delete(i);
      if (this.scene) this.fill(this.scene);
    });
    const name = find<HTMLInputElement>(row, '[type=text]');
    name.ariaLabel = `Name of ${kind.slice(0, -1)} ${pinSign(kind, i)}`;
    name.addEventListener('change', () => this.rename(kind, i, name.value));
    onClick(row, 'button', () => this.remove(kind, i));
    return row;
  }

  private rename(kind: KeptName, i: number, text: string): void {
    const name = plainName(text).slice(0, kMaxName).trim();
    this.write(
      kind,
      this.kept[kind].map((its, at) => (at === i ? {...its, name} : its)),
    );
    this.fitNames();
  }

  /** The next row's button, or the last one's, has the focus then. */
  private remove(kind: KeptName, i: number): void {
    const before = kind === 'points' ? 0 : this.kept.points.length;
    this.write(
      kind,
      this.kept[kind].filter((_, at) => at !== i),
    );
    const buttons = this.list.querySelectorAll<HTMLElement>('.icon');
    (buttons[Math.min(before + i, buttons.length - 1)] ?? null)?.focus();
  }

  private write(kind: KeptName, all: readonly Kept[]): void {
    this.tools.page.write(kind, keptText(all));
  }

  private get lines(): [HTMLElement, KeptName, number, Kept][] {
    const {points, lines} = this.kept;
    const all = [
      ...points.map((kept, i) => ['points', i, kept] as const),
      ...lines.map((kept, i) => ['lines', i, kept] as const),
    ];
    return all.map((its, row) => [this.list.children[row] as HTMLElement, ...its]);
  }

  private fitNames(): void {
    for (const [row, kind, i, kept] of this.lines) {
      const name = find<HTMLInputElement>(row, '[type=text]');
      name.placeholder = titleOf(kind, {...kept, name: ''}, i);
      if (this.tools.page.root.activeElement !== name || plainName(name.value) === kept.name)
        name.value = kept.name;
      const noun = nounOf(kind, kept, i);
      setAttribute(find(row, '[type=checkbox]'), 'aria-label', `Measure ${noun}`);
      setAttribute(find(row, 'button'), 'aria-label', `Remove ${noun}`);
    }
  }

  private fill(scene: KeptScene): void {
    const {color, manifest, unit, values} = scene;
    const {fields} = manifest;
    const info = color && fields[color.field]!;
    this.fitNames();
    for (const [row, kind, i, kept] of this.lines) {
      const [value, more] = [find(row, 'output'), find(row, 'small')];
      const length = unit && `\u202f${unit}`;
      if (kind === 'points') {
        const pick = values.points[i];
        setText(value, (pick && color && valueText(pick, color, fields)) ?? '');
        setText(
          more,
          `${placeText(pick?.rest ? pick.position : kept.places[0]!, manifest)}${length}`,
        );
        continue;
      }
      const line = values.lines[i];
      const hasMean = line && info && !info.labels && !Number.isNaN(line.mean);
      setText(value, hasMean ? `mean ${textOfValue(line.mean, info)}` : '');
      const parts = line ? [`length ${formatValue(line.length)}${length}`] : [];
      if (hasMean)
        parts.push(`${textOfValue(line.least, info)} to ${textOfValue(line.largest, info)}`);
      setText(more, parts.join(', '));
    }
    const within = color ? (withinOf(color.field, scene) ?? 0) : 0;
    setText(find(this.place, '.kept-within'), within > 0 ? boundText(within, info?.unit) : '');
    fillRows(find(this.place, 'dl'), measuredRows(scene, this.chosen));
  }

  /** The file's name, and its last columns, say where the numbers come from. */
  private save(): void {
    const {host, page} = this.tools;
    const cut = cutOf((name) => page.read(name), host.mesh);
    const origin = originOf(page.root, host.mesh, cut);
    const same = (['mesh', 'field', 'time'] as const).map((name) => [name, origin[name]] as const);
    const its = tableOfRows(
      this.rows,
      same.filter(([, text]) => text !== ''),
    );
    save(its, fileNameOf({...origin, place: `kept ${origin.place}`}, 'csv'));
  }
}

/** Before the last level it is sampled. */
const boundText = (within: number, unit = ''): string =>
  `Values are within ${roundedUp(within)}${unit && `\u202f${unit}`}.`;
