// Points that are kept, and those of the least and the largest value. Each is a dot on the mesh,
// and beside it a small card of the same colour with the value of the shown field. They follow the
// mesh, its time, and the camera. A card without room is folded: the dot has the point's number. A
// click on a dot opens the point.

import type {Vector} from '../../core/protocol/geometry';
import {isEqual} from '../../core/protocol/equal';
import type {FieldInfo} from '../../core/protocol/fields';
import type {Pick} from '../../core/session/inspector';
import {find, setText} from '../page/find';
import {placeLabels} from '../page/label_place';
import type {Page} from '../page/page';
import {parsePoints, pointsText} from '../settings/points';
import {valueText} from './hover';
import {toggle} from './markup';
import type {Panel, PanelKind, PanelsHost} from './panel';
import {RepeatedQuestion} from './repeated_question';

/** They differ from each other on both grounds, also for most who see few colours. */
const kColors = [
  '#e8590c',
  '#1c7ed6',
  '#2f9e44',
  '#d6336c',
  '#7048e8',
  '#0c8599',
  '#a6761d',
  '#5c6773',
];

/** The least value's and the largest's. */
const kExtremeColor = '#495057';
const kExtremes = [
  ['Least', '\u2193'],
  ['Largest', '\u2191'],
] as const;

interface Pin {
  root: HTMLElement;
  card: HTMLElement;
  value: HTMLElement;
  /** The card's. */
  size: {width: number; height: number};
  /** As LabelledDot.last. */
  last: number;
}

class Pins implements Panel {
  private readonly input: HTMLInputElement;
  private readonly layer = document.createElement('div');
  private points: Vector[] = [];
  /** The least and the largest value are marked, too. Their pins are the last ones. */
  private hasExtremes = false;
  /** Null: the point is not known yet, or the mesh has no cells. */
  private picks: (Pick | null)[] = [];
  private pins: Pin[] = [];
  private readonly question = new RepeatedQuestion(
    () => this.ask(),
    (picks) => this.take(picks),
  );

  constructor(
    private readonly page: Page,
    private readonly host: PanelsHost,
    private readonly open: (pick: Pick) => void,
  ) {
    this.layer.className = 'pins';
    find(page.root, '.layer').after(this.layer);
    this.input = find(page.root, 'input[name=extremes]');
    this.input.addEventListener('change', () =>
      page.write('extremes', this.input.checked ? 'on' : null),
    );
  }

  update(): void {
    const points = parsePoints(this.page.read('points') ?? '') ?? [];
    const hasExtremes = this.page.read('extremes') === 'on';
    this.input.checked = hasExtremes;
    if (isEqual(points, this.points) && hasExtremes === this.hasExtremes) return;
    this.points = points;
    this.hasExtremes = hasExtremes;
    this.picks = [];
    this.pins = [
      ...points.map((_, i) => {
        const others = (): string | null => pointsText(this.points.filter((_its, at) => at !== i));
        return this.pinOf(i, `${i + 1}`, kColors[i]!, `point ${i + 1}`, () =>
          this.page.write('points', others()),
        );
      }),
      ...(hasExtremes ? kExtremes : []).map(([title, sign], i) =>
        this.pinOf(points.length + i, sign, kExtremeColor, title.toLowerCase(), () =>
          this.page.write('extremes', null),
        ),
      ),
    ];
    this.layer.replaceChildren(...this.pins.map(({root}) => root));
    this.question.forget();
    this.question.repeat();
  }

  showPicture(): void {
    this.question.repeat();
  }

  /** The pins follow the picture. The card of the last point chooses its place first. */
  follow(): void {
    const {view} = this.host;
    const seen = this.pins.flatMap((pin, i) => {
      const pick = this.picks[i];
      pin.root.hidden = !pick || !view;
      return pick && view ? [{pin, ...view.project(pick.lattice)}] : [];
    });
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
    this.picks = [];
    this.follow();
  }

  private pinOf(i: number, sign: string, color: string, name: string, remove: () => void): Pin {
    const [root, card] = [document.createElement('div'), document.createElement('div')];
    const dot = document.createElement('i'); // the keyboard has the value
    dot.ariaHidden = 'true';
    dot.textContent = sign;
    dot.addEventListener('click', () => this.openPoint(i));
    const value = buttonOf(() => this.openPoint(i));
    root.className = 'pin';
    root.hidden = true;
    root.style.setProperty('--pin', color);
    const close = buttonOf(remove);
    close.textContent = '\u00d7';
    close.ariaLabel = `Remove ${name}`;
    card.append(value, close);
    root.append(dot, card);
    return {root, card, value, size: {width: 0, height: 0}, last: 0};
  }

  private openPoint(i: number): void {
    const pick = this.picks[i];
    if (pick && this.host.opening === null) this.open(pick);
  }

  private ask(): Promise<(Pick | null)[]> | null {
    const {client, mesh, opening} = this.host;
    if (this.pins.length === 0 || !mesh.snapshot || opening !== null) return null;
    const {origin, step} = mesh.manifest!.lattice;
    const extremes = this.hasExtremes ? client.numbers() : null;
    return Promise.all([
      ...this.points.map((point) =>
        client.at(point.map((x, axis) => (x - origin[axis]!) / step) as Vector),
      ),
      ...kExtremes.map(async (_, i) => (await extremes)?.extremes[i] ?? null),
    ]);
  }

  private take(picks: (Pick | null)[]): void {
    const {mesh, opening} = this.host;
    if (opening !== null) return; // the worker has another mesh
    this.picks = picks;
    const color = mesh.snapshot?.color;
    const fields = mesh.manifest?.fields ?? [];
    this.pins.forEach((pin, i) => {
      const pick = picks[i] ?? null;
      const value = pick && color ? valueText(pick, color, fields) : null;
      const [title] = kExtremes[i - this.points.length] ?? [];
      const text =
        title && [title, value, pick && partName(pick, fields)].filter(Boolean).join(' ');
      setText(pin.value, text ?? value ?? `Point ${i + 1}`);
    });
    for (const {root} of this.pins) root.hidden = false; // else it has no size
    for (const pin of this.pins)
      pin.size = {width: pin.card.offsetWidth, height: pin.card.offsetHeight};
    this.follow();
  }
}

/** "in steel": the name of a label there; null: there is none. */
function partName({fields: values}: Pick, fields: readonly FieldInfo[]): string | null {
  const names = values.map(({field, values: [value]}) =>
    fields[field]?.labels?.get(Math.round(value!)),
  );
  const name = names.find((its) => its !== undefined);
  return name === undefined ? null : `in ${name}`;
}

function buttonOf(press: () => void): HTMLButtonElement {
  const button = document.createElement('button');
  button.type = 'button';
  button.addEventListener('click', press);
  return button;
}

export const pinsPanel: PanelKind = {
  markup: toggle('extremes', 'Mark least and largest'),
  make: ({page, host, open}) => new Pins(page, host, open),
};
