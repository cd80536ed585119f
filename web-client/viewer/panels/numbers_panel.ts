// Numbers about what is drawn: volumes, areas, means, fluxes. They are computed while the section
// is open, and follow the picture.

import {scalarText} from '../../core/layers/field_values';
import {kMagnitude} from '../../core/picture/field_scale';
import type {Numbers} from '../../core/session/inspector';
import {copy} from '../page/copy';
import {find, onClick} from '../page/find';
import type {Page} from '../page/page';
import {save} from '../page/save';
import {fillSelect} from '../page/select';
import {lengthUnit} from '../settings/length_unit';
import type {Settings} from '../settings/settings';
import type * as Table from './numbers_table';
import {scalarName, type Panel, type PanelKind, type PanelsHost, type Scene} from './panel';
import {RepeatedQuestion} from './repeated_question';

/** Pictures may come twenty times a second while the mesh refines; integrating takes a while. */
const kRestMs = 500;
const kMarkup = `
<dl class="sub numbers"></dl>
<label class="field flux"><span class="name">Flux of</span><select name="flux"></select></label>
<div class="buttons">
  <button type="button" class="copy-numbers">Copy</button>
  <button type="button" class="save-numbers">Save as CSV</button>
</div>`;

class NumbersPanel implements Panel {
  private readonly list: HTMLElement;
  private readonly select: HTMLSelectElement;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private table: typeof Table | null = null;
  private rows: Table.Row[] = [];
  private readonly question = new RepeatedQuestion(
    () => this.ask(),
    (numbers) => this.take(numbers),
  );

  constructor(
    private readonly page: Page,
    private readonly host: PanelsHost,
    signal: AbortSignal,
  ) {
    const {root} = page;
    this.list = find(root, '.numbers');
    this.select = find(root, 'select[name=flux]');
    this.select.addEventListener('change', () => page.write('flux', this.select.value || null));
    onClick(root, '.copy-numbers', () => void this.copy());
    onClick(root, '.save-numbers', () => this.save());
    // A folded section or sheet computes nothing; it does when it is unfolded.
    const watch = new IntersectionObserver(() => this.question.repeat());
    watch.observe(this.list);
    signal.addEventListener('abort', () => {
      watch.disconnect();
      clearTimeout(this.timer);
    });
  }

  update(_: Settings, scene: Scene | null): void {
    const fields = scene?.manifest.fields ?? [];
    const options = [...fields.keys()]
      .filter((field) => fields[field]!.components === 3)
      .filter((field) => fields[field]!.instant?.isShown !== false)
      .map((field) => ({field, component: kMagnitude}))
      .map((vector) => ({
        value: scalarText(vector, fields),
        title: scalarName(vector, fields).replace(/, magnitude$/, ''),
      }));
    find(this.page.root, '.flux').hidden = options.length === 0;
    const none = {value: '', title: 'The coloured vector'};
    fillSelect(this.select, [none, ...options], this.page.read('flux') ?? '');
    this.rest();
  }

  showPicture(): void {
    this.rest();
  }

  clear(): void {
    this.question.forget();
    this.rows = [];
    this.list.replaceChildren();
  }

  private rest(): void {
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      this.question.repeat();
    }, kRestMs);
  }

  private ask(): Promise<Numbers | null> | null {
    const {client, mesh, opening} = this.host;
    if (!mesh.snapshot || opening !== null || !this.list.offsetParent) return null;
    return Promise.all([client.numbers(), this.table ?? import('./numbers_table')]).then(
      ([numbers, table]) => {
        this.table = table;
        return mesh === this.host.mesh ? numbers : null;
      },
    );
  }

  private take(numbers: Numbers | null): void {
    const {table} = this;
    const {mesh, opening, settings} = this.host;
    const {manifest} = mesh;
    if (!numbers || !table || !manifest || opening !== null) return;
    this.rows = table.rowsOf(numbers, manifest, lengthUnit(settings, manifest));
    table.fillRows(this.list, this.rows);
  }

  private async copy(): Promise<void> {
    const {page, rows, table} = this;
    if (table) await copy(table.textOfRows(rows), (text) => page.announce(text));
  }

  /** The file's name, and its last columns, say where the numbers come from. */
  private save(): void {
    const {page, rows, table} = this;
    if (!table) return;
    const {mesh} = this.host;
    const {cutOf, fileNameOf, originOf, tableOfRows} = table;
    const origin = originOf(
      page.root,
      mesh,
      cutOf((name) => page.read(name), mesh),
    );
    const same = (['mesh', 'field', 'time'] as const).map((name) => [name, origin[name]] as const);
    const its = tableOfRows(
      rows,
      same.filter(([, text]) => text !== ''),
    );
    save(its, fileNameOf({...origin, place: `numbers ${origin.place}`}, 'csv'));
  }
}

export const numbersPanel: PanelKind = {
  markup: kMarkup,
  make: ({page, host, signal}) => new NumbersPanel(page, host, signal),
};
