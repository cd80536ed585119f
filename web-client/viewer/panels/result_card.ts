// The card of what was pointed at: rows of text, and the plot of a line. It opens where the mesh is
// not, and can be dragged.

import type {Probe} from '../../core/session/inspector';
import {placeCard, type Point, type Surroundings} from '../page/card_place';
import {find, onClick} from '../page/find';

export class ResultCard {
  private readonly card: HTMLElement;
  private plot: {destroy(): void} | null = null;
  /** The text to copy. */
  private text = '';
  /** The user has chosen the card's place. */
  private dragged = false;

  /** `closed` is called when the user closes it, `saveTable` when the line is to be saved. */
  constructor(
    private readonly root: ShadowRoot,
    private readonly announce: (text: string) => void,
    closed: () => void,
    saveTable: () => void,
  ) {
    this.card = find(root, '.result');
    onClick(root, '.copy-result', () => void this.copy());
    onClick(root, '.save-table', saveTable);
    onClick(root, '.close-result', closed);
    find(this.card, 'h2').addEventListener('pointerdown', (event) => this.drag(event));
  }

  get isOpen(): boolean {
    return !this.card.hidden;
  }

  /** Opens it. `hasPlot` keeps room for one. */
  show(title: string, rows: [string, string][], hasPlot: boolean): void {
    this.endPlot();
    this.card.hidden = false;
    find(this.card, '.plot').hidden = !hasPlot;
    this.text = rows.map((row) => row.join('\t').replaceAll('\u2212', '-')).join('\n');
    find(this.card, 'h2').textContent = title;
    find(this.card, 'dl').replaceChildren(
      ...rows.map(([name, value]) => {
        const row = document.createElement('div');
        row.append(
          Object.assign(document.createElement('dt'), {textContent: name}),
          Object.assign(document.createElement('dd'), {textContent: value}),
        );
        return row;
      }),
    );
    this.announce([title, ...rows.map((row) => row.join(' '))].join('. '));
  }

  /** Moves it to the best place, or keeps the one that the user has chosen. */
  place(around: Surroundings): void {
    if (!this.isOpen) return;
    const {offsetWidth, offsetHeight, offsetLeft, offsetTop} = this.card;
    this.moveTo(
      this.dragged ? {x: offsetLeft, y: offsetTop} : placeCard(offsetWidth, offsetHeight, around),
    );
  }

  hide(): void {
    this.endPlot();
    this.card.hidden = true;
    this.dragged = false;
  }

  /** Draws the field along a line. uPlot is loaded with the first plot. */
  async drawPlot(probe: Probe, title: string): Promise<void> {
    const {drawProbe} = await import('./probe_plot');
    this.endPlot();
    this.plot = drawProbe(this.root, find(this.card, '.plot'), probe, title);
    find(this.card, '.save-table').hidden = false;
  }

  private endPlot(): void {
    this.plot?.destroy();
    this.plot = null;
    find(this.card, '.hint').textContent = '';
    find(this.card, '.save-table').hidden = true;
  }

  /** Stays inside the viewer. */
  private moveTo({x, y}: Point): void {
    const {clientWidth, clientHeight} = this.root.host;
    const {card} = this;
    card.style.left = `${Math.max(0, Math.min(x, clientWidth - card.offsetWidth))}px`;
    card.style.top = `${Math.max(0, Math.min(y, clientHeight - card.offsetHeight))}px`;
  }

  private drag(event: PointerEvent): void {
    const title = event.currentTarget as HTMLElement;
    const x = this.card.offsetLeft - event.clientX;
    const y = this.card.offsetTop - event.clientY;
    title.setPointerCapture(event.pointerId);
    const move = (moved: PointerEvent): void => {
      this.dragged = true;
      this.moveTo({x: x + moved.clientX, y: y + moved.clientY});
    };
    title.addEventListener('pointermove', move);
    for (const end of ['pointerup', 'pointercancel'])
      title.addEventListener(end, () => title.removeEventListener('pointermove', move), {
        once: true,
      });
  }

  /** Pages without https have no clipboard. */
  private async copy(): Promise<void> {
    const clipboard = navigator.clipboard as Clipboard | undefined;
    const copied = await clipboard?.writeText(this.text).then(
      () => true,
      () => false,
    );
    this.announce(copied ? 'Copied' : 'The browser does not let this page copy');
  }
}
