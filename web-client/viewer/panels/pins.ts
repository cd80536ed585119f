// Points and lines that are kept, and the points of the least and the largest value. Each is a dot
// on the mesh, that of a line at its middle. Beside it a small card of the same colour has values
// of the shown field. They follow the mesh, its time, and the camera. A card without room is
// folded: the dot has its number. A click on a dot opens the point or the line.

import {isEqual} from '../../core/protocol/equal';
import type {FieldInfo} from '../../core/protocol/fields';
import {placeOf, type Vector} from '../../core/protocol/geometry';
import type {KeptLine, KeptValues, Pick} from '../../core/session/inspector';
import {find, setText} from '../page/find';
import {formatValue} from '../page/format';
import {placeLabels} from '../page/label_place';
import {keptText, parseKept, type Kept, type KeptName} from '../settings/points';
import {textOfValue, valueText} from './hover';
import type {KeptTable} from './kept_table';
import {shape} from './marks';
import {toggle} from './markup';
import type {Panel, PanelKind, PanelTools} from './panel';
import {nounOf, Pin, titleOf} from './pin';
import {RepeatedQuestion} from './repeated_question';

const kExtremes = ['Least', 'Largest'];
const kNone: KeptValues = {level: 0, color: null, points: [], lines: [], extremes: []};

class Pins implements Panel {
  private readonly input: HTMLInputElement;
  private readonly layer = document.createElement('div');
  private readonly lines: SVGElement = shape('svg', {class: 'marks'});
  private readonly place: HTMLElement;
  private kept: {points: Kept[]; lines: Kept[]} = {points: [], lines: []};
  /** The least and the largest value are marked, too. Their pins are the last ones. */
  private hasExtremes = false;
  private answer = kNone;
  private pins: Pin[] = [];
  private table: KeptTable | null = null;
  private readonly question = new RepeatedQuestion(
    () => this.ask(),
    (answer) => this.take(answer),
  );

  constructor(private readonly tools: PanelTools) {
    const {page, signal} = tools;
    this.layer.className = 'pins';
    find(page.root, '.layer').after(this.layer);
    this.input = find(page.root, 'input[name=extremes]');
    this.input.addEventListener('change', () =>
      page.write('extremes', this.input.checked ? 'on' : null),
    );
    this.place = find(page.root, '.kept');
    // The content of a folded section or sheet takes no room.
    const watch = new ResizeObserver(() => void this.showTable());
    watch.observe(this.place);
    signal.addEventListener('abort', () => watch.disconnect());
  }

  update(): void {
    const {page} = this.tools;
    const [points, lines] = (['points', 'lines'] as const).map(
      (name) => parseKept(name, page.read(name) ?? '') ?? [],
    );
    const kept = {points: points!, lines: lines!};
    const hasExtremes = page.read('extremes') === 'on';
    this.input.checked = hasExtremes;
    if (isEqual([kept, hasExtremes], [this.kept, this.hasExtremes])) return;
    const hasSame = isEqual(placesOf(kept), placesOf(this.kept));
    this.kept = kept;
    this.hasExtremes = hasExtremes;
    if (!hasSame) this.answer = kNone;
    this.pins = [
      ...this.pinsOf('points'),
      ...this.pinsOf('lines'),
      ...(hasExtremes ? kExtremes : []).map((title, i) =>
        this.pinOf('extremes', i, title.toLowerCase(), () => page.write('extremes', null)),
      ),
    ];
    this.layer.replaceChildren(this.lines, ...this.pins.map(({root}) => root));
    if (hasSame) this.take(this.answer);
    void this.showTable();
    this.question.forget();
    this.question.repeat();
  }

  showPicture(): void {
    this.question.repeat();
  }

  /** The pins follow the picture. The card of the last one chooses its place first. */
  follow(): void {
    const {view} = this.tools.host;
    const seen = this.pins.flatMap((pin) => {
      const place = this.middleOf(pin);
      pin.root.hidden = !place || !view;
      return place && view ? [{pin, ...view.project(place)}] : [];
    });
    this.drawLines();
    if (!view) return;
    seen.reverse();
    const {clientWidth: width, clientHeight: height} = view.canvas;
    const dots = seen.map(({pin: {size, last}, x, y}) => ({x, y, ...size, last}));
    const places = placeLabels(dots, {width, height});
    seen.forEach(({pin, x, y}, i) => {
      const place = places[i] ?? null;
      pin.root.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      pin.root.classList.toggle('folded', place === null);
      if (!place) return;
      pin.last = place.choice;
      pin.card.style.transform = `translate(${place.x.toFixed(1)}px, ${place.y.toFixed(1)}px)`;
    });
  }

  clear(): void {
    this.question.forget();
    this.answer = kNone;
    this.table?.clear();
    this.follow();
  }

  private pinsOf(kind: KeptName): Pin[] {
    return this.kept[kind].map((kept, i) =>
      this.pinOf(kind, i, nounOf(kind, kept, i), () =>
        this.tools.page.write(kind, keptText(this.kept[kind].filter((_, at) => at !== i))),
      ),
    );
  }

