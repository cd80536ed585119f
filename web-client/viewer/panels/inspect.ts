// Pointing at the mesh: shows a cell with its values, or two points with their distance and the
// field between them.

import type {Vector} from '../../core/protocol/geometry';
import type {Manifest} from '../../core/protocol/manifest';
import type {Client} from '../../core/session/client';
import type {Pick, Probe} from '../../core/session/inspector';
import type {View} from '../../three/view';
import {formatCount, formatTo, formatValue, resolutionOf} from '../page/format';
import {save} from '../page/save';

export type Tool = 'none' | 'point' | 'line';

/** A press that moves farther than this turns the mesh instead. */
const kClickPixels = 5;
/** Places are shown to this share of the lattice's span. */
const kPlaceShare = 1e-4;

export interface InspectHost {
  readonly client: Client | null;
  readonly view: View | null;
  readonly manifest: Manifest | null;
  /** The middle of the free area, as shares of the canvas. */
  readonly middle: [number, number];
  /** The title of the coloured field, for the plot. */
  readonly fieldTitle: string;
  announce(text: string): void;
  /** The place that is pointed at, in lattice coordinates, is refined first; null for none. */
  pointAt(point: Vector | null): void;
}

export class Inspect {
  private tool: Tool = 'none';
  private points: Pick[] = [];
  private pressed: {x: number; y: number} | null = null;
  private readonly card: HTMLElement;
  private readonly marks: SVGSVGElement;
  private plot: {destroy(): void} | null = null;
  /** The text to copy, and the plot as CSV. */
  private text = '';
  private table = '';

  /** Listens on the root, because another canvas may replace this one. */
  constructor(
    private readonly root: ShadowRoot,
    private readonly host: InspectHost,
  ) {
    this.card = root.querySelector('.result')!;
    this.marks = root.querySelector('.marks')!;
    const onCanvas = (
      type: 'pointerdown' | 'pointerup',
      receive: (event: PointerEvent) => void,
    ): void =>
      root.addEventListener(type, (event) => {
        if ((event.target as Element).matches('.scene')) receive(event as PointerEvent);
      });
    onCanvas('pointerdown', (event) => void (this.pressed = {x: event.clientX, y: event.clientY}));
    onCanvas('pointerup', (event) => {
      const moved = this.pressed
        ? Math.hypot(event.clientX - this.pressed.x, event.clientY - this.pressed.y)
        : Infinity;
      this.pressed = null;
      if (moved <= kClickPixels && this.tool !== 'none')
        void this.click(event.offsetX, event.offsetY);
    });
    root.addEventListener('dblclick', (event) => {
      if ((event.target as Element).matches('.scene')) void this.centre(event as MouseEvent);
    });
    root
      .querySelector('.tools')!
      .addEventListener('change', (event) =>
        this.use((event.target as HTMLInputElement).value as Tool),
      );
    root.querySelector('.copy-result')!.addEventListener('click', () => void this.copy());
    root.querySelector('.save-table')!.addEventListener('click', () => this.saveTable());
    root.querySelector('.close-result')!.addEventListener('click', () => this.clear());
  }

  use(tool: Tool): void {
    this.tool = tool;
    this.root.querySelector<HTMLInputElement>(`.tools input[value=${tool}]`)!.checked = true;
    this.root.querySelector<HTMLElement>('.scene')!.classList.toggle('pointing', tool !== 'none');
    this.clear();
  }

  /** Picks what is under the middle of the picture, for the keyboard. */
  pickMiddle(): void {
    const {
      view,
      middle: [x, y],
    } = this.host;
    if (!view) return;
    if (this.tool === 'none') this.use('point');
    void this.click(x * view.canvas.clientWidth, y * view.canvas.clientHeight);
  }

  clear(): void {
    this.points = [];
    this.plot?.destroy();
    this.plot = null;
    this.card.hidden = true;
    this.place();
    this.host.pointAt(null);
  }

  /** Brings a line's plot in line with the picture: another field, or a finer mesh. */
  refresh(): void {
    const [from, to] = this.points;
    if (this.tool === 'line' && from && to) void this.showLine(from, to);
  }

  /** Must be called after every frame, so that the marks follow their points. */
  place(): void {
    const {view} = this.host;
    this.marks.replaceChildren();
    if (!view) return;
    const at = this.points.map(({lattice}) => view.project(lattice));
    if (at.length === 2)
      this.marks.append(shape('line', {x1: at[0]!.x, y1: at[0]!.y, x2: at[1]!.x, y2: at[1]!.y}));
    for (const {x, y} of at) this.marks.append(shape('circle', {cx: x, cy: y, r: 5}));
  }

