// The list of parts: which are hidden, seen through, or have colours of their own. Only rows in
// view exist, so that thousands of parts scroll like ten.

import {scalarText} from '../../core/layers/field_values';
import {
  isHidden,
  partField,
  partFields,
  partsTexts,
  readState,
  type PartsState,
} from '../../core/layers/parts_text';
import {hexOf, parseHex} from '../../core/picture/color_map_text';
import {labelColors} from '../../core/picture/color_maps';
import {kMagnitude} from '../../core/picture/field_scale';
import {labelColorOf} from '../../core/picture/labels';
import type {PartCount} from '../../core/picture/part_counts';
import type {FieldInfo} from '../../core/protocol/fields';
import {find, onClick, setAttribute, setText} from '../page/find';
import {formatCount} from '../page/format';
import {readLate} from '../page/late_readers';
import {lateRequests} from '../page/late_requests';
import {adopt, setMarkup} from '../page/trusted';
import {onSceneClick} from '../page/scene_events';
import {fillSelect} from '../page/select';
import {shownScalar, type Settings} from '../settings/settings';
import type {LateContent} from './late_panel';
import {scalarName, type PanelTools} from './panel';
import styles from './parts.css?inline';
import {RepeatedQuestion} from './repeated_question';

/** Pictures may come twenty times a second while the mesh refines; counting takes a while. */
const kRestMs = 500;
/** The values of the label are on their way. */
const kSoonMs = 60;
/** So many rows are in view at once. */
const kRowsInView = 9;
/** In CSS pixels, for a mouse and for fingers. */
const kRowHeights = [30, 44] as const;
/** The first opacity of a part that is seen through: what lies behind is seen well. */
const kSeeThrough = 0.3;
/** A press that moves no farther is a click, in CSS pixels. */
const kClickPixels = 4;
/** Where no colour is its own, and the field has colours. */
const kNoColor = 'c4c9d1';

const kEye =
  '<svg viewBox="0 0 20 20" aria-hidden="true"><path class="lid" d="M2 10c3.6-6.6 12.4-6.6 16 0' +
  '-3.6 6.6-12.4 6.6-16 0z"/><circle cx="10" cy="10" r="2.4"/></svg>';

const kMarkup = `
<label class="field parts-field" hidden>
  <span class="name">Label</span><select name="parts"></select>
</label>
<input type="text" name="parts-search" placeholder="Search" aria-label="Search parts"
  autocomplete="off" spellcheck="false">
<div class="part-rows" tabindex="0" role="list" aria-label="Parts">
  <div class="part-all"></div>
</div>
<p class="hint part-none" hidden>No part is called so.</p>
<div class="buttons">
  <button type="button" class="hide-part" title="Space">Hide</button>
  <button type="button" class="part-alone" title="A">Show alone</button>
  <button type="button" class="see-through-part" title="T">See through</button>
  <button type="button" class="all-parts">Show all</button>
</div>
<label class="row"><span class="name">Opacity</span><input type="range" name="part-opacity"
  min="5" max="100" step="5" aria-label="Opacity of the part"></label>
<button type="button" class="plain-parts">Reset all parts</button>`;

const kRow = `
<button type="button" class="icon eye" tabindex="-1">${kEye}</button>
<input type="color" tabindex="-1">
<span class="part-name"></span><span class="part-clear"></span>
<span class="part-cells"></span><span class="part-share"></span>`;

type Change = (state: {
  hidden: Set<number>;
  isInverse: boolean;
  opacities: Map<number, number>;
  colors: Map<number, readonly number[]>;
}) => void;

export class PartsList implements LateContent {
  private readonly rows: HTMLElement;
  private readonly all: HTMLElement;
  private readonly height = kRowHeights[matchMedia('(pointer: coarse)').matches ? 1 : 0];
  private readonly made: HTMLElement[] = [];
  private state: PartsState | null = null;
  private field = -1;
  /** Null before they are counted. */
  private counts: ReadonlyMap<number, PartCount> | null = null;
  /** All parts, and those that the search finds. */
  private labels: readonly number[] = [];
  private found: readonly number[] = [];
  private selected: number | null = null;
  private isSeen = false;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly question = new RepeatedQuestion(
    () => this.ask(),
    (counts) => this.takeCounts(counts),
  );

