// Keeps track of what the cards cover, and folds the panel.

import type {Insets} from '../../three/view';
import {find, onClick} from './find';
import {insetsOf} from './layout';

/** In a narrower viewer the panel is a sheet at the foot (style.css says the same). */
const kSheetPixels = 640;

export class CardLayout {
  /** The middle of the free area, as shares of the canvas. */
  middle: [number, number] = [0.5, 0.5];
  private readonly panel: HTMLElement;
  private readonly resizes = new ResizeObserver(() => this.arrange());

  /** `changed` receives the area that the cards cover. */
  constructor(
    private readonly element: HTMLElement,
    private readonly root: ShadowRoot,
    private readonly changed: (insets: Insets) => void,
  ) {
    this.panel = find(root, '.panel');
    onClick(root, '.fold', () => this.fold(!this.panel.classList.contains('folded')));
    this.fold(this.isNarrow);
    for (const box of [this.panel, find(root, '.result'), element]) this.resizes.observe(box);
  }

  arrange(): void {
    const {element, panel, root, isNarrow} = this;
    const cards = {panel, legend: find(root, '.legend'), result: find(root, '.result')};
    const insets = insetsOf(element, cards, isNarrow);
    element.style.setProperty('--sheet', `${isNarrow ? panel.offsetHeight : 0}px`);
    this.middle = [(1 + insets.left - insets.right) / 2, (1 + insets.top - insets.bottom) / 2];
    this.changed(insets);
  }

  dispose(): void {
    this.resizes.disconnect();
  }

  private get isNarrow(): boolean {
    return this.element.clientWidth <= kSheetPixels;
  }

  private fold(folded: boolean): void {
    this.panel.classList.toggle('folded', folded);
    find(this.root, '.fold').setAttribute('aria-expanded', String(!folded));
  }
}
