// The time of a series: play, step, loop, and which instants are here.

import {nearestTo} from '../../core/protocol/series';
import {untilBeat} from '../page/beat';
import {find, onClick, setText} from '../page/find';
import type {Attributes} from '../page/page';
import type {ShownMesh} from '../page/shown_mesh';
import {setMarkup} from '../page/trusted';
import {shownScalar, type Settings} from '../settings/settings';
import {warpField} from '../settings/warp';
import {TimeClock} from './time_clock';
import {TimeLine, type TimeLineHost} from './time_line';

const kSpeeds = [0.5, 1, 2, 4];

const kHere = 'currentcolor';
const kNone = 'transparent';
const kPlay = 'M6.5 4.5v11l9-5.5z';
const kPause = 'M7.5 5v10M12.5 5v10';

const kMarkup = `
<button type="button" class="icon play" aria-pressed="false">
  <svg viewBox="0 0 20 20" aria-hidden="true"><path/></svg>
</button>
<div class="track">
  <i class="here"></i>
  <input type="range" name="time" min="0" step="1" aria-label="Time">
</div>
<output></output>
<select class="small" name="speed" aria-label="Speed">${kSpeeds
  .map((speed) => `<option value="${speed}">${speed}\u00d7</option>`)
  .join('')}</select>`;

export interface TimeHost extends TimeLineHost {
  /** The graphics are too slow for what plays. */
  readonly isHurried: boolean;
  /** Brings the picture in line with the bar. */
  apply(): void;
  /** The bar shows another instant, or begins or ends to play. */
  timeChanged(time: number, playing: boolean): void;
}

export class TimeBar {
  private readonly bar: HTMLElement;
  private readonly line: TimeLine;
  private readonly clock: TimeClock;
  /** The instant that is shown where no time is asked for. */
  private first = 0;
  /** The instant whose time the bar shows: while it plays, that of the picture. */
  private seen = 0;
  /** The bar shows the time at the next beat. */
  private beat: ReturnType<typeof setTimeout> | undefined;
  /** The instants that are here, as shown; null: none are shown yet. */
  private here: string | null = null;
  /** The host knows this time, and whether it plays; null: nothing was shown yet. */
  private told: {time: number; playing: boolean} | null = null;

  constructor(
    root: ParentNode,
    private readonly attributes: Attributes,
    private readonly host: TimeHost,
    signal: AbortSignal,
  ) {
    this.line = new TimeLine(host);
    this.clock = new TimeClock(this.line, () => this.ask());
    this.bar = find(root, '.time');
    setMarkup(this.bar, kMarkup);
    const speed = find<HTMLSelectElement>(this.bar, 'select');
    speed.value = '1';
    this.showPlaying();
    onClick(this.bar, '.play', () => this.toggle());
    this.slider.addEventListener('input', () => {
      this.seen = Number(this.slider.value); // the handle stays where it is held
      this.clock.show(this.seen);
    });
    speed.addEventListener('change', () => {
      this.clock.speed = Number(speed.value);
      if (this.isPlaying) this.play();
    });
    signal.addEventListener('abort', () => this.end());
  }

  /** The mesh has a series. */
  get isShown(): boolean {
    return !this.bar.hidden;
  }

  get isPlaying(): boolean {
    return this.clock.isPlaying;
  }
  set isPlaying(isPlaying: boolean) {
    if (isPlaying !== this.isPlaying) this.toggle();
  }

  /** Between two instants that play. */
  get stepMs(): number {
    return this.clock.stepMs;
  }

