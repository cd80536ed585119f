// Points that are kept. Each is a dot on the mesh, and beside it a small card of the same colour
// with the value of the shown field. They follow the mesh, its time, and the camera.

import type {Vector} from '../../core/protocol/geometry';
import {isEqual} from '../../core/protocol/equal';
import type {Pick} from '../../core/session/inspector';
import {find, setText} from '../page/find';
import type {Page} from '../page/page';
import {parsePoints, pointsText} from '../settings/points';
import {valueText} from './hover';
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

class Pins implements Panel {
  private readonly layer = document.createElement('div');
  private points: Vector[] = [];
  /** Null: the point is not known yet, or the mesh has no cells. */
  private picks: (Pick | null)[] = [];
  private readonly question = new RepeatedQuestion(
    () => this.ask(),
    (picks) => this.take(picks),
  );

  constructor(
    private readonly page: Page,
    private readonly host: PanelsHost,
  ) {
    this.layer.className = 'pins';
    find(page.root, '.layer').after(this.layer);
  }

  update(): void {
    const points = parsePoints(this.page.read('points') ?? '') ?? [];
    if (isEqual(points, this.points)) return;
    this.points = points;
    this.picks = [];
    this.layer.replaceChildren(...points.map((_point, i) => this.cardOf(i)));
    this.question.forget();
    this.question.repeat();
  }

  showPicture(): void {
    this.question.repeat();
  }

  /** The cards follow the picture. */
  follow(): void {
    const {view} = this.host;
    this.points.forEach((_, i) => {
      const card = this.layer.children[i] as HTMLElement;
      const pick = this.picks[i];
      card.hidden = !pick || !view;
      if (!pick || !view) return;
      const {x, y} = view.project(pick.lattice);
      card.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    });
  }

  clear(): void {
    this.question.forget();
    this.picks = [];
    this.follow();
  }

  private cardOf(i: number): HTMLElement {
    const card = document.createElement('div');
    card.className = 'pin';
    card.hidden = true;
    card.style.setProperty('--pin', kColors[i]!);
    const close = document.createElement('button');
    Object.assign(close, {
      type: 'button',
      ariaLabel: `Remove point ${i + 1}`,
      textContent: '\u00d7',
    });
    close.addEventListener('click', () =>
      this.page.write('points', pointsText(this.points.filter((_, at) => at !== i))),
    );
    card.append(document.createElement('i'), document.createElement('span'), close);
    return card;
  }

  private ask(): Promise<(Pick | null)[]> | null {
    const {client, mesh, opening} = this.host;
    if (this.points.length === 0 || !mesh.snapshot || opening !== null) return null;
    const {origin, step} = mesh.manifest!.lattice;
    return Promise.all(
      this.points.map((point) =>
        client.at(point.map((x, axis) => (x - origin[axis]!) / step) as Vector),
      ),
    );
  }

  private take(picks: (Pick | null)[]): void {
    const {mesh, opening} = this.host;
    if (opening !== null) return; // the worker has another mesh
    this.picks = picks;
    const color = mesh.snapshot?.color;
    const fields = mesh.manifest?.fields ?? [];
    picks.forEach((pick, i) => {
      const value = pick && color ? valueText(pick, color, fields) : null;
      setText(find(this.layer.children[i]!, 'span'), value ?? `Point ${i + 1}`);
    });
    this.follow();
  }
}

export const pinsPanel: PanelKind = {
  markup: '',
  make: ({page, host}) => new Pins(page, host),
};