  private pinOf(kind: Pin['kind'], i: number, title: string, remove: () => void): Pin {
    return new Pin(kind, i, title, {open: () => this.openPin(kind, i), remove});
  }

  private openPin(kind: Pin['kind'], i: number): void {
    const {host, open} = this.tools;
    const {answer} = this;
    const picks = kind === 'lines' ? (answer.lines[i]?.ends ?? []) : [answer[kind][i] ?? null];
    if (host.opening === null) open(picks.filter((pick) => pick !== null));
  }

  /** On the lattice, as drawn. */
  private middleOf({kind, at}: Pin): Vector | null {
    if (kind !== 'lines') return this.answer[kind][at]?.lattice ?? null;
    const [from, to] = this.answer.lines[at]?.ends ?? [];
    if (!from || !to) return null;
    return from.lattice.map((x, axis) => (x + to.lattice[axis]!) / 2) as Vector;
  }

  private drawLines(): void {
    const {view} = this.tools.host;
    const shapes = this.pins.flatMap(({at, color, kind}) => {
      const ends = kind === 'lines' && view ? this.answer.lines[at]?.ends : undefined;
      if (!ends) return [];
      const [from, to] = ends.map(({lattice}) => view!.project(lattice));
      const line = shape('line', {x1: from!.x, y1: from!.y, x2: to!.x, y2: to!.y});
      const dots = [from!, to!].map(({x, y}) => shape('circle', {cx: x, cy: y, r: 4}));
      const its = [line, ...dots];
      for (const element of its) element.style.setProperty('--pin', color);
      return its;
    });
    this.lines.replaceChildren(...shapes);
  }

  private ask(): Promise<KeptValues | null> | null {
    const {client, mesh, opening} = this.tools.host;
    if (this.pins.length === 0 || !mesh.snapshot || opening !== null) return null;
    const {lattice} = mesh.manifest!;
    const on = (place: Vector): Vector => placeOf(lattice, place);
    return client.kept({
      points: this.kept.points.map(({places: [place]}) => on(place!)),
      lines: this.kept.lines.map(({places: [from, to]}) => [on(from!), on(to!)]),
      hasExtremes: this.hasExtremes,
    });
  }

  private take(answer: KeptValues | null): void {
    if (!answer || this.tools.host.opening !== null) return; // the worker has another mesh
    this.answer = answer;
    for (const pin of this.pins) setText(pin.value, this.textOf(pin));
    for (const {root} of this.pins) root.hidden = false; // else it has no size
    for (const pin of this.pins)
      pin.size = {width: pin.card.offsetWidth, height: pin.card.offsetHeight};
    this.follow();
    this.table?.show(this.kept, answer);
  }

  private textOf({kind, at}: Pin): string {
    const fields = this.tools.host.mesh.manifest?.fields ?? [];
    const info = fields[this.answer.color?.field ?? -1] ?? null;
    const color = info && this.answer.color; // a derived field may have gone
    if (kind === 'lines')
      return lineText(titleOf(kind, this.kept.lines[at]!, at), this.answer.lines[at], info);
    const pick = this.answer[kind][at] ?? null;
    const value = pick && color ? valueText(pick, color, fields) : null;
    if (kind === 'extremes')
      return [kExtremes[at], value, pick && partName(pick, fields)].filter(Boolean).join(' ');
    const {name} = this.kept.points[at]!;
    return value === null ? titleOf(kind, this.kept.points[at]!, at) : `${name} ${value}`.trim();
  }

  /** The table is loaded once it is seen, and there is something in it. */
  private async showTable(): Promise<void> {
    const {kept, place, tools} = this;
    const isUsed = kept.points.length + kept.lines.length > 0;
    if (!this.table && (!isUsed || !place.offsetParent)) return;
    const loaded = this.table ? null : await import('./kept_table').catch(() => null);
    if (loaded) this.table ??= new loaded.KeptTable(tools, place);
    this.table?.show(this.kept, this.answer);
  }
}

const placesOf = ({points, lines}: {points: Kept[]; lines: Kept[]}): unknown =>
  [points, lines].map((all) => all.map(({places}) => places));

/** A title, then the mean and the ends of the values. Labels have neither. */
function lineText(
  title: string,
  line: KeptLine | null | undefined,
  info: FieldInfo | null,
): string {
  if (!line) return title;
  const length = `${title} ${formatValue(line.length)}`;
  if (!info || info.labels || Number.isNaN(line.mean)) return length;
  const [mean, least, largest] = [line.mean, line.least, line.largest].map((value) =>
    textOfValue(value, info),
  );
  return `${length}\nmean ${mean}\n${least} to ${largest}`;
}

/** "in steel": the name of a label there; null: there is none. */
function partName({fields: values}: Pick, fields: readonly FieldInfo[]): string | null {
  const names = values.map(({field, values: [value]}) =>
    fields[field]?.labels?.get(Math.round(value!)),
  );
  const name = names.find((its) => its !== undefined);
  return name === undefined ? null : `in ${name}`;
}

export const pinsPanel: PanelKind = {
  markup: `${toggle('extremes', 'Mark least and largest')}<div class="sub kept"></div>`,
  make: (tools) => new Pins(tools),
};
