// State, bar and figures: bytes, cells, the known error that is left, and the time that is left.
// The bar shows bytes: the share of what the whole mesh with the shown fields needs.

import type {LevelBytes} from '../../core/decode/plan';
import type {Statistics} from '../../core/decode/statistics';
import {largestRoundingError, widthOfValues} from '../../core/protocol/fields';
import {errorOfLevel, errorsOfLevel, type Limit} from '../../core/protocol/limit';
import type {Manifest} from '../../core/protocol/manifest';
import type {StreamState} from '../../core/session/worker_messages';
import {untilBeat} from '../page/beat';
import {find, onClick, setAttribute, setText} from '../page/find';
import {
  formatBytes,
  formatCount,
  formatDuration,
  formatError,
  formatWithin,
  percentOf,
} from '../page/format';
import type {ErrorCurve} from './error_curve';
import {labelName} from './panel';

const kStateTexts: Record<StreamState, string> = {
  connecting: 'Connecting',
  streaming: 'Streaming',
  complete: 'Complete',
  reconnecting: 'Reconnecting',
  paused: 'Paused',
  held: 'At this level',
  failed: 'Stopped',
};
const kOnTheWay: readonly StreamState[] = ['connecting', 'streaming', 'complete'];
/** Screen readers get a message at every multiple of so many per cent. */
const kAnnouncedPercent = 25;
/**
 * The rate covers the last so many milliseconds: short enough to follow the line, long enough to be
 * calm.
 */
const kRateWindowMs = 4000;

/** Figures of a finished mesh stay so long before they fold up. */
const kFoldMs = 1500;

export class ProgressPanel {
  private readonly root: HTMLElement;
  private foldTimer: ReturnType<typeof setTimeout> | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private statistics: Statistics | null = null;
  private manifest: Manifest | null = null;
  private followed: {fields: number[]; limit: Limit} = {fields: [], limit: {kind: 'full'}};
  private state: StreamState = 'connecting';
  private announced = -1;
  private curve: ErrorCurve | null = null;
  private arrivals: {at: number; bytes: number}[] = [];
  private plan: LevelBytes[] = [];

  constructor(
    root: ParentNode,
    private readonly announce: (text: string) => void,
  ) {
    this.root = find(root, '.progress');
    onClick(this.root, '.unfold', () => this.fold(!this.root.classList.contains('finished')));
  }

  /** The same log's manifest with more fields. */
  takeFields(manifest: Manifest): void {
    this.manifest = manifest;
  }

  begin(manifest: Manifest | null): void {
    this.manifest = manifest;
    this.statistics = null;
    this.plan = [];
    this.arrivals = [];
    this.announced = -1;
  }

  /** Takes the plan of these fields. */
  takePlan(plan: LevelBytes[]): void {
    this.plan = plan;
  }

  follow(fields: number[], limit: Limit): void {
    this.followed = {fields, limit};
  }

  /** Draws the first figures at once, later ones at the beat. */
  show(statistics: Statistics): void {
    const delayMs = this.statistics ? untilBeat() : 0;
    this.statistics = statistics;
    this.arrivals.push({at: performance.now(), bytes: statistics.bytes});
    this.timer ??= setTimeout(() => this.draw(), delayMs);
  }

  /** `isNext`: of another segment. While it is on its way, the card stays as it is, and silent. */
  showState(state: StreamState, attempt = 0, delayMs = 0, isNext = false): void {
    this.state = state;
    this.root.dataset.state = state;
    clearTimeout(this.foldTimer);
    const isQuiet = isNext && kOnTheWay.includes(state);
    if (state === 'complete') this.foldTimer = setTimeout(() => this.fold(true), kFoldMs);
    else if (!isQuiet) this.fold(false);
    const retry =
      state === 'reconnecting'
        ? `Connection lost, trying again in ${formatDuration(delayMs / 1000)}`
        : '';
    this.part('.state-text').textContent = kStateTexts[state];
    this.part('.state-note').textContent = retry && attempt > 0 ? retry : '';
    if (state !== 'streaming' && !isQuiet) this.announce(retry || kStateTexts[state]);
    if (this.statistics) this.draw();
  }

  /** The curve follows from now on. */
  attach(curve: ErrorCurve): void {
    this.curve = curve;
    this.drawCurve();
  }

