// The time of a series: play all of it or a part, step, and which instants are here.

import {parseNumbers} from '../../core/layers/field_values';
import {nearestTo} from '../../core/protocol/series';
import {untilBeat} from '../page/beat';
import {find, onClick, setAttribute, setText} from '../page/find';
import type {Attributes} from '../page/page';
import type {ShownMesh} from '../page/shown_mesh';
import {setMarkup} from '../page/trusted';
import {shownScalar, type Settings} from '../settings/settings';
import {warpField} from '../settings/warp';
import {TimeClock} from './time_clock';
import {partOf, TimeLine, type TimeLineHost} from './time_line';

const kSpeeds = [0.5, 1, 2, 4];

const kHere = 'currentcolor';
const kNone = 'transparent';
const kPlay = 'M6.5 4.5v11l9-5.5z';
const kPause = 'M7.5 5v10M12.5 5v10';

/** Class: [title, path of the icon]. Those of kSwitches are pressed or not. */
const kButtons: Record<string, [string, string]> = {
  first: ['First instant', 'M14.5 4.5v11L7 10zM5 4.5v11'],
  play: ['Play', kPlay],
  last: ['Last instant', 'M5.5 4.5v11L13 10zM15 4.5v11'],
  from: ['Play from here', 'M12 4H8v12h4'],
  to: ['Play to here', 'M8 4h4v12H8'],
  loop: [
    'Begin again at the end',
    'M5 8.5a5.5 5.5 0 0 1 10 0M15 11.5a5.5 5.5 0 0 1-10 0M15 4.5v4h-4M5 15.5v-4h4',
  ],
};
const kSwitches = ['play', 'from', 'to', 'loop'];

const buttons = Object.entries(kButtons)
  .map(([name, [title, path]]) => {
    const pressed = kSwitches.includes(name) ? ' aria-pressed="false"' : '';
    return `
  <button type="button" class="icon ${name}" aria-label="${title}" title="${title}"${pressed}>
    <svg viewBox="0 0 20 20" aria-hidden="true"><path d="${path}"/></svg>
  </button>`;
  })
  .join('');

const kMarkup = `
<div class="track">
  <i class="part"></i><i class="here"></i>
  <input type="range" name="time" min="0" step="1" aria-label="Time">
</div>
<div class="row">${buttons}
  <label>t = <input type="text" name="instant" inputmode="decimal" autocomplete="off"
    aria-label="Go to the time"><span class="unit"></span></label>
  <select class="small" name="speed" aria-label="Speed">${kSpeeds
    .map((speed) => `<option value="${speed}">${speed}\u00d7</option>`)
    .join('')}</select>
</div>`;

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
    this.clock = new TimeClock(
      this.line,
      () => this.ask(),
      () => this.toggle(),
    );
    this.bar = find(root, '.time');
    setMarkup(this.bar, kMarkup);
    const speed = find<HTMLSelectElement>(this.bar, 'select');
    speed.value = '1';
    this.showPlaying();
    onClick(this.bar, '.play', () => this.toggle());
    onClick(this.bar, '.first', () => this.goTo(0));
    onClick(this.bar, '.last', () => this.goTo(-1));
    onClick(this.bar, '.from', () => this.mark(0));
    onClick(this.bar, '.to', () => this.mark(1));
    onClick(this.bar, '.loop', () =>
      attributes.write('time-loop', this.clock.loops ? 'off' : null),
    );
    this.typed.addEventListener('change', () => this.take(this.typed.value));
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
  update({time, timePart, timeLoops, warp}: Settings, mesh: ShownMesh): void {
    const {clock, line} = this;
    const {manifest, firstField} = mesh;
    if (line.take(mesh)) this.end();
    const isSeries = manifest !== null && line.times.length > 1;
    this.bar.hidden = !isSeries;
    if (!isSeries) return;
    const {fields} = manifest;
    const color = shownScalar(this.attributes.read('field'), fields, firstField);
    const colored = color ? (mesh.derived?.playedOf(color.field) ?? [color.field]) : [];
    line.choose([...colored, warpField(warp, fields)], fields);
    this.first = nearestTo(line.times, mesh.firstTime!.time);
    clock.at = time === null ? this.first : nearestTo(line.times, time);
    const last = line.times.length - 1;
    clock.loops = timeLoops;
    clock.part = timePart ? partOf(line.times, timePart) : [0, last];
    mesh.ahead.playing = this.isPlaying ? line.ahead(clock.at, clock.part) : [];
    this.slider.max = String(last);
    this.showPart();
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
    this.goTo(this.clock.at + by);
  }

  /** To an instant; the first one is 0, and the last one -1. */
  goTo(at: number): void {
    this.end();
    this.clock.show(at);
  }

  /** The instant that is nearest to a typed time. */
  private take(text: string): void {
    const [time, ...more] = parseNumbers(text.replace(',', '.'));
    if (time !== undefined && more.length === 0) this.goTo(nearestTo(this.line.times, time));
    this.showTyped();
  }

  /** Playing begins (end 0) or ends (end 1) at this instant, or no longer does. */
  private mark(end: 0 | 1): void {
    const {at, part} = this.clock;
    const whole = [0, this.line.times.length - 1] as const;
    const next: [number, number] = [...part];
    next[end] = part[end] === at ? whole[end] : at;
    if (next[0] >= next[1]) next[1 - end] = whole[1 - end]!;
    const isWhole = next.every((its, i) => its === whole[i]);
    const texts = next.map((its) => this.line.times[its]!.text);
    this.attributes.write('time-range', isWhole ? null : texts.join());
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
    if (this.host.mesh.ahead.filmed) return; // a movie leaves the time as it is
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
    const unit = this.host.mesh.manifest?.units?.get('') ?? '';
    slider.value = String(this.seen);
    setAttribute(slider, 'aria-valuetext', `t = ${text}${unit && `\u00a0${unit}`}`);
    setText(find(this.bar, '.unit'), unit);
    if (!this.typed.matches(':focus')) this.showTyped();
    this.showMarks();
  }

  private showTyped(): void {
    this.typed.value = this.line.times[this.seen]!.text;
  }

  /** Which ends of the part are at the shown instant. */
  private showMarks(): void {
    const {part} = this.clock;
    const isPart = part[0] > 0 || part[1] < this.line.times.length - 1;
    for (const [i, name] of ['from', 'to'].entries())
      press(find(this.bar, `.${name}`), isPart && part[i] === this.seen);
  }

  private showPart(): void {
    const {clock, line} = this;
    press(find(this.bar, '.loop'), clock.loops);
    const last = line.times.length - 1;
    const [from, to] = clock.part.map((at) => `${(100 * at) / last}%`);
    const band = `${kNone} ${from}, ${kHere} ${from}, ${kHere} ${to}, ${kNone} ${to}`;
    const isWhole = clock.part[0] === 0 && clock.part[1] === last;
    find(this.bar, '.part').style.backgroundImage = isWhole
      ? 'none'
      : `linear-gradient(to right, ${band})`;
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
    press(button, this.isPlaying);
    find(button, 'path').setAttribute('d', path);
  }

  private get slider(): HTMLInputElement {
    return find<HTMLInputElement>(this.bar, '.track input');
  }

  private get typed(): HTMLInputElement {
    return find<HTMLInputElement>(this.bar, 'label input');
  }
}

function press(button: HTMLElement, isPressed: boolean): void {
  setAttribute(button, 'aria-pressed', String(isPressed));
}
