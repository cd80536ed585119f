// The cards that the first picture needs: progress and legend. They take room, so that it finds its
// place beside them.

import {markedValues} from '../../core/layers/shown';
import type {Insets, View} from '../../webgl/view';
import {CardLayout} from '../page/card_layout';
import {find} from '../page/find';
import type {Page} from '../page/page';
import type {ShownMesh} from '../page/shown_mesh';
import type {Settings, ShownRange} from '../settings/settings';
import {Legend} from './legend';
import {ProgressPanel} from './progress_panel';

export class Shell {
  readonly progress: ProgressPanel;
  readonly cards: CardLayout;
  private readonly legend: Legend;
  /** The mesh has its place beside the cards. */
  private hasFit = false;

  /** `resized` is called when the viewer has another size. */
  constructor(
    private readonly page: Page,
    host: {readonly view: View | null},
    resized: () => void,
  ) {
    const {element, root} = page;
    this.progress = new ProgressPanel(root, (text) => page.announce(text));
    this.legend = new Legend(root);
    const covers = (insets: Insets, more: Insets | null): void => {
      host.view?.setInsets(insets);
      host.view?.setCovered(more);
    };
    this.cards = new CardLayout(element, root, covers, resized);
  }

  /** Shows the legend; null if nothing is coloured. */
  showRange(range: ShownRange | null, mesh: ShownMesh, settings: Settings): void {
    const {snapshot, manifest} = mesh;
    if (range && snapshot?.color && manifest) {
      const marked = markedValues(snapshot.color, (name) => this.page.read(name), manifest.fields);
      const {color, labels} = snapshot;
      const shown = labels ? {color, labels} : {color};
      this.legend.show(shown, manifest.fields, range, settings, marked);
      this.legend.showWarp(snapshot.warp?.scale ?? 0);
    } else {
      this.legend.hide();
    }
    if (this.hasFit || !snapshot) return;
    this.hasFit = true;
    find(this.page.root, '.time').hidden = mesh.times.length < 2;
    this.cards.refit();
  }

  /** Must be called before another mesh. */
  clear(): void {
    this.hasFit = false;
    this.progress.begin(null);
    this.legend.hide();
    find(this.page.root, '.time').hidden = true;
  }

  dispose(): void {
    this.cards.dispose();
  }
}
