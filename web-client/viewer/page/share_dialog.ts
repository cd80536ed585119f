// The dialog with the link and the HTML to copy.

import {embedSnippet, linkTo} from '../settings/share';
import {find, onClick} from './find';
import type {Page} from './page';

export class ShareDialog {
  private readonly dialog: HTMLDialogElement;

  constructor(private readonly page: Page) {
    this.dialog = find(page.root, '.share-dialog');
    onClick(this.dialog, '.copy-link', () => void this.copy('input[name=link]'));
    onClick(this.dialog, '.copy-snippet', () => void this.copy('textarea'));
  }

  show(): void {
    const link = linkTo(location.href, this.page.view);
    const name = find(this.page.root, '.mesh-name').textContent;
    this.box('input[name=link]').value = link;
    this.box('textarea').value = embedSnippet(link, `3D view of ${name}`);
    this.dialog.showModal();
  }

  private async copy(selector: string): Promise<void> {
    const box = this.box(selector);
    box.select();
    // Pages without https have no clipboard.
    const clipboard = navigator.clipboard as Clipboard | undefined;
    await clipboard?.writeText(box.value).then(
      () => this.page.announce('Copied'),
      () => undefined,
    );
  }

  private box(selector: string): HTMLInputElement | HTMLTextAreaElement {
    return find(this.dialog, selector);
  }
}