  /** Brings the bar in line with the attributes and the mesh. */
  update({time, warp}: Settings, mesh: ShownMesh): void {
    const {clock, line} = this;
    const {manifest, firstField} = mesh;
    if (line.take(mesh)) this.end();
    const isSeries = manifest !== null && line.times.length > 1;
    this.bar.hidden = !isSeries;
    if (!isSeries) return;
    const {fields} = manifest;
    const color = shownScalar(this.attributes.read('field'), fields, firstField);
    line.choose([color?.field ?? -1, warpField(warp, fields)], fields);
    this.first = nearestTo(line.times, mesh.firstTime!.time);
    clock.at = time === null ? this.first : nearestTo(line.times, time);
    mesh.playing = this.isPlaying ? line.ahead(clock.at) : [];
    this.slider.max = String(line.times.length - 1);
    this.follow();
    this.tell();
  }

  /** Must be called when more is here, or on the screen. */
  follow(): void {
    if (this.bar.hidden) return;
    const {clock, line} = this;
    const isOnScreen = line.isOnScreen(clock.at);
    if (!this.isPlaying || isOnScreen || clock.isLate) this.seen = clock.at;
    // Over slow graphics the time changes at the beat.
    if (!this.isPlaying || !this.host.isHurried) this.showTime();
    else this.beat ??= setTimeout(() => this.showTime(), untilBeat());
    this.showHere();
    this.bar.classList.toggle('waits', !isOnScreen && !line.isHere(clock.at));
    if (this.isPlaying) clock.tick();
  }

  toggle(): void {
    if (!this.isPlaying) return this.play();
    this.end();
    this.host.apply();
  }

  /** To the next instant or the one before, round the ends. */
  step(by: number): void {
    this.end();
    this.clock.show(this.clock.at + by);
  }

  private play(): void {
    this.clock.play();
    this.host.apply();
    this.showPlaying();
  }

  private end(): void {
    this.clock.stop();
    clearTimeout(this.beat);
    this.beat = undefined;
    this.showPlaying();
  }

  private ask(): void {
    const {at} = this.clock;
    this.attributes.write('time', at === this.first ? null : this.line.times[at]!.text);
  }

  /** The host may change the time at once. */
  private tell(): void {
    if (this.host.mesh.filmed) return; // a movie leaves the time as it is
    const {isPlaying: playing, told} = this;
    const {time} = this.line.times[this.clock.at]!;
    if (told?.time === time && told.playing === playing) return;
    this.told = {time, playing};
    if (told) this.host.timeChanged(time, playing);
  }

  private showTime(): void {
    clearTimeout(this.beat);
    this.beat = undefined;
    const {slider} = this;
    const {text} = this.line.times[this.seen]!;
    slider.value = String(this.seen);
    slider.setAttribute('aria-valuetext', text);
    const unit = this.host.mesh.manifest?.units?.get('');
    setText(find(this.bar, 'output'), `t = ${text}${unit === undefined ? '' : `\u00a0${unit}`}`);
  }

  /** Draws the runs of instants that are here. */
  private showHere(): void {
    const {line} = this;
    const last = line.times.length - 1;
    const place = (at: number): string =>
      `${(100 * Math.min(Math.max(at - 0.5, 0), last)) / last}%`;
    const isHere = [...line.times.map((_, i) => line.isHere(i)), false];
    const edges = isHere.flatMap((here, i) =>
      here === (isHere[i - 1] ?? false) ? [] : [place(i)],
    );
    const colors = edges.map((edge, i) => {
      const [before, behind] = i % 2 === 0 ? [kNone, kHere] : [kHere, kNone];
      return `${before} ${edge}, ${behind} ${edge}`;
    });
    const here = colors.length > 0 ? `linear-gradient(to right, ${colors.join(', ')})` : 'none';
    if (here === this.here) return;
    this.here = here;
    find(this.bar, '.here').style.backgroundImage = here;
  }

  private showPlaying(): void {
    const button = find<HTMLButtonElement>(this.bar, '.play');
    const [title, path] = this.isPlaying ? ['Stop', kPause] : ['Play', kPlay];
    button.ariaLabel = button.title = title;
    button.ariaPressed = String(this.isPlaying);
    find(button, 'path').setAttribute('d', path);
  }

  private get slider(): HTMLInputElement {
    return find<HTMLInputElement>(this.bar, 'input');
  }
}
