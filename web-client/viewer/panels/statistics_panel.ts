// The figures about the pictures: their cost, and the rate of new cells.

import type {Snapshot} from '../../core/session/worker_messages';
import {untilBeat} from '../page/beat';
import {find, setText} from '../page/find';
import {formatCount} from '../page/format';
import type {Panel, PanelKind} from './panel';

const kMarkup = `
<dl class="sub">
  <div><dt>Frame</dt><dd class="frame-ms">&ndash;</dd></div>
  <div><dt>Picture in the worker</dt><dd class="cost-ms">&ndash;</dd></div>
  <div><dt>Refining</dt><dd class="cell-rate">&ndash;</dd></div>
  <div><dt>Level</dt><dd class="level">&ndash;</dd></div>
  <div><dt>Vertices</dt><dd class="vertices">&ndash;</dd></div>
  <div><dt>Boundary triangles</dt><dd class="triangles">&ndash;</dd></div>
</dl>`;

class StatisticsPanel implements Panel {
  /** The previous picture; there was none if `at` is 0. */
  private last = {at: 0, cells: 0};

  private times = {frameMs: 0, costMs: 0};
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly root: ParentNode) {}

  clear(): void {
    this.last = {at: 0, cells: 0};
  }

  showPicture({statistics, costMs}: Snapshot, frameMs: number): void {
    const now = performance.now();
    const {at, cells} = this.last;
    if (at > 0 && statistics.tetrahedra > cells) {
      const rate = ((statistics.tetrahedra - cells) / (now - at)) * 1000;
      this.write('.cell-rate', `${formatCount(Math.round(rate))} cells/s`);
    }
    this.last = {at: now, cells: statistics.tetrahedra};
    this.times = {frameMs, costMs};
    this.timer ??= setTimeout(() => this.showTimes(), untilBeat());
    this.write('.level', `${statistics.level} of ${statistics.lastLevel}`);
    this.write('.vertices', formatCount(statistics.vertices));
    this.write('.triangles', formatCount(statistics.boundaryTriangles));
  }

  private showTimes(): void {
    this.timer = undefined;
    this.write('.frame-ms', `${this.times.frameMs.toFixed(1)} ms`);
    this.write('.cost-ms', `${this.times.costMs.toFixed(1)} ms`);
  }

  private write(selector: string, text: string): void {
    setText(find(this.root, selector), text);
  }
}

export const statisticsPanel: PanelKind = {
  markup: kMarkup,
  make: ({page}) => new StatisticsPanel(page.root),
};
