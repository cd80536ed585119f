// The menu of the ground behind the mesh: the page's, one with a name, or a colour of its own.

import {find} from '../page/find';
import type {Page} from '../page/page';
import {isHexColor, kGrounds} from '../settings/ground';
import type {Settings} from '../settings/settings';
import type {Panel, PanelKind} from './panel';

const kTitles = [
  ['', 'As the page'],
  ...kGrounds.map((name) => [name, name[0]!.toUpperCase() + name.slice(1)]),
  ['own', 'Own'],
];
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

  constructor(page: Page) {
    this.select = find(page.root, 'select[name=ground]');
    this.color = find(page.root, 'input[name=ground-color]');
    this.select.addEventListener('change', () => {
      const {value} = this.select;
      page.write('ground', value === 'own' ? kFirstOwn : value || null);
    });
    this.color.addEventListener('input', () => page.write('ground', this.color.value.slice(1)));
  }

  update({ground}: Settings): void {
    const isOwn = ground !== null && isHexColor(ground);
    this.select.value = isOwn ? 'own' : (ground ?? '');
    this.color.hidden = !isOwn;
    if (isOwn) this.color.value = `#${ground}`;
  }
}

export const groundPanel: PanelKind = {
  markup: kMarkup,
  make: ({page}) => new GroundPanel(page),
};
