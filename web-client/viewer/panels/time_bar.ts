// The time of a series: play, step, loop, and which instants are here.

import type {FieldInfo} from '../../core/protocol/fields';
import {instantsOf, isSameTime, nearestTo, shownInstant} from '../../core/protocol/series';
import type {StreamState} from '../../core/session/worker_messages';
import {untilBeat} from '../page/beat';
import {find, onClick, setText} from '../page/find';
import type {Attributes} from '../page/page';
import type {ShownMesh} from '../page/shown_mesh';
import {setMarkup} from '../page/trusted';
import {shownScalar, type Settings} from '../settings/settings';
import {warpField} from '../settings/warp';

/** Between two instants at speed 1. */
const kStepMs = 100;
/** The clock is read so often, and with each picture. */
const kTickMs = 25;
/**
 * An instant that is not here after this time is passed over for one that is, or for the next
 * segment.
 */
const kPatienceMs = 1000;
/** Instants that are fetched ahead of the one that is shown; the list changes at every half. */
const kAhead = 32;
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

export interface TimeHost {
  readonly mesh: ShownMesh;
  /** The state of another segment that is opened, before it has a picture; null: none is. */
  readonly opening: StreamState | null;
  /** The graphics are too slow for what plays. */
  readonly isHurried: boolean;
  /** Brings the picture in line with the bar. */
  apply(): void;
  /** The bar shows another instant, or begins or ends to play. */
  timeChanged(time: number, playing: boolean): void;
}

export class TimeBar {
  private readonly bar: HTMLElement;
  private times: readonly {time: number; text: string}[] = [];
  /** The keys of the series that colour and move the mesh, as text; null: another mesh's. */
  private series: string | null = null;
  /** For each of them, by time: its field, -1 for none. */
  private tracks: number[][] = [];
  private at = 0;
  /** The instant that is shown where no time is asked for. */
  private first = 0;
  /** The instant whose time the bar shows: while it plays, that of the picture. */
  private seen = 0;
  private timer: ReturnType<typeof setInterval> | undefined;
  private waitingSince = 0;
  /** When the next instant is due. */
  private dueAt = 0;
  /** The bar shows the time at the next beat. */
  private beat: ReturnType<typeof setTimeout> | undefined;
  /** The instants that are here, as shown; null: none are shown yet. */
  private here: string | null = null;
  /** The shown instant was not here when it was asked for. */
  private isLate = false;
  /** The list of segments, or else the manifest, that `times` are of. */
  private known: unknown = null;
  /** The manifest that `tracks` are of. */
  private tracked: unknown = null;
  /** The host knows this time, and whether it plays; null: nothing was shown yet. */
  private told: {time: number; playing: boolean} | null = null;

  constructor(
    root: ParentNode,
    private readonly attributes: Attributes,
    private readonly host: TimeHost,
    signal: AbortSignal,
  ) {
    this.bar = find(root, '.time');
    setMarkup(this.bar, kMarkup);
    this.speed.value = '1';
    this.showPlaying();
    onClick(this.bar, '.play', () => this.toggle());
    this.slider.addEventListener('input', () => {
      this.seen = Number(this.slider.value); // the handle stays where it is held
      this.show(this.seen);
    });
    this.speed.addEventListener('change', () => this.isPlaying && this.play());
    signal.addEventListener('abort', () => this.end());
  }

  /** The mesh has a series. */
  get isShown(): boolean {
    return !this.bar.hidden;
  }

  get isPlaying(): boolean {
    return this.timer !== undefined;
  }
  set isPlaying(isPlaying: boolean) {
    if (isPlaying !== this.isPlaying) this.toggle();
  }

