// The ground behind the mesh: the page's, light, dark, white, or a colour of its own. Its inks are
// those that are read on it. The cards stay as the page has them.

import {find} from '../page/find';
import {kMiddle} from '../page/ground';
import type {Page} from '../page/page';
import {isHexColor, type Settings} from '../settings/settings';
import type {Panel, PanelKind} from './panel';

const kTitles = {'': 'As the page', light: 'Light', dark: 'Dark', white: 'White', own: 'Own'};
const kFirstOwn = '#808080';

/** [over the canvas, one colour for pictures]; style.css has the gradients. */
const kBacks: Record<string, [string, string]> = {
  light: ['var(--light-back)', '#fff'],
  dark: ['var(--dark-back)', '#1a2029'],
  white: ['#fff', '#fff'],
};
const kInks = {light: ['#16202c', '#556273'], dark: ['#e9eef5', '#9aa8ba']} as const;

const kMarkup = `
<div class="row">
  <label class="row"><span class="name">Ground</span><select name="ground">${Object.entries(kTitles)
    .map(([value, title]) => `<option value="${value}">${title}</option>`)
    .join('')}</select></label>
  <input type="color" name="ground-color" aria-label="Colour of the ground" hidden>
</div>`;

class GroundPanel implements Panel {
  private readonly select: HTMLSelectElement;
  private readonly color: HTMLInputElement;
  private shown: string | null = null;

  constructor(private readonly page: Page) {
    this.select = find(page.root, 'select[name=ground]');
    this.color = find(page.root, 'input[name=ground-color]');
    this.select.addEventListener('change', () => {
      const {value} = this.select;
      const text = value === 'own' ? kFirstOwn.slice(1) : value;
      page.write('ground', text === '' ? null : text);
    });
    this.color.addEventListener('input', () => page.write('ground', this.color.value.slice(1)));
  }

  update({ground}: Settings): void {
    if (ground === this.shown) return;
    this.shown = ground;
    const isOwn = ground !== null && isHexColor(ground);
    this.select.value = isOwn ? 'own' : (ground ?? '');
    this.color.hidden = !isOwn;
    if (isOwn) this.color.value = `#${ground}`;
    const [back, plain] = isOwn ? [`#${ground}`, `#${ground}`] : (kBacks[ground ?? ''] ?? []);
    const [ink, soft] = ground === null ? [] : kInks[isDark(ground) ? 'dark' : 'light'];
    const words = {back, ground: plain, 'scene-ink': ink, 'scene-ink-soft': soft};
    const {style} = this.page.element;
    for (const [name, value] of Object.entries(words))
      if (value === undefined) style.removeProperty(`--${name}`);
      else style.setProperty(`--${name}`, value);
  }
}

function isDark(ground: string): boolean {
  if (!isHexColor(ground)) return ground === 'dark';
  const channels = [0, 2, 4].map((at) => parseInt(ground.slice(at, at + 2), 16));
  return channels.reduce((sum, channel) => sum + channel) / 3 < kMiddle;
}

export const groundPanel: PanelKind = {
  markup: kMarkup,
  make: ({page}) => new GroundPanel(page),
};
