// The histogram of the coloured field with the colours below it. Two handles set the range.

import {scalarText} from '../../core/layers/field_values';
import {gradientStops} from '../../core/picture/color_maps';
import type {Axis, Histogram} from '../../core/picture/histogram';
import {find, onClick} from '../page/find';
import {formatValue, roundTo} from '../page/format';
import type {Page} from '../page/page';
import {adopt, setMarkup} from '../page/trusted';
import type {Settings} from '../settings/settings';
import styles from './histogram.css?inline';
import {
  axisOf,
  barsPath,
  kViewBox,
  movedRange,
  nearestEnd,
  shareOf,
  type End,
} from './histogram_axis';
import {scalarTitle, type PanelKind, type PanelsHost} from './panel';

/** Pictures may come twenty times a second while the mesh refines; counting takes a while. */
const kRestMs = 500;
const kStep = 0.01;
const kLongStep = 0.1;
const kTitle = 'Middle 98\u202f%';
const kMarkup = `
<div class="histogram-plot">
  <i class="middle"></i>
  <svg viewBox="${kViewBox}" preserveAspectRatio="none" aria-hidden="true"><path/></svg>
  <div class="strip"></div>
  <div class="end" role="slider" tabindex="0" aria-label="Value of the first colour"></div>
  <div class="end last" role="slider" tabindex="0" aria-label="Value of the last colour"></div>
</div>
<div class="row ends"><span>&nbsp;</span><span></span></div>
<div class="row"><span class="what"></span>
  <button type="button" class="to-middle" title="Sets the range to it">${kTitle}</button></div>`;

class HistogramPanel {
  private readonly root: HTMLElement;
  private readonly plot: HTMLElement;
  private readonly ends: HTMLElement[];
  private timer: ReturnType<typeof setTimeout> | undefined;
  private axis: Axis = {low: 0, high: 1, logarithmic: false};
  /** The last answer; null before there is one. */
  private counted: Histogram | null = null;
  /** The quantity that was counted, whatever its instant. */
  private quantity = '';
  private isDragged = false;

  constructor(
    private readonly page: Page,
    private readonly host: PanelsHost,
    signal: AbortSignal,
  ) {
    adopt(page.root, styles);
    this.root = find(page.root, '.histogram');
    setMarkup(this.root, kMarkup);
    this.plot = find(this.root, '.histogram-plot');
    this.ends = [...this.root.querySelectorAll<HTMLElement>('.end')];
    this.ends.forEach((end, i) => {
      end.addEventListener('keydown', (event) => this.press(event, i as End));
    });
    this.plot.addEventListener('pointerdown', (event) => this.drag(event));
    this.plot.addEventListener('dblclick', () => this.toMiddle());
    onClick(this.root, '.to-middle', () => this.toMiddle());
    for (const type of ['refine', 'load', 'view-change', 'time-change'])
      page.element.addEventListener(type, () => this.changed(), {signal});
    // A folded section or sheet counts nothing; it does when it is unfolded.
    const watch = new IntersectionObserver(() => this.changed());
    watch.observe(this.root);
    signal.addEventListener('abort', () => {
      watch.disconnect();
      clearTimeout(this.timer);
    });
    this.changed();
  }

