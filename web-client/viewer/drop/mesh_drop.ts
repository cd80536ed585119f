// A mesh file that was dropped: simplified here, with its progress, then shown. Loaded with the
// first such file.

import {simplifyFiles, mainFile} from '../../core/simplify/simplify_files';
import type {SimplifyProgress} from '../../core/simplify/simplify_file';
import {errorCode, errorText} from '../../core/protocol/errors';
import {find, onClick} from '../page/find';
import type {Page} from '../page/page';
import {adopt, insertMarkup} from '../page/trusted';
import styles from './mesh_drop.css?inline';
import {hindrance, leftOut} from './together';

export interface MeshDropHost {
  readonly stream: {openFile(file: File, notice?: string): void};
  readonly notices: {end(code: string): void};
  failed(code: string, message: string): void;
}

const kDialog = `
<dialog class="drop-dialog" aria-label="Simplifying a mesh">
  <h2></h2>
  <p class="stage" role="status"></p>
  <progress max="1"></progress>
  <p class="hint">This happens in your browser: the mesh stays on this machine.</p>
  <div class="buttons"><button type="button" class="cancel">Cancel</button></div>
</dialog>`;

export class MeshDrop {
  private readonly dialog: HTMLDialogElement;
  private cancel = new AbortController();

  /** `ended`: the viewer is gone, and nobody waits for the mesh. */
  constructor(
    page: Page,
    private readonly host: MeshDropHost,
    private readonly ended: AbortSignal,
  ) {
    adopt(page.root, styles, 'behind');
    insertMarkup(find(page.root, '.notice'), kDialog);
    this.dialog = find(page.root, '.drop-dialog');
    onClick(this.dialog, '.cancel', () => this.cancel.abort());
    this.dialog.addEventListener('cancel', () => this.cancel.abort());
    ended.addEventListener('abort', () => this.cancel.abort());
  }

  /** Shows the mesh. A mesh that is still being simplified is given up. */
  async take(files: readonly File[]): Promise<void> {
    if (this.ended.aborted) return;
    this.cancel.abort();
    this.cancel = new AbortController();
    const {signal} = this.cancel;
    const {dialog, host} = this;
    const main = mainFile(files);
    const {name} = main;
    // the simplifier reports a file that cannot be read
    const why = await hindrance(main, files).catch(() => '');
    if (signal.aborted) return;
    if (why !== '') return host.failed('dropped-mesh', why);
    find(dialog, 'h2').textContent = name;
    this.show({stage: 'loading the simplifier', fraction: 0});
    if (!dialog.open) dialog.showModal();
    host.notices.end('dropped-mesh');
    try {
      const made = await simplifyFiles(files, (progress) => this.show(progress), signal);
      const log = new File([made.log as BlobPart], name.replace(/\.\w+(\.gz)?$/, ''));
      const said = [leftOut(main, files), ...made.warnings].filter((text) => text !== '');
      host.stream.openFile(log, said.join('\n'));
    } catch (thrown) {
      if (errorCode(thrown) !== 'cancelled') host.failed('dropped-mesh', errorText(thrown));
    } finally {
      if (signal === this.cancel.signal) dialog.close();
    }
  }

  private show({stage, fraction}: SimplifyProgress): void {
    const text = `${stage[0]!.toUpperCase()}${stage.slice(1)} …`;
    const status = find(this.dialog, '.stage');
    if (status.textContent !== text) status.textContent = text;
    find<HTMLProgressElement>(this.dialog, 'progress').value = fraction;
  }
}
