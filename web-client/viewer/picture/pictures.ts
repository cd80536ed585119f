// Pictures and movies that are made, and pictures that open their view again. It is loaded at the
// first of them.

import {cutOf, originOf} from '../panels/origin';
import type {Page} from '../page/page';
import {Movies, type MovieHost, type MovieOptions} from './movies';
import {openView, type OpenHost} from './open_view';
import {PictureDialog} from './picture_dialog';

export class Pictures {
  private readonly movies: Movies;
  private readonly dialog: PictureDialog;

  constructor(
    private readonly page: Page,
    private readonly host: OpenHost & MovieHost,
  ) {
    this.movies = new Movies(page, host);
    const dialogHost = {
      figures: host,
      get origin() {
        return originOf(
          page.root,
          host.mesh,
          cutOf((name) => page.read(name), host.mesh),
        );
      },
      openView: (file: Blob) => void this.open(file),
    };
    this.dialog = new PictureDialog(page, dialogHost, this.movies);
  }

  picture(): void {
    this.dialog.show();
  }

  movie(options: MovieOptions): Promise<Blob> {
    return this.movies.make(options);
  }

  open(file: Blob): Promise<void> {
    return openView(file, this.page, this.host);
  }
}
