// The dialog that makes a picture to publish: its size, its ground and what stands round the mesh.
// The picture is saved or copied. It holds the view's address.

import {errorText} from '../../core/protocol/errors';
import {find, onClick} from '../page/find';
import {fileNameOf, textOf, type Origin} from '../panels/origin';
import type {Page} from '../page/page';
import {save} from '../page/save';
import {setMarkup} from '../page/trusted';
import {linkTo, publicAddress} from '../settings/share';
import {refusalOf, type Figure, type Ground} from './figure';
import {kMovieMarkup, MovieSection} from './movie_section';
import type {Movies} from './movies';
import {drawPage, type FigureHost} from './page_figure';
import {withTexts} from './png_view';

const kSizes = [
  ['', 'As on the screen'],
  ['1920 1080', 'Full HD, 1920 × 1080'],
  ['3840 2160', '4K, 3840 × 2160'],
  ['7680 4320', '8K, 7680 × 4320'],
  ['other', 'Other'],
];
const kGrounds: [Ground, string][] = [
  ['white', 'White'],
  ['transparent', 'Transparent'],
  ['seen', 'As seen'],
];

const side = (name: string, label: string): string =>
  `<input type="text" inputmode="numeric" name="${name}" aria-label="${label} in pixels">`;
const toggle = (name: string, title: string): string =>
  `<label class="toggle"><input type="checkbox" name="${name}" checked>` +
  `<span>${title}</span></label>`;
const text = (name: string, title: string): string =>
  `<label class="field"><span class="name">${title}</span>` +
  `<input type="text" name="${name}" autocomplete="off"></label>`;

const kMarkup = `
<form method="dialog" class="row">
  <h2>Save picture</h2>
  <button class="icon" aria-label="Close"><svg viewBox="0 0 20 20" aria-hidden="true">
    <path d="M5 5l10 10M15 5 5 15"/></svg></button>
</form>
<form class="figure sub">
  <label class="field"><span class="name">Size</span><select name="size">${kSizes
    .map(([value, title]) => `<option value="${value}">${title}</option>`)
    .join('')}</select></label>
  <div class="row">${side('width', 'Width')}<span>×</span>${side('height', 'Height')}</div>
  <fieldset class="segments"><legend class="visually-hidden">Ground</legend>${kGrounds
    .map(
      ([value, title], i) =>
        `<label><input type="radio" name="ground" value="${value}"${i === 0 ? ' checked' : ''}>` +
        `<span>${title}</span></label>`,
    )
    .join('')}</fieldset>
  <div class="row wrap">${toggle('legend', 'Legend')}${toggle('axes', 'Axes')}</div>
  ${text('title', 'Title')}
  ${text('unit', 'Unit of the field')}
  <p class="hint" role="status"></p>
  <div class="buttons"><button class="save-picture" autofocus>Save</button>
    <button type="button" class="copy-picture">Copy</button></div>
</form>
${kMovieMarkup}
<div class="row">
  <p class="hint">A saved picture opens its view again: drop it on this page.</p>
  <label class="toggle"><input type="file" name="picture" accept="image/png">
    <span>Open&nbsp;a&nbsp;file</span></label>
</div>`;

export interface PictureHost {
  readonly figures: FigureHost;
  /** That of a picture of now. */
  readonly origin: Origin;
  openView(file: Blob): void;
}

export class PictureDialog {
  private readonly dialog = document.createElement('dialog');
  private readonly form: HTMLFormElement;
  /** The mesh that gave the title. */
  private mesh = '';
  /** Counts the openings: a picture that comes after its own is not wanted. */
  private openings = 0;
  private isBusy = false;
  private readonly movie: MovieSection;

