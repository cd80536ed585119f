// The card of what was pointed at: rows of text, and the plot of a line. It opens where the mesh is
// not, and can be dragged.

import type {Probe} from '../../core/session/inspector';
import {placeCard, type Point, type Surroundings} from '../page/card_place';
import {copy} from '../page/copy';
import {find, onClick} from '../page/find';

interface Plot {
  destroy(): void;
}

/** They are called when the user presses the buttons. */
export interface CardActions {
  close(): void;
  /** Saves the plot's values. */
  saveTable(): void;
  /** The point or the line stays. */
  keep(): void;
  /** Plots the values over time. */
  overTime(): void;
  /** Gets those exactly. */
  exact(): void;
}

export class ResultCard {
  private readonly card: HTMLElement;
  private plot: Plot | null = null;
  /** The text to copy. */
  private text = '';
  /** The user has chosen the card's place. */
  private dragged = false;
  /** The viewer is gone: uPlot would keep it with every plot that is not destroyed. */
  private ended = false;

  constructor(
    private readonly root: ShadowRoot,
    private readonly announce: (text: string) => void,
    actions: CardActions,
  ) {
    this.card = find(root, '.result');
    onClick(root, '.copy-result', () => void copy(this.text, this.announce));
    onClick(root, '.save-table', () => actions.saveTable());
    onClick(root, '.keep-point', () => actions.keep());
    onClick(root, '.over-time', () => actions.overTime());
    onClick(this.card, '.exact', () => actions.exact());
    onClick(root, '.close-result', () => actions.close());
    find(this.card, 'h2').addEventListener('pointerdown', (event) => this.drag(event));
  }

  get isOpen(): boolean {
    return !this.card.hidden;
  }

  /** Opens it. `hasPlot` keeps room for one. */
  show(title: string, rows: [string, string][], hasPlot: boolean): void {
    this.endPlot();
    this.offerOverTime(false);
    this.offerKeep(false);
    this.card.hidden = false;
    find(this.card, '.plot').hidden = !hasPlot;
    this.write(title, rows);
    this.announce([title, ...rows.map((row) => row.join(' '))].join('. '));
  }

  /** Its texts, while a plot stays. */
  write(title: string, rows: [string, string][]): void {
    const heading = find(this.card, 'h2');
    const text = rows.map((row) => row.join('\t').replaceAll('\u2212', '-')).join('\n');
    if (text === this.text && title === heading.textContent) return; // a selection stays
    this.text = text;
    heading.textContent = title;
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
  }

  /** Offers the plot over time, or not. */
  offerOverTime(isOffered: boolean): void {
    find(this.card, '.over-time').hidden = !isOffered;
  }

  /** Offers to keep the point or the line, or not. */
  offerKeep(isOffered: boolean): void {
    find(this.card, '.keep-point').hidden = !isOffered;
  }

  /** Offers the exact values, or not. */
  offerExact(isOffered: boolean): void {
    find(this.card, '.exact').hidden = !isOffered;
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

  dispose(): void {
    this.ended = true;
    this.hide();
  }

  /** Draws the field along a line. uPlot is loaded with the first plot. */
  async drawPlot(probe: Probe, title: string, format?: (value: number) => string): Promise<void> {
    const {drawProbe} = await import('./probe_plot');
    if (!this.ended) this.plotBy((root, place) => drawProbe(root, place, probe, title, format));
  }

  /** Makes room for what `draw` draws. */
  plotBy<Its extends Plot>(draw: (root: ShadowRoot, place: HTMLElement) => Its): Its {
    this.endPlot();
    const place = find(this.card, '.plot');
    place.hidden = false;
    const plot = draw(this.root, place);
    this.plot = plot;
    find(this.card, '.save-table').hidden = false;
    return plot;
  }

  /** Gives up the room of the plot. */
  closePlot(): void {
    this.endPlot();
    find(this.card, '.plot').hidden = true;
  }

  private endPlot(): void {
    this.plot?.destroy();
    this.plot = null;
    for (const name of ['.readout', '.status']) find(this.card, name).textContent = '';
    find(this.card, '.save-table').hidden = true;
    this.offerExact(false);
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
}
