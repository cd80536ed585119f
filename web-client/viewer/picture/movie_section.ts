// The part of the picture's dialog that makes a movie of the shown series.

import {errorText} from '../../core/protocol/errors';
import {find, onClick, setText} from '../page/find';
import {save} from '../page/save';
import {refusalOf, type Figure} from './figure';
import type {Movies} from './movies';

const kRates = [5, 10, 25];
const kFirstRate = 10;

export const kMovieMarkup = `
<div class="movie sub" role="group" aria-label="Movie" hidden>
  <label class="field"><span class="name">Movie of the series</span><select name="rate">${kRates
    .map((rate) => `<option value="${rate}">${rate} instants a second</option>`)
    .join('')}</select></label>
  <div class="row"><label class="toggle"><input type="checkbox" name="only-loaded">
    <span>Only loaded instants</span></label><span class="count name"></span></div>
  <p class="hint of-segment" hidden>The movie has only the instants of the shown segment.</p>
  <progress aria-label="Instants that are drawn" hidden></progress>
  <p class="hint" role="status"></p>
  <div class="buttons"><button type="button" class="save-movie">Save movie</button>
    <button type="button" class="cancel-movie" hidden>Cancel</button></div>
</div>`;

export interface MovieSectionHost {
  /** The dialog's size, ground and texts. */
  figure(): Figure;
  /** The movie is saved. */
  saved(): void;
}

export class MovieSection {
  /** Ends the movie that is made; null: there is none. */
  private ends: AbortController | null = null;

  constructor(
    private readonly section: HTMLElement,
    private readonly movies: Movies,
    private readonly host: MovieSectionHost,
  ) {
    find<HTMLSelectElement>(section, 'select').value = String(kFirstRate);
    onClick(section, '.save-movie', () => void this.make());
    onClick(section, '.cancel-movie', () => this.cancel());
  }

  get isBusy(): boolean {
    return this.ends !== null;
  }

  /** Must be called when the dialog opens. */
  show(): void {
    this.section.hidden = !this.movies.isOffered;
    find(this.section, '.of-segment').hidden = !this.movies.isOfSegment;
    if (!this.isBusy) this.say('');
  }

  cancel(): void {
    this.ends?.abort();
  }

  private async make(): Promise<void> {
    if (this.isBusy) return;
    const figure = this.host.figure();
    const why = refusalOf(figure);
    if (why !== '') return this.say(why);
    const ends = new AbortController();
    this.begin(ends);
    let said = '';
    try {
      const movie = await this.movies.make({
        ...figure,
        framesPerSecond: Number(find<HTMLSelectElement>(this.section, 'select').value),
        onlyLoaded: find<HTMLInputElement>(this.section, 'input').checked,
        signal: ends.signal,
        progress: (done, count) => this.tell(done, count),
      });
      save(movie, this.movies.fileName(movie.type === 'video/webm' ? 'webm' : 'zip'));
    } catch (thrown) {
      said = ends.signal.aborted ? 'Cancelled' : `The movie cannot be made. ${errorText(thrown)}`;
    }
    this.begin(null);
    this.say(said);
    if (said === '') this.host.saved();
  }

  private begin(ends: AbortController | null): void {
    const {section} = this;
    this.ends = ends;
    find(section, '.cancel-movie').hidden = find(section, 'progress').hidden = ends === null;
    setText(find(section, '.count'), '');
    this.say(ends ? 'Making the movie' : '');
  }

  private tell(done: number, count: number): void {
    Object.assign(find(this.section, 'progress'), {max: count, value: done});
    setText(find(this.section, '.count'), `${done} of ${count}`);
  }

  private say(status: string): void {
    setText(find(this.section, '[role=status]'), status);
  }
}
