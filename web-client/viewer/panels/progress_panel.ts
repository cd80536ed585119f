// State, bar and figures: bytes, cells, the known error that is left, and the time that is left.
// The bar shows bytes: the share of what the whole mesh with the shown fields needs. The curve
// below shows the known error against bytes, and the point that is reached.

import type {LevelBytes} from '../../core/decode/plan';
import type {Statistics} from '../../core/decode/statistics';
import {errorOfLevel, type Limit} from '../../core/protocol/limit';
import type {Manifest} from '../../core/protocol/manifest';
import type {StreamState} from '../../core/session/worker_messages';
import {find, onClick} from '../page/find';
import {formatBytes, formatCount, formatDuration, formatError, percentOf} from '../page/format';

const kStateTexts: Record<StreamState, string> = {
  connecting: 'Connecting',
  streaming: 'Streaming',
  complete: 'Complete',
  reconnecting: 'Reconnecting',
  paused: 'Paused',
  held: 'At this level',
  failed: 'Stopped',
};
/** Screen readers get a message at every multiple of so many per cent. */
const kAnnouncedPercent = 25;
/** Nobody reads figures that change faster, and each change makes the browser redraw the page. */
const kFiguresMs = 250;
/**
 * The rate covers the last so many milliseconds: short enough to follow the line, long enough to be
 * calm.
 */
const kRateWindowMs = 4000;

/** Figures of a finished mesh stay so long before they fold up. */
const kFoldMs = 1500;

/** The curve spans errors from the first one down to at most this fraction of it. */
const kMinSpan = 10;

/** Bytes, and the error that is left with them. */
type Point = [number, number];

export class ProgressPanel {
  private readonly root: HTMLElement;
  private readonly curveFigure: HTMLElement;
  private foldTimer: ReturnType<typeof setTimeout> | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private drawnAt = -kFiguresMs;
  private statistics: Statistics | null = null;
  private manifest: Manifest | null = null;
  private fields: number[] = [];
  private limit: Limit = {kind: 'full'};
  private state: StreamState = 'connecting';
  private announced = -1;
  private arrivals: {at: number; bytes: number}[] = [];
  private plan: LevelBytes[] = [];

  constructor(
    root: ParentNode,
    private readonly announce: (text: string) => void,
  ) {
    this.root = root.querySelector('.progress')!;
    this.curveFigure = root.querySelector('.curve')!;
    onClick(this.root, '.unfold', () => this.fold(!this.root.classList.contains('finished')));
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
    this.fields = fields;
    this.limit = limit;
  }

  /** Draws the figures soon, and only once for a burst of changes. */
  show(statistics: Statistics): void {
    this.statistics = statistics;
    this.arrivals.push({at: performance.now(), bytes: statistics.bytes});
    this.timer ??= setTimeout(
      () => this.draw(),
      Math.max(0, this.drawnAt + kFiguresMs - performance.now()),
    );
  }

  showState(state: StreamState, attempt = 0, delayMs = 0): void {
    this.state = state;
    this.root.dataset.state = state;
    clearTimeout(this.foldTimer);
    if (state === 'complete') this.foldTimer = setTimeout(() => this.fold(true), kFoldMs);
    else this.fold(false);
    const retry =
      state === 'reconnecting'
        ? `Connection lost, trying again in ${formatDuration(delayMs / 1000)}`
        : '';
    this.part('.state-text').textContent = kStateTexts[state];
    this.part('.state-note').textContent = retry && attempt > 0 ? retry : '';
    if (state !== 'streaming') this.announce(retry || kStateTexts[state]);
    if (this.statistics) this.draw();
  }

  /** The known error of the mesh on the screen; null if the log does not tell. */
  errorLeft(): number | null {
    return this.manifest && this.statistics
      ? errorOfLevel(this.manifest.levels, this.statistics.level, this.fields)
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
    this.drawnAt = performance.now();
    if (!this.statistics) return;
    const {bytes, bytesNeeded, tetrahedra, total} = this.statistics;
    const percent = percentOf(bytes, bytesNeeded);
    const bar = this.part('.bar');
    bar.setAttribute('aria-valuenow', String(percent));
    (bar.firstElementChild as HTMLElement).style.transform =
      `scaleX(${bytesNeeded > 0 ? bytes / bytesNeeded : 0})`;
    this.part('.percent').textContent = `${percent}\u202f%`;
    this.part('.bytes').replaceChildren(...ofTotal(formatBytes(bytes), formatBytes(bytesNeeded)));
    this.part('.cells').replaceChildren(
      ...ofTotal(formatCount(tetrahedra), formatCount(total.tetrahedra)),
    );
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
    this.arrivals = this.arrivals.filter(
      ({at}, i, all) => now - at < kRateWindowMs || i === all.length - 1,
    );
    const first = this.arrivals[0]!;
    const rate = ((bytes - first.bytes) / Math.max(now - first.at, 1)) * 1000;
    const targetBytes =
      this.limit.kind === 'bytes' ? Math.min(this.limit.value, bytesNeeded) : bytesNeeded;
    // With a limit of errors or cells, the byte at which it ends is unknown.
    if (
      this.state !== 'streaming' ||
      rate <= 0 ||
      bytes >= targetBytes ||
      this.limit.kind === 'cells' ||
      this.limit.kind === 'error'
    )
      return null;
    return (targetBytes - bytes) / rate;
  }

  /**
   * Both axes are logarithmic, from the first level's error to the last one that is not 0. Behind
   * it the line goes to the ground. The reached point has the bytes that are here. In a log of
   * regions these may be more than the level needs, because what is looked at comes first.
   */
  private drawCurve(): void {
    const figure = this.curveFigure;
    const {bytes, level: now} = this.statistics!;
    const points = this.plan.map(({bytes: needed, level}) => ({
      level,
      point: [needed, errorOfLevel(this.manifest?.levels, level, this.fields) ?? 0] as Point,
    }));
    const line = points.map(({point}) => point);
    const [firstBytes, firstError] = line[0] ?? [0, 0];
    figure.hidden = line.length < 2 || firstError === 0;
    if (figure.hidden) return;
    const [lastBytes] = line.at(-1)!;
    const minError = Math.min(...line.map(([, error]) => error || Infinity), firstError / kMinSpan);
    const place = ([at, error]: Point): string => {
      const x = Math.log(at / firstBytes) / Math.log(Math.max(lastBytes / firstBytes, 1.01));
      const y =
        error > 0 ? (0.9 * Math.log(firstError / error)) / Math.log(firstError / minError) : 1;
      return `${(100 * Math.min(1, Math.max(0, x))).toFixed(2)} ${(40 * y).toFixed(2)}`;
    };
    const reached = points
      .filter(({level, point: [at]}) => at <= bytes && level <= now)
      .map(({point}) => point);
    const here: Point = [bytes, reached.at(-1)?.[1] ?? firstError];
    if (reached.length > 0) reached.push(here);
    for (const [name, drawn] of [
      ['ahead', line],
      ['reached', reached],
    ] as const) {
      figure
        .querySelector(`.${name}`)!
        .setAttribute('d', drawn.length > 0 ? `M${drawn.map(place).join('L')}` : '');
    }
    figure.querySelector('.here')!.setAttribute('d', `M${place(here)}h0`);
    const ends = [
      line[0]!,
      ...(bytes > firstBytes && bytes < lastBytes ? [here] : []),
      line.at(-1)!,
    ];
    const texts = ends.map(([at, error]) => `${formatError(error)} at ${formatBytes(at)}`);
    figure.querySelector('figcaption')!.textContent = `Error against bytes: ${texts.join(', ')}`;
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