  /** Follows the range at once, and counts a while later. Instants that pass are not counted. */
  private changed(): void {
    this.show();
    if (this.host.isPlaying && !this.isStale) return;
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      void this.count();
    }, kRestMs);
  }

  private async count(): Promise<void> {
    const {range, mesh, client} = this.host;
    const {snapshot} = mesh;
    if (!range || !snapshot?.color || this.isDragged || !this.root.offsetParent) return;
    if (this.host.opening !== null) return; // the worker has another segment
    const [low, high] = snapshot.scaleRange;
    const [from, to] = snapshot.extent.map((share) => low + share * (high - low));
    const axis = axisOf(range, [from!, to!]);
    const quantity = this.shownQuantity;
    const counted = await client.histogram(axis);
    // The answer may be late.
    if (mesh !== this.host.mesh || quantity !== this.shownQuantity) return this.changed();
    this.axis = axis;
    this.counted = counted;
    this.quantity = quantity;
    this.show();
  }

  /** The coloured quantity of the picture; empty if there is none. */
  private get shownQuantity(): string {
    const {manifest, snapshot} = this.host.mesh;
    return manifest && snapshot?.color ? scalarText(snapshot.color, manifest.fields) : '';
  }

  /** Another quantity or scale was counted: the axis says nothing about what is shown. */
  private get isStale(): boolean {
    const {axis, host, quantity} = this;
    return quantity !== this.shownQuantity || axis.logarithmic !== host.range?.logarithmic;
  }

  private show(): void {
    const {range, mesh, settings} = this.host;
    const {counted, axis} = this;
    const color = mesh.snapshot?.color;
    const isNone = mesh.manifest?.fields.length === 0 || range?.labels !== undefined;
    const isShown = range !== null && color && mesh.manifest && counted && !isNone;
    this.root.classList.toggle('empty', isNone);
    this.root.classList.toggle('awaited', !isShown); // its place is kept
    this.root.classList.toggle('stale', this.isStale);
    // It is counted soon. Until then the last picture stays, and sets nothing.
    if (!isShown || this.isStale) return;
    const hasWidth = axis.low < axis.high;
    find(this.root, 'path').setAttribute('d', barsPath(counted.counts));
    const [first, last] = [range.low, range.high].map((value) => shareOf(axis, value));
    const strip = find(this.root, '.strip');
    strip.style.background = stripOf(settings, hasWidth ? first! : 0, hasWidth ? last! : 1);
    const title = scalarTitle(color, mesh.manifest!.fields);
    this.ends.forEach((end, i) => {
      const value = i === 0 ? range.low : range.high;
      end.hidden = !hasWidth;
      end.style.left = `${100 * (i === 0 ? first! : last!)}%`;
      const said = {
        valuemin: axis.low,
        valuemax: axis.high,
        valuenow: value,
        valuetext: `${title} ${formatValue(value)}`,
      };
      for (const [name, text] of Object.entries(said)) end.setAttribute(`aria-${name}`, `${text}`);
    });
    this.showValues(counted);
  }

  /** The middle, the lowest and the highest value, and the title of the bars. */
  private showValues({extent, middle}: Histogram): void {
    const {axis, host} = this;
    const {color} = host.mesh.snapshot!;
    const band = find(this.root, '.middle');
    band.hidden = find<HTMLButtonElement>(this.root, '.to-middle').disabled =
      !middle || !(middle[0] < middle[1]);
    if (middle) {
      const [from, to] = middle.map((value) => shareOf(axis, value));
      band.style.left = `${100 * from!}%`;
      band.style.width = `${100 * (to! - from!)}%`;
    }
    const texts = endTexts(extent);
    this.root.querySelectorAll('.ends span').forEach((span, i) => {
      span.textContent = texts[i]!;
    });
    const {association} = host.mesh.manifest!.fields[color!.field]!;
    const counted = association === 'cell' ? 'cells' : 'vertices';
    find(this.root, '.what').textContent = `√ of ${counted}`;
  }

  private write([low, high]: readonly [number, number]): void {
    if (low < high && !this.isStale) this.page.write('range', `${low},${high}`);
  }

  private toMiddle(): void {
    const middle = this.counted?.middle;
    if (!middle) return;
    const fine = 1e-4 * (middle[1] - middle[0]);
    this.write([roundTo(middle[0], fine), roundTo(middle[1], fine)]);
  }

  private get ofRange(): [number, number] {
    const {low = 0, high = 1} = this.host.range ?? {};
    return [low, high];
  }

  private move(end: End, share: number): void {
    this.write(movedRange(this.axis, this.ofRange, end, share));
  }

  private drag(event: PointerEvent): void {
    const target = (event.target as Element).closest<HTMLElement>('.end');
    if (!target || event.button !== 0) return;
    event.preventDefault();
    const {left, width} = this.plot.getBoundingClientRect();
    const share = ({clientX}: PointerEvent): number => (clientX - left) / width;
    // The targets of two near handles overlap.
    const end = nearestEnd(this.axis, this.ofRange, share(event));
    const handle = this.ends[end]!;
    handle.focus();
    this.plot.setPointerCapture(event.pointerId);
    const away = shareOf(this.axis, this.ofRange[end]) - share(event);
    this.isDragged = true;
    const drag = new AbortController();
    const {signal} = drag;
    this.plot.addEventListener('pointermove', (now) => this.move(end, share(now) + away), {signal});
    for (const type of ['pointerup', 'pointercancel'] as const)
      this.plot.addEventListener(
        type,
        () => {
          drag.abort();
          this.isDragged = false;
          this.changed();
        },
        {signal},
      );
  }

  private press(event: KeyboardEvent, end: End): void {
    const now = shareOf(this.axis, this.ofRange[end]);
    const step = event.shiftKey ? kLongStep : kStep;
    const to: Record<string, number> = {
      ArrowLeft: now - step,
      ArrowDown: now - step,
      ArrowRight: now + step,
      ArrowUp: now + step,
      PageDown: now - kLongStep,
      PageUp: now + kLongStep,
      Home: 0,
      End: 1,
    };
    const share = to[event.key];
    if (share === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.move(end, share);
  }
}

export const histogramPanel: PanelKind = {
  markup: '<div class="histogram"></div>',
  make: ({page, host, signal}) => {
    new HistogramPanel(page, host, signal);
    return {};
  },
};

/** Five digits, without zeros behind a point. */
function shortText(value: number): string {
  return formatValue(value)
    .replace(/(\.\d*?)0+$/, '$1')
    .replace(/\.$/, '');
}

/** The texts below the two ends. */
function endTexts(extent: Histogram['extent']): [string, string] {
  if (!extent) return ['No values', ''];
  const [low, high] = extent;
  if (low === high) return [`All ${shortText(low)}`, ''];
  return [`Lowest ${shortText(low)}`, `Highest ${shortText(high)}`];
}

/** The colours on the axis, also beyond the range. */
function stripOf({map, reversed, beyond}: Settings, first: number, last: number): string {
  const kStops = 17;
  const stops = gradientStops(map, reversed, kStops).map(
    ([at, color]) => `${color} ${(100 * (first + at * (last - first))).toFixed(2)}%`,
  );
  const [below, above] = [first, last].map((share, i): string[] => {
    const color = beyond[i] && `rgb(${beyond[i].join(' ')})`;
    return color ? [`${color} ${100 * i}%`, `${color} ${(100 * share).toFixed(2)}%`] : [];
  });
  const all = [...below!, ...stops, ...above!.reverse()];
  return `linear-gradient(90deg, ${all.join()})`;
}