  constructor(
    private readonly tools: PanelTools,
    private readonly place: HTMLElement,
  ) {
    const {page, signal} = tools;
    lateRequests.read = readLate;
    adopt(page.root, styles);
    setMarkup(place, kMarkup);
    this.rows = find(place, '.part-rows');
    this.all = find(place, '.part-all');
    this.rows.addEventListener('scroll', () => this.draw());
    this.rows.addEventListener('keydown', (event) => this.press(event));
    this.rows.addEventListener('click', (event) => this.click(event.target as Element));
    this.rows.addEventListener('input', (event) => {
      const color = parseHex((event.target as HTMLInputElement).value.slice(1));
      const label = labelAt(event.target as Element);
      if (color && label !== null) this.change(({colors}) => colors.set(label, color));
    });
    find(place, '[name=parts]').addEventListener('change', (event) =>
      this.chooseField((event.target as HTMLSelectElement).value),
    );
    this.search.addEventListener('input', () => this.list());
    this.slider.addEventListener('input', () =>
      this.forSelected((label) => this.setOpacity(label, Number(this.slider.value) / 100)),
    );
    onClick(place, '.hide-part', () => this.forSelected((label) => this.toggle(label)));
    onClick(place, '.part-alone', () => this.forSelected((label) => this.showAlone(label)));
    onClick(place, '.see-through-part', () => this.forSelected((label) => this.seeThrough(label)));
    onClick(place, '.all-parts', () =>
      this.change((state) => {
        state.hidden = new Set();
        state.isInverse = false;
      }),
    );
    onClick(place, '.plain-parts', () => {
      for (const name of kPartAttributes) page.write(name, null);
    });
    onSceneClick(
      {root: page.root, signal},
      kClickPixels,
      (event) => void this.pick(event.offsetX, event.offsetY),
    );
    signal.addEventListener('abort', () => clearTimeout(this.timer));
  }

  /** The section is unfolded, or folded. */
  see(isSeen: boolean): void {
    this.isSeen = isSeen;
    if (isSeen) this.update(this.tools.host.settings);
    else this.highlight(null);
    this.question.repeat();
  }

  update(settings: Settings): void {
    const {host, page} = this.tools;
    const fields = host.mesh.manifest?.fields ?? [];
    const field = partField(page.read('parts'), fields);
    if (field < 0 || !this.isSeen) return;
    if (field !== this.field) {
      this.clear();
      this.field = field;
    }
    this.askFor(field);
    this.state = readState((name) => page.read(name), fields[field]!);
    this.palette = this.colorsOf(settings, fields);
    const options = partFields(fields).map((its) => ({field: its, component: kMagnitude}));
    find(this.place, '.parts-field').hidden = options.length < 2;
    fillSelect(
      find(this.place, '[name=parts]'),
      options.map((its) => ({value: scalarText(its, fields), title: scalarName(its, fields)})),
      scalarText({field, component: kMagnitude}, fields),
    );
    this.list();
  }

  /** The mesh may have other cells. */
  showPicture(): void {
    this.countSoon();
  }

