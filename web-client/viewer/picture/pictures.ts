// Pictures that are made, and those that open their view again. It is loaded at the first of them.

import type {View} from '../../webgl/view';
import type {Page} from '../page/page';
import {openView, type OpenHost} from './open_view';
import {PictureDialog} from './picture_dialog';

export class Pictures {
  private readonly dialog: PictureDialog;

  constructor(
    private readonly page: Page,
    private readonly host: OpenHost & {readonly view: View | null},
  ) {
    this.dialog = new PictureDialog(page, {
      get view() {
        return host.view;
      },
      openView: (file) => void this.open(file),
    });
  }

  picture(): void {
    this.dialog.show();
  }

  open(file: Blob): Promise<void> {
    return openView(file, this.page, this.host);
  }
}
