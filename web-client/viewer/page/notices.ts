// Notices over the picture: what went wrong, and what to do. The newest one is shown until it ends.

import {find, onClick} from './find';

/**
 * The part of the viewer that a notice concerns. Trying again restarts the stream or the graphics;
 * for the page there is no trying again.
 */
export type NoticeSource = 'stream' | 'graphics' | 'page';

const kOfPage = [
  'unknown-field',
  'bad-attribute',
  'no-fullscreen',
  'no-picture',
  'no-file',
  'dropped-mesh',
];
const kOfGraphics = ['no-view', 'slow-view', 'silent-view', 'drawing', 'graphics-lost'];

function sourceOf(code: string): NoticeSource {
  if (kOfPage.includes(code)) return 'page';
  return kOfGraphics.includes(code) ? 'graphics' : 'stream';
}

export class Notices {
  private notices: {code: string; message: string}[] = [];
  private readonly card: HTMLElement;

  constructor(root: ShadowRoot, retry: (source: NoticeSource) => void) {
    this.card = find(root, '.notice');
    onClick(this.card, '.dismiss', () => this.end(this.shownCode));
    onClick(this.card, '.retry', () => retry(sourceOf(this.shownCode)));
  }

  /** Replaces an earlier notice with the same code. */
  add(code: string, message: string): void {
    this.notices = [...this.notices.filter((notice) => notice.code !== code), {code, message}];
    this.show();
  }

  end(code: string): void {
    this.keep((notice) => notice.code !== code);
  }

  endOf(...sources: NoticeSource[]): void {
    this.keep((notice) => !sources.includes(sourceOf(notice.code)));
  }

  private keep(stays: (notice: {code: string}) => boolean): void {
    const {length} = this.notices;
    this.notices = this.notices.filter(stays);
    if (this.notices.length !== length) this.show();
  }

  private get shownCode(): string {
    return this.card.dataset.code ?? '';
  }

  private show(): void {
    const notice = this.notices.at(-1);
    this.card.hidden = !notice;
    if (!notice) return;
    this.card.dataset.code = notice.code;
    find(this.card, 'p').textContent = notice.message;
    find(this.card, '.retry').hidden = sourceOf(notice.code) === 'page';
  }
}