  private countSoon(ms = kRestMs): void {
    if (!this.isSeen) return;
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      this.question.repeat();
    }, ms);
  }

  clear(): void {
    this.question.forget();
    this.counts = null;
    this.selected = null;
    this.field = -1;
  }

  // ---- what is listed

  /** The colours of labels, where the picture has them. */
  private palette: readonly (readonly number[])[] | null = null;

  private colorsOf(
    {map, reversed}: Settings,
    fields: readonly FieldInfo[],
  ): readonly (readonly number[])[] | null {
    const {firstField} = this.tools.host.mesh;
    const shown = shownScalar(this.tools.page.read('field'), fields, firstField);
    return map === 'labels' && shown?.field === this.field ? labelColors(reversed) : null;
  }

  private get info(): FieldInfo {
    return this.tools.host.mesh.manifest!.fields[this.field]!;
  }

  private get search(): HTMLInputElement {
    return find(this.place, '[name=parts-search]');
  }

  private get slider(): HTMLInputElement {
    return find(this.place, '[name=part-opacity]');
  }

  /** The values are fetched behind those that are drawn. */
  private askFor(field: number): void {
    const {host} = this.tools;
    const {ahead} = host.mesh;
    if (ahead.listed[0] === field) return;
    ahead.listed = [field];
    host.apply();
  }

  private ask(): Promise<PartCount[] | null> | null {
    const {client, mesh, opening} = this.tools.host;
    if (!mesh.snapshot || opening !== null || !this.isSeen || this.field < 0) return null;
    const {field} = this;
    return client
      .parts(field)
      .then((counts) => (mesh === this.tools.host.mesh && field === this.field ? counts : null));
  }

  private takeCounts(counts: PartCount[] | null): void {
    if (!counts) return this.countSoon(kSoonMs);
    this.counts = new Map(counts.map((count) => [count.label, count]));
    this.list();
  }

  /** While cells still come, parts without one are listed by their names. */
  private list(): void {
    if (this.field < 0) return;
    const {counts} = this;
    const named = [...(this.info.labels?.keys() ?? [])];
    const isWhole = this.tools.host.mesh.drawn !== null && this.isComplete;
    const all = counts ? [...counts.keys(), ...(isWhole ? [] : named)] : named;
    this.labels = [...new Set(all)].sort((a, b) => a - b);
    const word = this.search.value.trim().toLowerCase();
    this.found = this.labels.filter((label) => this.nameOf(label).toLowerCase().includes(word));
    find(this.place, '.part-none').hidden = this.found.length > 0 || word === '';
    this.all.style.height = `${this.found.length * this.height}px`;
    const rows = Math.min(kRowsInView, Math.max(1, this.labels.length));
    this.rows.style.height = `${rows * this.height}px`;
    this.draw();
  }

  private get isComplete(): boolean {
    const {drawn} = this.tools.host.mesh;
    return drawn !== null && drawn.bytes >= drawn.bytesNeeded;
  }

  private nameOf(label: number): string {
    return this.info.labels?.get(label) ?? String(label);
  }

  /** Fills the rows in view. */
  private draw(): void {
    const {found, height, made, rows, state} = this;
    if (!state || this.field < 0) return;
    const first = Math.floor(rows.scrollTop / height);
    const count = Math.max(0, Math.min(kRowsInView + 1, found.length - first));
    while (made.length < count) made.push(this.addRow());
    for (const row of made.splice(count)) row.remove();
    made.forEach((row, i) => this.fill(row, first + i, state));
    this.showActions(state);
  }

  private addRow(): HTMLElement {
    const row = document.createElement('div');
    row.className = 'part-row';
    row.setAttribute('role', 'listitem');
    setMarkup(row, kRow);
    row.style.height = `${this.height}px`;
    this.all.append(row);
    return row;
  }

  private fill(row: HTMLElement, at: number, state: PartsState): void {
    const label = this.found[at]!;
    const name = this.nameOf(label);
    const hidden = isHidden(state, label);
    const count = this.counts?.get(label);
    const opacity = state.opacities.get(label);
    const own = state.colors.get(label) ?? this.palette?.[labelColorOf(label)];
    row.dataset.label = String(label);
    row.style.top = `${at * this.height}px`;
    row.classList.toggle('hidden-part', hidden);
    row.classList.toggle('selected', label === this.selected);
    setAttribute(row, 'aria-current', String(label === this.selected));
    const eye = find(row, '.eye');
    setAttribute(eye, 'aria-label', `${hidden ? 'Show' : 'Hide'} ${name}`);
    setAttribute(eye, 'aria-pressed', String(!hidden));
    const color = find<HTMLInputElement>(row, 'input');
    color.value = `#${own ? hexOf(own) : kNoColor}`;
    color.classList.toggle('of-field', !own);
    setAttribute(color, 'aria-label', `Colour of ${name}`);
    setText(find(row, '.part-name'), name);
    setAttribute(row, 'title', name);
    setText(find(row, '.part-clear'), opacity === undefined ? '' : percent(opacity));
    setText(find(row, '.part-cells'), this.counts ? formatCount(count?.cells ?? 0) : '');
    setText(find(row, '.part-share'), this.counts ? percent(count?.share ?? 0) : '');
  }

  private showActions(state: PartsState): void {
    const {place, selected} = this;
    const isNone = selected === null;
    for (const name of ['.hide-part', '.part-alone', '.see-through-part'])
      find<HTMLButtonElement>(place, name).disabled = isNone;
    this.slider.disabled = isNone;
    const opacity = isNone ? 1 : (state.opacities.get(selected) ?? 1);
    this.slider.value = String(Math.round(100 * opacity));
    setText(find(place, '.hide-part'), !isNone && isHidden(state, selected) ? 'Show' : 'Hide');
    setText(find(place, '.see-through-part'), opacity < 1 ? 'Make solid' : 'See through');
    const isAll = state.hidden.size === 0 && !state.isInverse;
    find<HTMLButtonElement>(place, '.all-parts').disabled = isAll;
    find<HTMLButtonElement>(place, '.plain-parts').disabled =
      isAll && state.opacities.size + state.colors.size === 0;
  }

  // ---- what the user does

  private click(target: Element): void {
    const label = labelAt(target);
    if (label === null) return;
    if (target.closest('.eye')) return this.toggle(label);
    if (target.matches('input')) return;
    this.select(label === this.selected ? null : label);
  }

  private press(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const {found, selected} = this;
    const at = selected === null ? -1 : found.indexOf(selected);
    const go = (to: number): void =>
      this.select(found[Math.min(found.length - 1, Math.max(0, to))] ?? null);
    const keys: Record<string, () => void> = {
      ArrowDown: () => go(at + 1),
      ArrowUp: () => go(at - 1),
      Home: () => go(0),
      End: () => go(found.length - 1),
      PageDown: () => go(at + kRowsInView),
      PageUp: () => go(at - kRowsInView),
      ' ': () => this.forSelected((label) => this.toggle(label)),
      a: () => this.forSelected((label) => this.showAlone(label)),
      t: () => this.forSelected((label) => this.seeThrough(label)),
      Escape: () => this.select(null),
    };
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  /** Selects the part under a click, unless a tool takes it. */
  private async pick(x: number, y: number): Promise<void> {
    const {host, page} = this.tools;
    const tool = page.root.querySelector<HTMLInputElement>('.tools input:checked')?.value;
    if (!this.isSeen || this.field < 0 || !host.view || (tool ?? 'none') !== 'none') return;
    const pick = await host.client.pick(host.view.rayAt(x, y));
    const label = pick?.fields.find(({field}) => field === this.field)?.values[0];
    this.select(label === undefined ? null : Math.round(label));
  }

  private select(label: number | null): void {
    this.selected = label;
    this.highlight(label);
    if (label !== null) {
      if (!this.found.includes(label)) {
        this.search.value = '';
        this.list();
      }
      this.reveal(this.found.indexOf(label));
      this.tools.page.announce(this.sentenceOf(label));
    }
    this.draw();
  }

  private sentenceOf(label: number): string {
    const hidden = this.state && isHidden(this.state, label) ? ', hidden' : '';
    return `${this.nameOf(label)}${hidden}`;
  }

  private reveal(at: number): void {
    const {height, rows} = this;
    const top = at * height;
    if (top < rows.scrollTop) rows.scrollTop = top;
    else if (top + height > rows.scrollTop + rows.clientHeight)
      rows.scrollTop = top + height - rows.clientHeight;
  }

  /** It stands out in the picture. */
  private highlight(label: number | null): void {
    const {host} = this.tools;
    if (host.mesh.selectedPart === label) return;
    host.mesh.selectedPart = label;
    host.apply();
  }

  private forSelected(act: (label: number) => void): void {
    if (this.selected !== null) act(this.selected);
  }

  private toggle(label: number): void {
    this.change((state) => {
      if (isHidden(state, label) !== state.isInverse) state.hidden.delete(label);
      else state.hidden.add(label);
    });
    this.tools.page.announce(this.sentenceOf(label));
  }

  private showAlone(label: number): void {
    this.change((state) => {
      state.hidden = new Set([label]);
      state.isInverse = true;
    });
  }

  private seeThrough(label: number): void {
    this.setOpacity(label, this.state?.opacities.has(label) ? 1 : kSeeThrough);
  }

  private setOpacity(label: number, opacity: number): void {
    this.change(({opacities}) => {
      if (opacity < 1) opacities.set(label, opacity);
      else opacities.delete(label);
    });
  }

  private chooseField(key: string): void {
    const {page} = this.tools;
    for (const name of kPartAttributes) page.write(name, null);
    page.write('parts', key);
  }

  /** Nothing stands out any more, so that the change is seen as it is. */
  private change(change: Change): void {
    const {state} = this;
    if (!state || this.field < 0) return;
    const {host, page} = this.tools;
    const next = {
      hidden: new Set(state.hidden),
      isInverse: state.isInverse,
      opacities: new Map(state.opacities),
      colors: new Map(state.colors),
    };
    change(next);
    host.mesh.selectedPart = null;
    const texts = partsTexts(shorter(next, this.labels), this.info);
    const isPlain = Object.values(texts).every((text) => text === null);
    const {fields} = host.mesh.manifest!;
    const key = scalarText({field: this.field, component: kMagnitude}, fields);
    const isOnly = partFields(fields).length < 2;
    page.write('parts', isPlain && isOnly ? null : key);
    for (const [name, text] of Object.entries(texts))
      page.write(name as (typeof kPartAttributes)[number], text);
    host.apply();
  }
}

const kPartAttributes = ['parts', 'hidden-parts', 'part-opacity', 'part-colors'] as const;

/** The same parts are hidden, told by as few names as possible. */
export function shorter(state: PartsState, all: readonly number[]): PartsState {
  const hidden = all.filter((label) => isHidden(state, label));
  const isInverse = hidden.length > all.length / 2;
  const others = all.filter((label) => !isHidden(state, label));
  return {...state, isInverse, hidden: new Set(isInverse ? others : hidden)};
}

function labelAt(element: Element): number | null {
  const label = element.closest<HTMLElement>('.part-row')?.dataset.label;
  return label === undefined ? null : Number(label);
}

/** Two digits: "0.12 %", "3.4 %", "57 %". */
function percent(share: number): string {
  const value = 100 * share;
  const digits = value >= 9.95 || value === 0 ? 0 : value >= 0.995 ? 1 : 2;
  return `${value.toFixed(digits)}\u202f%`;
}