  /** Brings the bar in line with the attributes and the mesh. */
  update(settings: Settings, mesh: ShownMesh): void {
    const {manifest, firstField} = mesh;
    const known = mesh.place?.list ?? manifest;
    if (this.known !== known) {
      this.known = known;
      this.end();
      this.times = mesh.times;
    }
    if (this.tracked !== manifest) {
      this.tracked = manifest;
      this.series = null;
      this.tracks = [];
    }
    const isSeries = manifest !== null && this.times.length > 1;
    this.bar.hidden = !isSeries;
    if (!isSeries) return;
    const {fields} = manifest;
    const color = shownScalar(this.attributes.read('field'), fields, firstField);
    this.choose([color?.field ?? -1, warpField(settings.warp, fields)], fields);
    this.first = nearestTo(this.times, mesh.firstTime!.time);
    this.at = settings.time === null ? this.first : nearestTo(this.times, settings.time);
    const ahead = (track: number[]): number[] => fieldsAhead(track, this.at);
    mesh.playing = this.isPlaying ? this.tracks.flatMap(ahead) : [];
    this.slider.max = String(this.times.length - 1);
    this.follow();
    this.tell();
  }

  /** Over slow graphics the time changes at the beat. */
  private followTime(): void {
    if (!this.isPlaying || this.isOnScreen || this.isLate) this.seen = this.at;
    if (!this.isPlaying || !this.host.isHurried) this.showTime();
    else this.beat ??= setTimeout(() => this.showTime(), untilBeat());
  }

  private showTime(): void {
    clearTimeout(this.beat);
    this.beat = undefined;
    const {slider} = this;
    const {text} = this.times[this.seen]!;
    slider.value = String(this.seen);
    slider.setAttribute('aria-valuetext', text);
    const unit = this.host.mesh.manifest?.units?.get('');
    setText(find(this.bar, 'output'), `t = ${text}${unit === undefined ? '' : `\u00a0${unit}`}`);
  }

  /** The host may change the time at once. */
  private tell(): void {
    if (this.host.mesh.filmed) return; // a movie leaves the time as it is
    const {isPlaying: playing, told} = this;
    const {time} = this.times[this.at]!;
    if (told?.time === time && told.playing === playing) return;
    this.told = {time, playing};
    if (told) this.host.timeChanged(time, playing);
  }

  /** A mesh may have thousands of instants: they are looked up once. */
  private choose(shown: readonly number[], fields: readonly FieldInfo[]): void {
    const keys = shown.map((field) => fields[field]?.instant?.series);
    const series = [...new Set(keys.filter((key) => key !== undefined))];
    const text = JSON.stringify(series);
    if (text === this.series) return;
    this.series = text;
    this.tracks = series.map((key) => {
      const instants = instantsOf(fields, key);
      const byTime = new Map(instants.map((field) => [fields[field]!.instant!.time, field]));
      const near = (time: number): number | undefined =>
        instants.find((field) => isSameTime(fields[field]!.instant!.time, time));
      return this.times.map(({time}) => byTime.get(time) ?? near(time) ?? -1);
    });
  }

  /** Must be called when more is here, or on the screen. */
  follow(): void {
    if (this.bar.hidden) return;
    this.followTime();
    this.showHere();
    this.bar.classList.toggle('waits', !this.isOnScreen && !this.isHere(this.at));
    if (this.isPlaying) this.tick();
  }

