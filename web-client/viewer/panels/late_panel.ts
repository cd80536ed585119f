// A panel whose content is loaded when its section is first seen.

import type {FieldInfo} from '../../core/protocol/fields';
import {find} from '../page/find';
import type {Settings} from '../settings/settings';
import type {Panel, PanelKind, PanelTools, Scene} from './panel';

/** It is made once the section is seen. */
export interface LateContent extends Panel {
  /** The section is open and on the screen, or no more. */
  see(isSeen: boolean): void;
}

interface LateKind {
  /** The class of its place in the section. */
  name: string;
  /** Whether the section makes sense for a mesh with these fields. */
  suits(fields: readonly FieldInfo[]): boolean;
  load(tools: PanelTools, place: HTMLElement): Promise<LateContent>;
}

class LatePanel implements Panel {
  private readonly place: HTMLElement;
  private readonly section: HTMLElement;
  private coming: Promise<LateContent | null> | null = null;
  private content: LateContent | null = null;
  private isSeen = false;
  /** The words of the last update. */
  private last: [Settings, Scene | null] | null = null;

  constructor(
    private readonly tools: PanelTools,
    private readonly kind: LateKind,
  ) {
    this.place = find(tools.page.root, `.${kind.name}`);
    this.section = this.place.closest('details')!;
    // The content of a folded section or sheet takes no room.
    const watch = new ResizeObserver(() => void this.see(this.place.offsetParent !== null));
    watch.observe(this.place);
    tools.signal.addEventListener('abort', () => watch.disconnect());
  }

  update(settings: Settings, scene: Scene | null): void {
    this.last = [settings, scene];
    this.section.hidden = !this.kind.suits(scene?.manifest.fields ?? []);
    this.content?.update?.(settings, scene);
  }

  showPicture(...words: Parameters<NonNullable<Panel['showPicture']>>): void {
    this.content?.showPicture?.(...words);
  }

  follow(): void {
    this.content?.follow?.();
  }

  clear(): void {
    this.content?.clear?.();
  }

  private async see(isSeen: boolean): Promise<void> {
    if (isSeen === this.isSeen) return;
    this.isSeen = isSeen;
    if (isSeen && !this.content) {
      this.coming ??= this.kind.load(this.tools, this.place).catch(() => null);
      const content = await this.coming;
      if (!content) return void (this.coming = null); // the next time tries again
      this.content = content;
      if (this.last) content.update?.(...this.last);
    }
    this.content?.see(this.isSeen);
  }
}

export const latePanel = (kind: LateKind): PanelKind => ({
  markup: `<div class="sub ${kind.name}"></div>`,
  make: (tools) => new LatePanel(tools, kind),
});
