// Files of this machine: opened, and saved.

import {errorText} from '../../core/protocol/errors';
import {fetchWith} from '../../core/transport/token';
import {find, onClick} from '../page/find';
import type {Page} from '../page/page';
import {save} from '../page/save';
import type {PanelKind, PanelsHost} from '../panels/panel';

const kMarkup = `
<input type="file" class="visually-hidden" name="file" multiple tabindex="-1"
  aria-label="A log, or a mesh with the files that it names">
<div class="buttons">
  <button type="button" class="open-file">Open</button>
  <button type="button" class="save-log">Save log</button>
  <button type="button" class="save-page">Save page</button>
</div>
<p class="hint">Open a log or a mesh of this machine, or drop it on the page. It stays
  here.</p>`;

class FilePanel {
  constructor(
    private readonly page: Page,
    private readonly host: PanelsHost,
    take: (files: File[]) => void,
  ) {
    const {root} = page;
    const input = find<HTMLInputElement>(root, 'input[name=file]');
    onClick(root, '.open-file', () => input.click());
    input.addEventListener('change', () => {
      const files = [...(input.files ?? [])];
      input.value = ''; // the same file again is a change, too
      if (files.length > 0) take(files);
    });
    onClick(root, '.save-log', () => void this.save((log, name) => [log, `${name}.qtet`]));
    onClick(root, '.save-page', () => void this.save(this.asPage.bind(this)));
    // A page on a disk is such a page.
    find(root, '.save-page').hidden = location.protocol === 'file:';
  }

  /** Saves what `made` makes of the log and the mesh's name. */
  private async save(
    made: (log: Blob, name: string) => [Blob, string] | Promise<[Blob, string]>,
  ): Promise<void> {
    try {
      const fetched = fetchWith(this.page.token) ?? fetch;
      const response = await fetched(this.host.stream.logAddress.replace(/#.*/, ''), {});
      if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
      const name = find(this.page.root, '.mesh-name').textContent.trim().replaceAll('/', '_');
      save(...(await made(await response.blob(), name || 'mesh')));
    } catch (thrown) {
      this.host.failed('no-file', `The file cannot be made: ${errorText(thrown)}`);
    }
  }

  private async asPage(log: Blob, name: string): Promise<[Blob, string]> {
    const {singlePage} = await import('./single_page');
    const view = new URLSearchParams([...this.page.view]);
    for (const ofServer of ['src', 'mesh', 'transport']) view.delete(ofServer);
    return [await singlePage(log, name, view.toString()), `${name}.html`];
  }
}

export const filePanel: PanelKind = {
  markup: kMarkup,
  make: ({page, host, take}) => {
    new FilePanel(page, host, take);
    return {};
  },
};
