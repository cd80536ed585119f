// State, bar and figures: bytes, cells, the known error that is left, and how long it will take. The bar counts bytes: the share of what the whole
// mesh with the shown fields needs. Below it, how far to refine, and error against bytes so far.

import {errorOfLevel, type Limit} from '../core/limit';
import type {Manifest} from '../core/manifest';
import type {Statistics} from '../core/statistics';
import type {StreamState} from '../core/worker_messages';
import {formatBytes, formatCount, formatDuration, formatError, percentOf} from './format';

const kStateTexts: Record<StreamState, string> = {
  connecting: 'Connecting', streaming: 'Streaming', complete: 'Complete', reconnecting: 'Reconnecting', paused: 'Paused', held: 'At this level',
  failed: 'Stopped',
};
/** Screen readers hear of every so many per cent. */
const kAnnouncedPercent = 25;
/** The rate is that of the last so many milliseconds: short enough to follow the line, long enough to be calm. */
const kRateWindowMs = 4000;

export class ProgressPanel {
  private readonly root: HTMLElement;
  private readonly curveFigure: HTMLElement;
  private frame = 0;
  private statistics: Statistics | null = null;
  private manifest: Manifest | null = null;
  private fields: number[] = [];
  private limit: Limit = {kind: 'full'};
  private state: StreamState = 'connecting';
  private announced = -1;
  private arrivals: {at: number; bytes: number}[] = [];
  /** [bytes, error] by level reached. */
  private curve: [number, number][] = [];

  constructor(root: ParentNode, private readonly announce: (text: string) => void) {
    this.root = root.querySelector('.progress')!;
    this.curveFigure = root.querySelector('.curve')!;
  }

  begin(manifest: Manifest | null): void {
    this.manifest = manifest;
    this.statistics = null;
    this.curve = [];
    this.arrivals = [];
    this.announced = -1;
  }

  follow(fields: number[], limit: Limit): void {
    if (fields.join() !== this.fields.join()) this.curve = [];
    this.fields = fields;
    this.limit = limit;
  }

  /** Draws the figures with the next frame, however often they change before it. */
  show(statistics: Statistics): void {
    this.statistics = statistics;
    this.arrivals.push({at: performance.now(), bytes: statistics.bytes});
    const error = this.errorLeft();
    if (error !== null && statistics.bytes > 0) {
      const last = this.curve.at(-1);
      if (last && last[0] > statistics.bytes) this.curve = [];
      if (last?.[1] !== error) this.curve.push([statistics.bytes, error]);
    }
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
  }

  showState(state: StreamState, attempt = 0, delayMs = 0): void {
    this.state = state;
    this.root.dataset.state = state;
    const retry = state === 'reconnecting' ? `Connection lost, trying again in ${formatDuration(delayMs / 1000)}` : '';
    this.part('.state-text').textContent = kStateTexts[state];
    this.part('.state-note').textContent = retry && attempt > 0 ? retry : '';
    if (state !== 'streaming') this.announce(retry || kStateTexts[state]);
    if (this.statistics) this.draw();
  }

  /** The known error of what is on the screen; null where the log does not tell. */
  errorLeft(): number | null {
    return this.manifest && this.statistics ? errorOfLevel(this.manifest.levels[this.statistics.level], this.fields) : null;
  }

  private draw(): void {
    this.frame = 0;
    if (!this.statistics) return;
    const {bytes, bytesNeeded, tetrahedra, total} = this.statistics;
    const percent = percentOf(bytes, bytesNeeded);
    const bar = this.part('.bar');
    bar.setAttribute('aria-valuenow', String(percent));
    (bar.firstElementChild as HTMLElement).style.transform = `scaleX(${bytesNeeded > 0 ? bytes / bytesNeeded : 0})`;
    this.part('.percent').textContent = `${percent}\u202f%`;
    this.part('.bytes').replaceChildren(...ofTotal(formatBytes(bytes), formatBytes(bytesNeeded)));
    this.part('.cells').replaceChildren(...ofTotal(formatCount(tetrahedra), formatCount(total.tetrahedra)));
    const error = this.errorLeft();
    this.part('.error-row').hidden = error === null;
    if (error !== null) this.part('.error-left').textContent = formatError(error);
    const seconds = this.secondsLeft();
    this.part('.eta-row').hidden = seconds === null;
    if (seconds !== null) this.part('.eta').textContent = formatDuration(seconds);
    this.drawCurve();
    const step = Math.floor(percent / kAnnouncedPercent);
    if (step > this.announced && this.state === 'streaming') this.announce(`${percent} per cent`);
    this.announced = Math.max(this.announced, step);
  }

  private secondsLeft(): number | null {
    const {bytes, bytesNeeded} = this.statistics!;
    const now = performance.now();
    this.arrivals = this.arrivals.filter(({at}, i, all) => now - at < kRateWindowMs || i === all.length - 1);
    const first = this.arrivals[0]!;
    const rate = (bytes - first.bytes) / Math.max(now - first.at, 1) * 1000;
    const goal = this.limit.kind === 'bytes' ? Math.min(this.limit.value, bytesNeeded) : bytesNeeded;
    // Where an error or a number of cells ends it, nobody knows at which byte.
    if (this.state !== 'streaming' || rate <= 0 || bytes >= goal || this.limit.kind === 'cells' || this.limit.kind === 'error') return null;
    return (goal - bytes) / rate;
  }

  /** Logarithmic both ways: from the first level's error to a thousandth of it. */
  private drawCurve(): void {
    const figure = this.curveFigure;
    const points = this.curve.filter(([, error]) => error > 0);
    figure.hidden = points.length < 2;
    if (figure.hidden) return;
    const {bytesNeeded} = this.statistics!;
    const [firstBytes, firstError] = points[0]!;
    const kDecades = 3;
    const x = (bytes: number): number => 100 * Math.log(bytes / firstBytes) / Math.log(Math.max(bytesNeeded / firstBytes, 1.01));
    const y = (error: number): number => 40 * Math.min(1, Math.log10(firstError / error) / kDecades);
    const path = points.map(([bytes, error], i) => `${i === 0 ? 'M' : 'L'}${x(bytes).toFixed(2)} ${Math.max(0, y(error)).toFixed(2)}`).join('');
    figure.querySelector('path')!.setAttribute('d', path);
    const [bytes, error] = points.at(-1)!;
    figure.querySelector('figcaption')!.textContent = `Error against bytes: ${formatError(firstError)} at ${formatBytes(firstBytes)}, ${formatError(error)} at ${formatBytes(bytes)}`;
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
