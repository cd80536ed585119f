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
  /** The insets of an open sheet; null: there is none. */
  private covered: Insets | null = null;
  private readonly panel: HTMLElement;
  private readonly resizes = new ResizeObserver((entries) => {
    // The panel's own size moves nothing but what lies above it.
    const isResized = entries.some(({target}) => target === this.element);
    if (isResized) this.refit();
    this.placeAboveSheet();
    this.follow();
    if (isResized) this.resized();
  });

  /**
   * `changed` receives the area that the cards cover. It is what they covered at the mesh's first
   * picture. A card that opens or closes later must not move the camera. `more` is what an open
   * sheet covers until it is folded. `resized` is called when the viewer has another size.
   */
  constructor(
    private readonly element: HTMLElement,
    private readonly root: ShadowRoot,
    private readonly changed: (insets: Insets, more: Insets | null) => void,
    private readonly resized: () => void,
  ) {
    this.panel = find(root, '.panel');
    onClick(root, '.fold', () => this.fold(!this.isFolded));
    this.fold(this.isNarrow);
    for (const box of [this.panel, element]) this.resizes.observe(box);
  }

  /** Gives the mesh the area that is free now: for a first picture, and when the user asks. */
  refit(): void {
    this.insets = this.isOpenSheet ? this.measuredFolded() : this.measured();
    this.follow();
  }

  /** Reports the area again, to another view. */
  repeat(): void {
    if (this.insets) this.changed(this.insets, this.covered);
  }

  dispose(): void {
    this.resizes.disconnect();
  }

  private get isNarrow(): boolean {
    return this.element.clientWidth <= kSheetPixels;
  }

  private get isFolded(): boolean {
    return this.panel.classList.contains('folded');
  }

  private get isOpenSheet(): boolean {
    return this.isNarrow && !this.isFolded;
  }

  private measured(): Insets {
    const [legend, time] = ['.legend', '.time'].map((name) => find(this.root, name));
    const cards = {panel: this.panel, legend: legend!, time: time!};
    return insetsOf(this.element, cards, this.isNarrow);
  }

  /** With the sheet folded, where the mesh has its lasting place. */
  private measuredFolded(): Insets {
    const body = find(this.root, '.body');
    const {scrollTop} = body;
    this.panel.classList.add('folded');
    const insets = this.measured();
    this.panel.classList.remove('folded');
    body.scrollTop = scrollTop;
    return insets;
  }

  /** An open sheet lets the picture go above it. */
  private follow(): void {
    if (!this.insets) return;
    this.covered = this.isOpenSheet ? this.measured() : null;
    const {left, right, top, bottom} = this.covered ?? this.insets;
    this.middle = [(1 + left - right) / 2, (1 + top - bottom) / 2];
    this.repeat();
  }

  private placeAboveSheet(): void {
    const height = this.isNarrow ? this.panel.offsetHeight : 0;
    this.element.style.setProperty('--sheet', `${height}px`);
  }

  private fold(folded: boolean): void {
    this.panel.classList.toggle('folded', folded);
    find(this.root, '.fold').setAttribute('aria-expanded', String(!folded));
    this.follow();
  }
}