  /** Draws the runs of instants that are here. */
  private showHere(): void {
    const last = this.times.length - 1;
    const place = (at: number): string =>
      `${(100 * Math.min(Math.max(at - 0.5, 0), last)) / last}%`;
    const isHere = [...this.times.map((_, i) => this.isHere(i)), false];
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

  toggle(): void {
    if (this.isPlaying) this.stop();
    else this.play();
  }

  /** To the next instant or the one before, round the ends. */
  step(by: number): void {
    this.end();
    this.show(this.at + by);
  }

  private play(): void {
    clearInterval(this.timer);
    this.waitingSince = 0;
    this.dueAt = performance.now() + this.stepMs;
    this.timer = setInterval(() => this.tick(), kTickMs);
    this.host.apply();
    this.showPlaying();
  }

  private stop(): void {
    this.end();
    this.host.apply();
  }

  private end(): void {
    clearInterval(this.timer);
    clearTimeout(this.beat);
    this.timer = this.beat = undefined;
    this.showPlaying();
  }

  /**
   * The next instant, once this one is in the picture. Instants whose time passes while a picture
   * is drawn are left out. The clock stands while an instant is not here, and until a segment is on
   * the screen.
   */
  private tick(): void {
    const now = performance.now();
    if (this.awaitsFrame) return void (this.waitingSince = 0);
    if (this.isOnScreen) {
      this.waitingSince = 0;
      if (this.isLate) this.dueAt = Math.max(this.dueAt, now);
      this.isLate = false;
      if (now < this.dueAt) return;
      const due = 1 + Math.floor((now - this.dueAt) / this.stepMs);
      const by = this.stepsTo(due);
      this.dueAt = by === due ? this.dueAt + by * this.stepMs : now + this.stepMs;
      return this.show(this.at + by);
    }
    if (this.waitingSince === 0) this.waitingSince = now;
    if (now - this.waitingSince < kPatienceMs) return;
    // A segment that is slow would only begin again.
    if (this.host.opening !== null && this.host.opening !== 'failed') return;
    for (let by = 1; by < this.times.length; ++by) {
      if (!this.isHere(this.at + by) && !this.isElsewhere(this.at + by)) continue;
      this.waitingSince = 0;
      return this.show(this.at + by);
    }
  }

  /** The instant is of another segment than that of `at`. */
  private isElsewhere(at: number): boolean {
    const {instants} = this.host.mesh.place?.list ?? {};
    const segmentOf = (i: number): number | undefined => instants?.[i % this.times.length]?.segment;
    return segmentOf(at) !== segmentOf(this.at);
  }

  /**
   * The most steps up to `due` to an instant that is here; 1 if none is. The first instant of
   * another segment ends them, or slow graphics would play round in one segment.
   */
  private stepsTo(due: number): number {
    let by = Math.min(due, this.times.length - 1);
    for (let i = 1; i < by; ++i) if (this.isElsewhere(this.at + i)) return i;
    while (by > 1 && !this.isHere(this.at + by)) --by;
    return Math.max(1, by);
  }

  /** False without a series. */
  private isHere(at: number): boolean {
    if (this.host.opening !== null) return false;
    const {here} = this.host.mesh;
    const fields = this.tracks.map((track) => track[at % this.times.length]!);
    return fields.length > 0 && fields.every((field) => here.includes(field));
  }

  /** Between two instants that play. */
  get stepMs(): number {
    return kStepMs / Number(this.speed.value);
  }

  private get awaitsFrame(): boolean {
    return this.host.opening === null && this.host.mesh.awaitsFrame;
  }

  private get isOnScreen(): boolean {
    if (this.host.opening !== null || this.awaitsFrame) return false;
    const {manifest, snapshot} = this.host.mesh;
    const seen = [snapshot?.color?.field, snapshot?.warp?.field];
    return this.tracks.every((track) => {
      const field = track[this.at] ?? -1;
      return !manifest || field < 0 || seen.includes(shownInstant(manifest.fields, field));
    });
  }

  private show(at: number): void {
    const count = this.times.length;
    if (count === 0) return;
    this.at = (at + count) % count;
    this.isLate = !this.isHere(this.at);
    this.attributes.write('time', this.at === this.first ? null : this.times[this.at]!.text);
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
  private get speed(): HTMLSelectElement {
    return find<HTMLSelectElement>(this.bar, 'select');
  }
}

/** By time the fields of a series (-1: none): those to fetch while the one at `at` is shown. */
export function fieldsAhead(fields: readonly number[], at: number): number[] {
  const half = kAhead / 2;
  const from = at - (at % half);
  const round = [...fields.slice(from), ...fields.slice(0, from)];
  return round.slice(0, kAhead).filter((field) => field >= 0);
}
