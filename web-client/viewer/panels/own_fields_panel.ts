// The definitions of own fields: a line for each, and an empty one for another.

import {definitionsIn} from '../../core/derived/definitions';
import {fieldLayers} from '../../core/layers/layers';
import type {Page} from '../page/page';
import type {Panel, PanelKind, PanelsHost} from './panel';

const kMarkup = `
<div class="field own-fields"></div>
<p class="hint">+ - * / ^ &lt; &gt; == c ? a : b, mag, dot, min, max, abs, sqrt, exp, log, sin,
  cos, grad, div, curl, Q. U.x is a component, T@2 an instant; other names stand in \`...\`.</p>`;
const kExample = 'Cp = (Pressure - 1) / 4.5';

class OwnFieldsPanel implements Panel {
  private readonly list: HTMLElement;
  private shown: string | null = null;
  /** The name of a new definition: once it is a field, it colours. */
  private added = '';

  constructor(
    private readonly page: Page,
    private readonly host: PanelsHost,
  ) {
    this.list = page.root.querySelector('.own-fields')!;
    this.list.addEventListener('change', () => this.write());
  }

  update(): void {
    const {isDeriving, manifest} = this.host.mesh;
    const text = this.page.read('derived') ?? '';
    if (text !== this.shown) this.fill(text);
    if (this.added === '' || isDeriving) return;
    const isField = manifest?.fields.some(({name, derived}) => derived && name === this.added);
    const {added} = this;
    this.added = '';
    if (isField) this.page.write('field', added);
  }

  private fill(text: string): void {
    this.shown = text;
    const lines = [...definitionsIn(text), ''];
    const inputs = this.inputs;
    for (const extra of inputs.splice(lines.length)) extra.remove();
    while (inputs.length < lines.length) inputs.push(this.addLine());
    lines.forEach((line, i) => (inputs[i]!.value = line));
  }

  private addLine(): HTMLInputElement {
    const input = document.createElement('input');
    input.type = 'text';
    input.autocomplete = 'off';
    input.spellcheck = false;
    input.autocapitalize = 'off';
    input.placeholder = kExample;
    input.ariaLabel = 'Definition of an own field';
    this.list.append(input);
    return input;
  }

  private write(): void {
    const before = definitionsIn(this.shown ?? '');
    const lines = this.inputs.map(({value}) => value.trim().replace(/;+$/, ''));
    const all = lines.filter((line) => line !== '');
    const last = all.length > before.length ? all.at(-1)! : '';
    this.added = nameOf(last);
    const names = all.map(nameOf);
    this.giveUp(before.map(nameOf).filter((name) => !names.includes(name)));
    this.page.write('derived', all.length > 0 ? all.join('; ') : null);
  }

  /** Names that end show nothing any more: the first field colours instead. */
  private giveUp(names: readonly string[]): void {
    const all = [
      ['field', (text: string) => text] as const,
      ...fieldLayers().map((layer) => [layer.name, (text: string) => layer.fieldOf(text)] as const),
    ];
    for (const [attribute, fieldOf] of all) {
      const text = this.page.read(attribute);
      if (text !== null && names.includes(fieldOf(text))) this.page.write(attribute, null);
    }
  }

  private get inputs(): HTMLInputElement[] {
    return [...this.list.querySelectorAll('input')];
  }
}

const nameOf = (definition: string): string => definition.split('=')[0]!.trim();

export const ownFieldsPanel: PanelKind = {
  markup: kMarkup,
  make: ({page, host}) => new OwnFieldsPanel(page, host),
};
