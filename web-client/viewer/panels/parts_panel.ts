// The section of parts. Its list is loaded when the section is seen.

import {partFields} from '../../core/layers/parts_text';
import {find} from '../page/find';
import type {Settings} from '../settings/settings';
import type {Panel, PanelKind, PanelTools, Scene} from './panel';
import type {PartsList} from './parts_list';

const kMarkup = '<div class="sub parts"></div>';

class PartsPanel implements Panel {
  private readonly place: HTMLElement;
  private readonly section: HTMLElement;
  private list: PartsList | null = null;
  private isSeen = false;

  constructor(private readonly tools: PanelTools) {
    this.place = find(tools.page.root, '.parts');
    this.section = this.place.closest('details')!;
    // The content of a folded section or sheet takes no room.
    const watch = new ResizeObserver(() => void this.see(this.place.offsetParent !== null));
    watch.observe(this.place);
    tools.signal.addEventListener('abort', () => watch.disconnect());
  }

  update(settings: Settings, scene: Scene | null): void {
    this.section.hidden = partFields(scene?.manifest.fields ?? []).length === 0;
    this.list?.update(settings);
  }

  showPicture(): void {
    this.list?.countSoon();
  }

  clear(): void {
    this.list?.clear();
  }

  private async see(isSeen: boolean): Promise<void> {
    if (isSeen === this.isSeen) return;
    this.isSeen = isSeen;
    if (isSeen && !this.list) {
      const loaded = await import('./parts_list').catch(() => null);
      if (!loaded) return void (this.isSeen = false);
      this.list ??= new loaded.PartsList(this.tools, this.place);
    }
    this.list?.see(this.isSeen);
  }
}

export const partsPanel: PanelKind = {
  markup: kMarkup,
  make: (tools) => new PartsPanel(tools),
};