  /** Brings the place under a double click into the middle. */
  private async centre({offsetX, offsetY}: MouseEvent): Promise<void> {
    const {client, view} = this.host;
    const pick = view && (await client?.pick(view.rayAt(offsetX, offsetY)));
    if (pick) view.centre(pick.lattice);
  }

  private async click(x: number, y: number): Promise<void> {
    const {client, view} = this.host;
    if (!client || !view || view.canvas.clientWidth === 0) return; // a page may hide the viewer
    const pick = await client.pick(view.rayAt(x, y));
    if (!pick) {
      this.host.announce('Nothing there');
      if (this.tool === 'point') this.clear();
      return;
    }
    this.points =
      this.tool === 'line' && this.points.length === 1 ? [this.points[0]!, pick] : [pick];
    this.place();
    this.host.pointAt(pick.lattice);
    if (this.tool === 'point') this.showPick(pick);
    else if (this.points.length === 2) await this.showLine(this.points[0]!, pick);
    else
      this.showText(
        'Line',
        [['Start', this.placeText(pick.position)]],
        'Now point at the other end.',
      );
  }

  private showPick(pick: Pick): void {
    const fields = this.host.manifest!.fields;
    const rows: [string, string][] = [['Position', this.placeText(pick.position)]];
    for (const {field, values} of pick.fields) {
      const info = fields[field]!;
      const format = (value: number): string => formatTo(value, resolutionOf(info));
      rows.push([info.name, values.map(format).join(', ')]);
      if (values.length > 1) rows.push([`${info.name}, magnitude`, format(Math.hypot(...values))]);
    }
    rows.push(['Vertices', pick.corners.map(formatCount).join(', ')]);
    this.showText(`Cell ${formatCount(pick.cell)}`, rows);
  }

  private async showLine(from: Pick, to: Pick): Promise<void> {
    const probe = await this.host.client!.probe(from.lattice, to.lattice);
    if (!probe) return;
    const delta = to.position.map((x, axis) => x - from.position[axis]!) as Vector;
    this.showText('Line', [
      ['Distance', formatValue(probe.length)],
      ['Difference', this.placeText(delta)],
    ]);
    if (probe.values.length > 1) await this.drawPlot(probe);
  }

  /** Rounds to a ten-thousandth of the lattice's span. */
  private placeText(place: Vector): string {
    const {bits, step} = this.host.manifest!.lattice;
    return place.map((x) => formatTo(x, kPlaceShare * step * 2 ** bits)).join(', ');
  }

  /** uPlot is loaded with the first plot. */
  private async drawPlot(probe: Probe): Promise<void> {
    const {drawProbe} = await import('./probe_plot');
    this.plot?.destroy();
    this.plot = drawProbe(
      this.root,
      this.card.querySelector('.plot')!,
      probe,
      this.host.fieldTitle,
    );
    this.table = [
      ['distance', this.host.fieldTitle],
      ...probe.at.map((at, i) => [at, probe.values[i]!]),
    ]
      .map((row) => row.map(csvCell).join(','))
      .join('\r\n');
    this.card.querySelector<HTMLElement>('.save-table')!.hidden = false;
  }

  /** Pages without https have no clipboard. */
  private async copy(): Promise<void> {
    const clipboard = navigator.clipboard as Clipboard | undefined;
    const copied = await clipboard?.writeText(this.text).then(
      () => true,
      () => false,
    );
    this.host.announce(copied ? 'Copied' : 'The browser does not let this page copy');
  }

  private saveTable(): void {
    save(new Blob([this.table], {type: 'text/csv'}), 'line.csv');
  }

  private showText(title: string, rows: [string, string][], hint = ''): void {
    this.plot?.destroy();
    this.plot = null;
    this.card.hidden = false;
    this.card.querySelector<HTMLElement>('.save-table')!.hidden = true;
    this.text = rows.map((row) => row.join('\t').replaceAll('\u2212', '-')).join('\n');
    this.card.querySelector('h2')!.textContent = title;
    this.card.querySelector('.hint')!.textContent = hint;
    this.card.querySelector('dl')!.replaceChildren(
      ...rows.map(([name, value]) => {
        const row = document.createElement('div');
        row.append(
          Object.assign(document.createElement('dt'), {textContent: name}),
          Object.assign(document.createElement('dd'), {textContent: value}),
        );
        return row;
      }),
    );
    this.host.announce([title, ...rows.map((row) => row.join(' ')), hint].join('. '));
  }
}

/** A missing value is an empty cell. */
function csvCell(value: string | number): string {
  if (typeof value === 'string') return `"${value.replaceAll('"', '""')}"`;
  return Number.isNaN(value) ? '' : String(value);
}

function shape(name: string, attributes: Record<string, number>): SVGElement {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes))
    element.setAttribute(key, value.toFixed(1));
  return element;
}
