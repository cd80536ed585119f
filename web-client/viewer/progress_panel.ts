// State, bar and figures. The bar counts bytes: the share of what the whole mesh with the shown field needs.

import type {Statistics} from '../core/statistics';
import type {StreamState} from '../core/worker_messages';
import {formatBytes, formatCount, percentOf} from './format';

const kStateTexts: Record<StreamState, string> = {
  connecting: 'Connecting', streaming: 'Streaming', complete: 'Complete', reconnecting: 'Reconnecting', paused: 'Paused',
  failed: 'Stopped',
};

export class ProgressPanel {
  private readonly root: HTMLElement;
  private frame = 0;
  private statistics: Statistics | null = null;

  constructor(root: ParentNode) {
    this.root = root.querySelector('.progress')!;
  }

  /** Draws the figures with the next frame, however often they change before it. */
  show(statistics: Statistics): void {
    this.statistics = statistics;
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
  }

  showState(state: StreamState): void {
    this.root.dataset.state = state;
    this.part('.state-text').textContent = kStateTexts[state];
  }

  private draw(): void {
    this.frame = 0;
    const {bytes, bytesNeeded, tetrahedra, total} = this.statistics!;
    const percent = percentOf(bytes, bytesNeeded);
    const bar = this.part('.bar');
    bar.setAttribute('aria-valuenow', String(percent));
    (bar.firstElementChild as HTMLElement).style.transform = `scaleX(${bytesNeeded > 0 ? bytes / bytesNeeded : 0})`;
    this.part('.percent').textContent = `${percent}\u202f%`;
    this.part('.bytes').replaceChildren(...ofTotal(formatBytes(bytes), formatBytes(bytesNeeded)));
    this.part('.cells').replaceChildren(...ofTotal(formatCount(tetrahedra), formatCount(total.tetrahedra)));
  }

  private part(selector: string): HTMLElement {
    return this.root.querySelector<HTMLElement>(selector)!;
  }
}

function ofTotal(now: string, total: string): (Node | string)[] {
  if (now === total) return [now];
  const rest = document.createElement('small');
  rest.textContent = ` of ${total}`;
  return [now, rest];
}