  constructor(
    private readonly page: Page,
    private readonly host: PictureHost,
    movies: Movies,
  ) {
    const {dialog} = this;
    dialog.className = 'picture-dialog';
    dialog.ariaLabel = 'Save picture';
    setMarkup(dialog, kMarkup);
    page.root.append(dialog);
    this.form = find(dialog, '.figure');
    this.movie = new MovieSection(find(dialog, '.movie'), movies, {
      figure: () => this.figure(),
      saved: () => {
        dialog.close();
        page.announce('Saved');
      },
    });
    dialog.addEventListener('close', () => this.movie.cancel());
    this.form.addEventListener('submit', (event) => {
      event.preventDefault();
      void this.run((picture) => this.save(picture));
    });
    onClick(dialog, '.copy-picture', () => void this.run((picture) => this.copy(picture)));
    const size = find<HTMLSelectElement>(dialog, 'select');
    size.addEventListener('change', () => this.fillSize(size.value));
    for (const name of ['width', 'height'])
      this.box(name).addEventListener('input', () => void (size.value = 'other'));
    const file = this.box('picture');
    file.addEventListener('change', () => {
      const [picture] = file.files ?? [];
      file.value = '';
      dialog.close();
      if (picture) host.openView(picture);
    });
  }

  show(): void {
    if (this.dialog.open) return;
    ++this.openings;
    this.isBusy = false;
    this.say('');
    const size = find<HTMLSelectElement>(this.dialog, 'select').value;
    if (size === '') this.fillSize(size); // the window may have changed
    const mesh = this.meshName;
    if (mesh !== this.mesh) this.box('title').value = mesh;
    this.mesh = mesh;
    this.movie.show();
    this.dialog.showModal();
  }

  private fillSize(size: string): void {
    if (size === 'other') return;
    const {clientWidth, clientHeight} = this.page.element;
    const [width, height] =
      size === ''
        ? [clientWidth, clientHeight].map((points) => Math.round(points * devicePixelRatio))
        : size.split(' ');
    this.box('width').value = String(width);
    this.box('height').value = String(height);
  }

  /** Makes the picture for `use`, which returns what is said then. */
  private async run(use: (picture: Promise<Blob>) => Promise<string>): Promise<void> {
    if (this.isBusy || this.movie.isBusy) return; // disabled buttons would lose the focus
    const figure = this.figure();
    const why = refusalOf(figure);
    if (why !== '') return this.say(why);
    const opening = this.openings;
    this.isBusy = true;
    this.say('Drawing the picture');
    const said = await use(this.make(figure)).catch(
      (thrown: unknown) =>
        `The picture cannot be made: ${errorText(thrown)}. A smaller one may be possible.`,
    );
    if (opening !== this.openings) return;
    this.say(said);
    this.isBusy = false;
  }

  private async make(figure: Figure): Promise<Blob> {
    const {page} = this;
    const {figures, origin} = this.host;
    const address = linkTo(publicAddress(location.href), page.view);
    const canvas = await drawPage(page, figures, figure);
    return withTexts(await canvas.convertToBlob({type: 'image/png'}), address, {
      Title: figure.title || origin.mesh,
      Description: textOf(origin),
      Software: 'qtet',
    });
  }

  private async save(making: Promise<Blob>): Promise<string> {
    const opening = this.openings;
    const picture = await making;
    if (!this.dialog.open || opening !== this.openings) return '';
    save(picture, fileNameOf(this.host.origin, 'png'));
    this.dialog.close();
    this.page.announce('Saved');
    return '';
  }

  /** The clipboard takes the promise, because it wants to be called at the click. */
  private async copy(making: Promise<Blob>): Promise<string> {
    // Pages without https have no clipboard.
    const clipboard = navigator.clipboard as Clipboard | undefined;
    if (!clipboard || !('ClipboardItem' in window)) {
      await making;
      return 'The browser does not let this page copy. The picture can be saved.';
    }
    await clipboard.write([new ClipboardItem({'image/png': making})]);
    return 'Copied';
  }

  private figure(): Figure {
    const {form} = this;
    const its = (name: string): string => this.box(name).value.trim();
    return {
      width: Number(its('width')),
      height: Number(its('height')),
      ground: find<HTMLInputElement>(form, '[name=ground]:checked').value as Ground,
      hasLegend: this.box('legend').checked,
      hasAxes: this.box('axes').checked,
      title: its('title'),
      unit: its('unit'),
    };
  }

  private get meshName(): string {
    return find(this.page.root, '.mesh-name').textContent;
  }

  private box(name: string): HTMLInputElement {
    return find(this.dialog, `input[name=${name}]`);
  }

  private say(status: string): void {
    find(this.form, '[role=status]').textContent = status;
  }
}