  /** The known error of the mesh on the screen; null if the log does not tell. */
  errorLeft(): number | null {
    return this.manifest && this.statistics
      ? errorOfLevel(this.manifest.levels, this.statistics.level, this.followed.fields)
      : null;
  }

  /** Folds the figures of a finished mesh up, to make room for the controls. */
  private fold(folded: boolean): void {
    this.root.classList.toggle('finished', folded);
    const button = find(this.root, '.unfold');
    button.hidden = this.state !== 'complete';
    button.setAttribute('aria-expanded', String(!folded));
  }

  private draw(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    if (!this.statistics) return;
    const {bytes, bytesNeeded, tetrahedra, total} = this.statistics;
    const percent = percentOf(bytes, bytesNeeded);
    const bar = this.part('.bar');
    bar.setAttribute('aria-valuenow', String(percent));
    (bar.firstElementChild as HTMLElement).style.transform =
      `scaleX(${bytesNeeded > 0 ? bytes / bytesNeeded : 0})`;
    setText(this.part('.percent'), `${percent}\u202f%`);
    showOfTotal(this.part('.bytes'), formatBytes(bytes), formatBytes(bytesNeeded));
    const all = this.manifest?.original?.tetrahedra ?? total.tetrahedra;
    showOfTotal(this.part('.cells'), formatCount(tetrahedra), formatCount(all));
    const error = this.errorLeft();
    const isMeasured = this.manifest?.levels[0]?.error !== undefined;
    this.part('.error-row').hidden = !isMeasured;
    if (isMeasured) this.showError(error === null ? 'not known' : formatError(error));
    const seconds = this.secondsLeft();
    this.part('.eta-row').hidden = seconds === null;
    if (seconds !== null) setText(this.part('.eta'), formatDuration(seconds));
    this.drawCurve();
    const step = Math.floor(percent / kAnnouncedPercent);
    if (step > this.announced && this.state === 'streaming') this.announce(`${percent} per cent`);
    this.announced = Math.max(this.announced, step);
  }

  private showError(error: string): void {
    const all = this.manifest!.fields;
    const {fields} = this.followed;
    const {levels} = this.manifest!;
    const level = this.statistics!.level;
    const isWhole = level === levels.length - 1 && !this.manifest!.original;
    const measured = isWhole ? undefined : errorsOfLevel(levels, level);
    const within = (field: number): string[] => {
      const info = all[field];
      // while another mesh comes, the numbers may be those of the mesh before
      if (!info || info.derived) return [];
      const now = (measured?.fields[field]?.max ?? 0) * widthOfValues(info);
      return [formatWithin(info, largestRoundingError(info), now)];
    };
    const label = labelName(fields, all);
    const left = this.part('.error-left');
    setText(left, label === null ? error : `${error} of the volume`);
    setAttribute(
      left,
      'title',
      label === null
        ? fields.flatMap(within).join('\n')
        : `${error} of the volume has another ${label}`,
    );
  }

  private drawCurve(): void {
    const {curve, followed, manifest, plan, statistics} = this;
    if (statistics && manifest) curve?.draw(plan, statistics, manifest, followed.fields);
  }

  private secondsLeft(): number | null {
    const {bytes, bytesNeeded} = this.statistics!;
    const {limit} = this.followed;
    const now = performance.now();
    this.arrivals = this.arrivals.filter(
      ({at}, i, all) => now - at < kRateWindowMs || i === all.length - 1,
    );
    const first = this.arrivals[0]!;
    const rate = ((bytes - first.bytes) / Math.max(now - first.at, 1)) * 1000;
    const targetBytes = limit.kind === 'bytes' ? Math.min(limit.value, bytesNeeded) : bytesNeeded;
    // With a limit of errors or cells, the byte at which it ends is unknown.
    if (
      this.state !== 'streaming' ||
      rate <= 0 ||
      bytes >= targetBytes ||
      limit.kind === 'cells' ||
      limit.kind === 'error'
    )
      return null;
    return (targetBytes - bytes) / rate;
  }

  private part(selector: string): HTMLElement {
    return this.root.querySelector<HTMLElement>(selector)!;
  }
}

function showOfTotal(element: HTMLElement, now: string, total: string): void {
  const text = now === total ? '' : ` of ${total}`;
  if (element.textContent === `${now}${text}`) return;
  const rest = document.createElement('small');
  rest.textContent = text;
  element.replaceChildren(now, ...(text ? [rest] : []));
}
