// The switch of the box with numbers round the mesh, and the box itself behind the canvas. The code
// that draws it is loaded when it is switched on.

import {find} from '../page/find';
import type {Page} from '../page/page';
import type {Settings} from '../settings/settings';
import {scaleOf} from '../settings/length_unit';
import {toggle} from './markup';
import type {Panel, PanelKind, PanelsHost} from './panel';
import type * as Ruler from './ruler';
import type {Line, RulerText} from './ruler';

const kSvg = 'http://www.w3.org/2000/svg';
/** A group for each part of a ruler, in the order of drawing. */
const kParts = ['grid', 'box', 'ticks'] as const;

class AxesPanel implements Panel {
  private readonly input: HTMLInputElement;
  private readonly svg = document.createElementNS(kSvg, 'svg');
  private readonly paths: Record<(typeof kParts)[number], SVGElement>;
  private readonly texts = document.createElementNS(kSvg, 'g');
  /** Null: it is not wanted, or not loaded yet. */
  private ruler: typeof Ruler | null = null;
  private settings: Settings | null = null;
  /** The last drawing and the size of its canvas, as texts. */
  private drawn = '';
  private size = '';

  constructor(
    page: Page,
    private readonly host: PanelsHost,
  ) {
    const {root} = page;
    this.input = find(root, 'input[name=axes]');
    this.input.addEventListener('change', () =>
      page.write('axes', this.input.checked ? 'on' : null),
    );
    const path = (name: string): SVGElement => {
      const its = document.createElementNS(kSvg, 'path');
      its.classList.add(name);
      return its;
    };
    this.paths = {grid: path('grid'), box: path('box'), ticks: path('ticks')};
    this.svg.classList.add('ruler');
    this.svg.setAttribute('aria-hidden', 'true');
    this.svg.append(...kParts.map((part) => this.paths[part]), this.texts);
    find(root, '.scene').before(this.svg);
  }

  update(settings: Settings): void {
    this.settings = settings;
    this.input.checked = settings.axes;
    if (settings.axes && !this.ruler) void this.load();
    this.show();
  }

  /** The box follows the camera. */
  follow(): void {
    const {ruler, settings} = this;
    const {mesh, view} = this.host;
    const scale = settings && mesh.snapshot && scaleOf(settings, mesh.manifest);
    const bounds = (scale && ruler && view?.pose.reach) ?? [];
    this.svg.toggleAttribute('hidden', bounds.length === 0);
    if (!scale || !ruler || !view || bounds.length === 0) return;
    const {clientWidth: width, clientHeight: height} = view.canvas;
    const size = `${width} ${height}`;
    if (size !== this.size) this.makeRoom();
    this.size = size;
    const {toCanvas} = view.pose;
    const drawn = [...toCanvas, width, height, ...bounds, scale.unit].join();
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    const its = ruler.rulerOf(bounds, scale, {toCanvas, width, height});
    for (const part of kParts) this.paths[part].setAttribute('d', pathOf(its[part]));
    this.write([...its.numbers, ...its.names]);
  }

  clear(): void {
    this.svg.setAttribute('hidden', '');
    this.drawn = '';
  }

  private async load(): Promise<void> {
    this.ruler = await import('./ruler').catch(() => null); // the next change tries again
    this.show();
  }

  private show(): void {
    this.makeRoom();
    this.follow();
  }

  /** Beside the fitted mesh, for the numbers. */
  private makeRoom(): void {
    const {ruler, settings} = this;
    const {view} = this.host;
    const {clientWidth = 1, clientHeight = 1} = view?.canvas ?? {};
    const [across = 0, down = 0] = ruler?.kRulerRoom ?? [];
    // A hidden page has a canvas without a size.
    const room = [across / Math.max(1, clientWidth), down / Math.max(1, clientHeight)] as const;
    view?.setBoxed(settings?.axes && ruler ? room : null);
  }

  private write(texts: readonly RulerText[]): void {
    while (this.texts.childElementCount > texts.length) this.texts.lastChild!.remove();
    while (this.texts.childElementCount < texts.length)
      this.texts.append(document.createElementNS(kSvg, 'text'));
    texts.forEach(({x, y, text}, i) => {
      const its = this.texts.children[i]!;
      its.setAttribute('x', x.toFixed(1));
      its.setAttribute('y', y.toFixed(1));
      if (its.textContent !== text) its.textContent = text;
    });
  }
}

const pathOf = (lines: readonly Line[]): string =>
  lines
    .map((line) => line.map((end) => end.toFixed(1)))
    .map(([x1, y1, x2, y2]) => `M${x1} ${y1}L${x2} ${y2}`)
    .join('');

export const axesPanel: PanelKind = {
  markup: toggle('axes', 'Axes with numbers'),
  make: ({page, host}) => new AxesPanel(page, host),
};
