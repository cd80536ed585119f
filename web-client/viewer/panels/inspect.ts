// Pointing at the mesh: shows a cell with its values, or two points with their distance and the
// field between them.

import type {Vector} from '../../core/protocol/geometry';
import type {Client} from '../../core/session/client';
import type {Pick} from '../../core/session/inspector';
import {cornersOf} from '../../webgl/outline';
import type {View} from '../../webgl/view';
import {formatIn, formatValue} from '../page/format';
import type {Point} from '../page/card_place';
import {save} from '../page/save';
import {onScene, onSceneClick} from '../page/scene_events';
import {OverTime, type OverTimeHost, type TimeCard} from './over_time';
import {cellOutline, shape} from './marks';
import {segments} from './markup';
import {pickRows, pickTitle, placeText} from './pick_rows';
import {RepeatedQuestion} from './repeated_question';
import {ResultCard} from './result_card';

export type Tool = 'none' | 'point' | 'line';

const kToolTitles = {none: 'Turn', point: 'Point', line: 'Line'};
export const kToolMarkup = `
<fieldset class="segments tools">
  <legend class="visually-hidden">Pointer</legend>
  ${segments('tool', kToolTitles)}
</fieldset>`;

/** The text before the first click. */
const kFirstHints: Record<Tool, string> = {
  none: '',
  point: 'Point at a place on the mesh.',
  line: 'Point at one end of the line.',
};
/** A press that moves farther than this turns the mesh instead. */
const kClickPixels = 5;
/** Those of a place in a file's name. */
const kPlaceDigits = 4;

export interface InspectHost extends OverTimeHost {
  /** Null while it has another mesh than the one in the picture. */
  readonly client: Client | null;
  readonly view: View | null;
  /** The middle of the free area, as shares of the canvas. */
  readonly middle: [number, number];
  /** This point or line may stay: it does not yet, and there is room. */
  mayKeep(places: Vector[]): boolean;
  /** Places of the mesh at rest, in its own coordinates: one of a point, two of a line. */
  keep(places: Vector[]): void;
}

export class Inspect {
  private tool: Tool = 'none';
  private points: Pick[] = [];
  private readonly card: ResultCard;
  private readonly overTime: OverTime;
  private readonly marks: SVGSVGElement;
  /** Asks which cell and values a point has now. */
  private readonly question = new RepeatedQuestion(
    () => this.askAgain(),
    (pick) => this.takeAgain(pick),
  );
  /** The point in question, on the lattice at rest. */
  private asked: Vector | null = null;

