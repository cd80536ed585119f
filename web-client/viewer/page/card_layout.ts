// Keeps track of what the cards cover, and folds the panel.

import type {Insets} from '../../webgl/view';
import {find, onClick} from './find';
import {insetsOf} from './layout';

/** In a narrower viewer the panel is a sheet at the foot (style.css says the same). */
const kSheetPixels = 640;

export class CardLayout {
  /** The middle of the area for the mesh, as shares of the canvas. */
  middle: [number, number] = [0.5, 0.5];
  private insets: Insets | null = null;
  private readonly panel: HTMLElement;
  private readonly resizes = new ResizeObserver((entries) => {
    // The panel's own size moves nothing but what lies above it.
    const isResized = entries.some(({target}) => target === this.element);
    if (isResized) this.refit();
    this.placeAboveSheet();
    if (isResized) this.resized();
  });

  /**
   * `changed` receives the area that the cards cover. It is what they covered at the mesh's first
   * picture. A card that opens or closes later must not move the mesh. `resized` is called when the
   * viewer has another size.
   */
  constructor(
    private readonly element: HTMLElement,
    private readonly root: ShadowRoot,
    private readonly changed: (insets: Insets) => void,
    private readonly resized: () => void,
  ) {
    this.panel = find(root, '.panel');
    onClick(root, '.fold', () => this.fold(!this.panel.classList.contains('folded')));
    this.fold(this.isNarrow);
    for (const box of [this.panel, element]) this.resizes.observe(box);
  }

  /** Gives the mesh the area that is free now: for a first picture, and when the user asks. */
  refit(): void {
    const {panel, root} = this;
    const cards = {panel, legend: find(root, '.legend')};
    this.insets = insetsOf(this.element, cards, this.isNarrow);
    const {left, right, top, bottom} = this.insets;
    this.middle = [(1 + left - right) / 2, (1 + top - bottom) / 2];
    this.changed(this.insets);
  }

  /** Reports the area again, to another view. */
  repeat(): void {
    if (this.insets) this.changed(this.insets);
  }

  dispose(): void {
    this.resizes.disconnect();
  }

  private get isNarrow(): boolean {
    return this.element.clientWidth <= kSheetPixels;
  }

  private placeAboveSheet(): void {
    const height = this.isNarrow ? this.panel.offsetHeight : 0;
    this.element.style.setProperty('--sheet', `${height}px`);
  }

  private fold(folded: boolean): void {
    this.panel.classList.toggle('folded', folded);
    find(this.root, '.fold').setAttribute('aria-expanded', String(!folded));
  }
}
