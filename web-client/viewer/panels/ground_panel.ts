// The menu of the ground behind the mesh: the page's, one with a name, or a colour of its own.
// style.css shows those with a name, so that the first picture has them.

import {parseHex} from '../../core/picture/color_map_text';
import {find} from '../page/find';
import {kMiddle} from '../page/ground';
import type {Page} from '../page/page';
import {kGrounds} from '../settings/ground';
import type {Settings} from '../settings/settings';
import type {Panel, PanelKind} from './panel';

const kTitles = [
  ['', 'As the page'],
  ...kGrounds.map((name) => [name, name[0]!.toUpperCase() + name.slice(1)]),
  ['own', 'Own'],
];
/** For texts, and for softer ones (style.css has the same). */
const kInks = {light: ['#16202c', '#556273'], dark: ['#e9eef5', '#9aa8ba']} as const;
const kFirstOwn = '808080';

const kMarkup = `
<div class="row">
  <label class="row"><span class="name">Ground</span><select name="ground">${kTitles
    .map(([value, title]) => `<option value="${value}">${title}</option>`)
    .join('')}</select></label>
  <input type="color" name="ground-color" aria-label="Colour of the ground" hidden>
</div>`;

class GroundPanel implements Panel {
  private readonly select: HTMLSelectElement;
  private readonly color: HTMLInputElement;

  constructor(private readonly page: Page) {
    this.select = find(page.root, 'select[name=ground]');
    this.color = find(page.root, 'input[name=ground-color]');
    this.select.addEventListener('change', () => {
      const {value} = this.select;
      page.write('ground', value === 'own' ? kFirstOwn : value || null);
    });
    this.color.addEventListener('input', () => page.write('ground', this.color.value.slice(1)));
  }

  update({ground}: Settings): void {
    const isOwn = ground !== null && parseHex(ground) !== null;
    this.select.value = isOwn ? 'own' : (ground ?? '');
    this.color.hidden = !isOwn;
    if (isOwn) this.color.value = `#${ground}`;
    showColor(this.page.element, isOwn ? ground : null);
  }
}

/** Null: no colour of its own. Its inks are those that are read on it. */
export function showColor({style}: HTMLElement, color: string | null): void {
  const its = color === null ? '' : `#${color}`;
  const scheme = color !== null && isDark(color) ? 'dark' : 'light';
  const [ink, soft] = color === null ? ['', ''] : kInks[scheme];
  // an empty value removes the property
  style.setProperty('--own-back', its);
  style.setProperty('--own-ground', its);
  style.setProperty('--scene-ink', ink);
  style.setProperty('--scene-ink-soft', soft);
}

function isDark(color: string): boolean {
  return parseHex(color)!.reduce((sum, channel) => sum + channel) < 3 * kMiddle;
}

export const groundPanel: PanelKind = {
  markup: kMarkup,
  make: ({page}) => new GroundPanel(page),
};