  /** Listens on the root, because another canvas may replace this one. */
  constructor(
    private readonly root: ShadowRoot,
    private readonly host: InspectHost,
  ) {
    this.card = new ResultCard(root, (text) => host.announce(text), {
      close: () => this.clear(),
      saveTable: () => void this.saveTable(),
      keep: () => this.keep(),
      overTime: () => void this.overTime.begin(materialPlace(this.points[0]!)),
      exact: () => this.overTime.askExact(),
    });
    this.overTime = new OverTime(host, {
      open: (choose, isWanted) => this.openTimePlot(choose, isWanted),
      offerExact: (isOffered) => this.card.offerExact(isOffered),
      close: () => this.card.closePlot(),
    });
    this.marks = root.querySelector('.marks')!;
    onSceneClick({root}, kClickPixels, (event) => {
      if (this.tool !== 'none') void this.click(event.offsetX, event.offsetY);
    });
    onScene({root}, 'dblclick', (event) => void this.centre(event));
    root
      .querySelector('.tools')!
      .addEventListener('change', (event) =>
        this.use((event.target as HTMLInputElement).value as Tool),
      );
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

  /** Opens the card of a point or of a line, as if it was pointed at. */
  open(picks: Pick[]): void {
    const [pick, to] = picks;
    if (!pick) return;
    this.use(to ? 'line' : 'point');
    this.setPoints(picks);
    this.place();
    this.hint('');
    if (to) void this.showLine(pick, to);
    else this.showPick(pick);
  }

  /** The place that is pointed at, in lattice coordinates; null for none. */
  get pointed(): Vector | null {
    return this.points.at(-1)?.lattice ?? null;
  }

  clear(): void {
    this.setPoints([]);
    if (this.overTime.isOpen) {
      this.overTime.end();
      this.host.apply();
    }
    this.card.hide();
    this.hint(kFirstHints[this.tool]);
    this.place();
  }

  /** Ends the plots: uPlot keeps those that are not destroyed. */
  dispose(): void {
    this.overTime.end();
    this.card.dispose();
  }

  /** Brings a line's plot in line with the picture: another field, or a finer mesh. */
  refresh(): void {
    const [from, to] = this.points;
    if (this.tool === 'line' && from && to) void this.showLine(from, to);
  }

  /** The mesh may have another shape, other cells, or other values. */
  showPicture(): void {
    this.question.repeat();
  }

  /** Brings the plot over time in line with the attributes. */
  update(): void {
    this.overTime.update();
    this.card.offerOverTime(this.offersOverTime);
  }

  /** Must be called when more is here. */
  takeProgress(): void {
    this.overTime.takeProgress();
  }

  /** Must be called when the viewer has another size. */
  arrange(): void {
    if (this.card.isOpen) this.placeCard();
  }

  /** Must be called after every frame, so that the marks follow their points. */
  place(): void {
    const {view} = this.host;
    this.marks.replaceChildren();
    if (!view) return;
    if (this.tool === 'point')
      for (const {places} of this.points) this.marks.append(cellOutline(places, view));
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
    const isEnd = this.tool === 'line' && this.points.length === 1;
    this.setPoints(isEnd ? [this.points[0]!, pick] : [pick]);
    this.place();
    const [from, to] = this.points;
    this.hint(this.tool === 'line' && !to ? 'Now point at the other end.' : '');
    if (this.tool === 'point') this.showPick(pick);
    else if (!to) this.card.hide();
    else await this.showLine(from!, to);
  }

  private setPoints(points: Pick[]): void {
    const [pick] = points;
    this.points = points;
    this.asked = pick && this.tool === 'point' ? placeInside(pick) : null;
    this.question.forget();
  }

  private askAgain(): Promise<Pick | null> | null {
    const {client} = this.host;
    return this.asked ? (client?.at(this.asked) ?? null) : null;
  }

  private takeAgain(pick: Pick | null): void {
    if (!pick || !this.host.client) return; // the worker has another mesh
    this.points = [pick];
    this.place();
    const {color, mesh} = this.host;
    this.card.write(pickTitle(pick, color, mesh.manifest!), pickRows(pick, mesh.manifest!));
  }

  private showPick(pick: Pick): void {
    const {isOpen} = this.overTime;
    const {color, mesh} = this.host;
    this.card.show(pickTitle(pick, color, mesh.manifest!), pickRows(pick, mesh.manifest!), isOpen);
    this.card.offerKeep(this.host.mayKeep([placeAtRest(pick)]));
    this.card.offerOverTime(this.offersOverTime);
    this.placeCard();
    if (isOpen) void this.overTime.begin(materialPlace(pick));
  }

  /** It gets a card of its own. */
  private keep(): void {
    const places = this.points.map(placeAtRest);
    this.clear();
    this.host.keep(places);
  }

  private get offersOverTime(): boolean {
    const {isOffered, isOpen} = this.overTime;
    return this.tool === 'point' && this.points.length > 0 && isOffered && !isOpen;
  }

  /** uPlot is loaded with the first plot. */
  private async openTimePlot(
    ...[choose, isWanted]: Parameters<TimeCard['open']>
  ): ReturnType<TimeCard['open']> {
    const {drawOverTime} = await import('./probe_plot');
    if (!isWanted()) return null;
    const plot = this.card.plotBy((root, place) => drawOverTime(root, place, choose));
    this.placeCard();
    return plot;
  }

  private async showLine(from: Pick, to: Pick): Promise<void> {
    const probe = await this.host.client?.probe(from.lattice, to.lattice);
    if (!probe) return;
    const {color, fieldTitle, mesh} = this.host;
    const delta = to.position.map((x, axis) => x - from.position[axis]!) as Vector;
    const hasPlot = probe.values.length > 1;
    const rows: [string, string][] = [
      ['Distance', formatValue(probe.length)],
      ['Difference', placeText(delta, mesh.manifest!)],
    ];
    const opens = !this.card.isOpen;
    this.card.show('Line', rows, hasPlot);
    this.card.offerKeep(this.host.mayKeep([from, to].map(placeAtRest)));
    if (opens) this.placeCard();
    const info = color && mesh.manifest?.fields[color.field];
    const format = info?.labels && ((value: number): string => formatIn(info, value));
    if (hasPlot) await this.card.drawPlot(probe, fieldTitle, format);
  }

  /** The file's name, and its last columns, say where the values come from. */
  private async saveTable(): Promise<void> {
    const {client, mesh} = this.host;
    const tables = await import('./probe_plot'); // the plot has loaded it
    const {fileNameOf, originOf, tableOf, timeTableOf, timeTitle} = tables;
    const {fields, units} = mesh.manifest!;
    const unit = units?.get('');
    const places = this.points.map(placeAtRest);
    const place = places.map((its) =>
      its.map((x) => Number(x.toPrecision(kPlaceDigits))).join(' '),
    );
    const origin = originOf(this.root, mesh, place.join(' to '));
    if (this.overTime.isOpen) {
      const at = places[0]!.map((x, axis) => ['xyz'[axis]!, x] as const);
      const table = timeTableOf(this.overTime.table(), fields, unit, [
        ...at,
        ['mesh', origin.mesh],
      ]);
      return save(table, fileNameOf({...origin, time: '', place: `at ${origin.place}`}, 'csv'));
    }
    const [from, to] = this.points.map(({lattice}) => lattice);
    const values = await client?.line(from!, to!);
    if (!values) return;
    const {color} = this.host;
    const time = color && fields[color.field]!.instant?.time;
    const same = [
      ...(time === undefined || time === null ? [] : [[timeTitle(unit), time] as const]),
      ['mesh', origin.mesh] as const,
    ];
    save(
      tableOf(values, fields, same),
      fileNameOf({...origin, place: `line ${origin.place}`}, 'csv'),
    );
  }

  /** Puts the card beside the last point, where the mesh and the other cards are not. */
  private placeCard(): void {
    const {view, mesh} = this.host;
    if (!view) return;
    const at = ({lattice}: Pick): Point => view.project(lattice);
    const whole = this.root.host.getBoundingClientRect();
    const cards = ['.panel', '.legend', '.time', '.tool-hint'].map((name) =>
      this.root.querySelector(name)!.getBoundingClientRect(),
    );
    this.card.place({
      width: whole.width,
      height: whole.height,
      cards: cards
        .filter(({width}) => width > 0)
        .map(({left, top, right, bottom}) => ({
          left: left - whole.left,
          top: top - whole.top,
          right: right - whole.left,
          bottom: bottom - whole.top,
        })),
      picked: this.points.map(at),
      mesh: cornersOf(mesh.base.bounds).map((corner) => view.project(corner)),
    });
  }

  /** Says the next step, in the picture and to screen readers; empty: nothing. */
  private hint(text: string): void {
    const hint = this.root.querySelector<HTMLElement>('.tool-hint')!;
    hint.hidden = text === '';
    if (hint.textContent !== text && text !== '') this.host.announce(text);
    hint.textContent = text;
  }
}

/** In the mesh's own coordinates. */
const placeAtRest = ({position, rest}: Pick): Vector => rest?.position ?? position;

/** A place of the mesh at rest: a point that moves keeps it. */
const materialPlace = ({lattice, rest}: Pick): Vector => rest?.lattice ?? lattice;

/** So far, as a share of the way to its cell's middle, a place lies inside: no face is shared. */
const kInside = 1e-6;

/** That place, in the pick's cell and in none beside it, which a clip may have taken away. */
function placeInside(pick: Pick): Vector {
  const {lattice, places} = pick;
  return materialPlace(pick).map((x, axis) => {
    const middle = places.reduce((sum, place) => sum + place[axis]!, 0) / places.length;
    return x + kInside * (middle - lattice[axis]!);
  }) as Vector;
}
