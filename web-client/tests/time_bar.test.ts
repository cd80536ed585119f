import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {kNoStatistics} from '../core/decode/statistics';
import type {FieldInfo} from '../core/protocol/fields';
import type {Manifest} from '../core/protocol/manifest';
import {markSeries} from '../core/protocol/series';
import {listedInstant, readSegmentList} from '../core/protocol/segment_list';
import type {Snapshot, StreamState} from '../core/session/worker_messages';
import {untilBeat} from '../viewer/page/beat';
import {settingsFor, ShownMesh} from '../viewer/page/shown_mesh';
import {TimeBar} from '../viewer/panels/time_bar';
import {fieldsAhead} from '../viewer/panels/time_line';

/** As much of an element as the bar uses. */
class Part {
  hidden = false;
  value = '';
  textContent = '';
  readonly style = {};
  readonly classList = {toggle: () => undefined};
  private readonly parts = new Map<string, Part>();
  private readonly listeners = new Map<string, () => void>();

  querySelector(selector: string): Part {
    const part = this.parts.get(selector) ?? new Part();
    this.parts.set(selector, part);
    return part;
  }
  private readonly attributes = new Map<string, string>();
  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }
  getAttribute(name: string): string | null {
    return this.attributes.get(name) ?? null;
  }
  matches(): boolean {
    return false;
  }
  addEventListener(type: string, listener: () => void): void {
    this.listeners.set(type, listener);
  }
  dispatch(type: string): void {
    this.listeners.get(type)!();
  }
}

function field(name: string): FieldInfo {
  return {name, components: 1, association: 'point', step: 1, minimum: [0], range: [0, 1]};
}

let mesh: ShownMesh;
let opening: StreamState | null;
let isHurried: boolean;
let bar: TimeBar;
let root: Part;
let attributes: Map<string, string>;
let told: [number, boolean][];
let follow: (time: number) => void;
let write: (name: string, value: string | null) => void;

beforeEach(() => {
  vi.useFakeTimers();
  mesh = new ShownMesh();
  opening = null;
  isHurried = false;
  const fields = ['T@0', 'T@1', 'S@0', 'S@1', 'p'].map(field);
  markSeries(fields);
  mesh.manifest = {fields} as Manifest;
  attributes = new Map();
  root = new Part();
  told = [];
  follow = () => undefined;
  const read = (name: string): string | null => attributes.get(name) ?? null;
  const apply = (): void => {
    const settings = settingsFor(mesh, read);
    const {list, segment} = mesh.place ?? {};
    if (list && listedInstant(list, settings.time).segment !== segment) opening ??= 'connecting';
    bar.update(settings, mesh);
  };
  write = (name: string, value: string | null): void => {
    if (value === null) attributes.delete(name);
    else attributes.set(name, value);
    apply();
  };
  bar = new TimeBar(
    root as unknown as ParentNode,
    {read, write},
    {
      get mesh() {
        return mesh;
      },
      get opening() {
        return opening;
      },
      get isHurried() {
        return isHurried;
      },
      apply,
      timeChanged: (...change) => {
        told.push(change);
        follow(change[0]);
      },
    },
    new AbortController().signal,
  );
  apply();
});
afterEach(() => void vi.useRealTimers());

const part = (selector: string): Part => root.querySelector('.time').querySelector(selector);
const shownTime = (): string | null => part('.track input').getAttribute('aria-valuetext');

test('onlyASeriesThatPlaysHasFieldsAhead', () => {
  bar.step(1);
  expect(mesh.ahead.request(mesh.progress.here)).toEqual([]);
  bar.toggle();
  expect([bar.isPlaying, mesh.ahead.request(mesh.progress.here)]).toEqual([true, [0, 1]]);
  bar.toggle();
  expect([bar.isPlaying, mesh.ahead.request(mesh.progress.here)]).toEqual([false, []]);
});

test('theTimeBeginsAtTheOpeningAndGoesOnFromThere', () => {
  const fields = ['T@1', 'T@0', 'T@2'].map(field);
  markSeries(fields);
  mesh = new ShownMesh();
  mesh.manifest = {fields} as Manifest;
  write('field', null);
  expect([shownTime(), mesh.firstTime?.text]).toEqual(['t = 1', '1']);
  bar.step(1);
  expect([shownTime(), attributes.get('time')]).toEqual(['t = 2', '2']);
  bar.step(1);
  expect([shownTime(), attributes.get('time')]).toEqual(['t = 0', '0']);
  bar.step(1);
  expect([shownTime(), attributes.get('time')]).toEqual(['t = 1', undefined]);
});

test('anotherSeriesHasOtherFieldsAheadAndAFieldOfNoneHasNone', () => {
  bar.toggle();
  write('field', 'S');
  expect(mesh.ahead.request(mesh.progress.here)).toEqual([2, 3]);
  write('field', 'p');
  expect(mesh.ahead.request(mesh.progress.here)).toEqual([]);
});

test('eachChangeOfTheTimeAndOfPlayingIsToldOnce', () => {
  write('range', '0,1');
  expect(told).toEqual([]);
  write('time', '0.9');
  write('time', '1');
  bar.isPlaying = true;
  bar.isPlaying = true;
  bar.step(1);
  expect(told).toEqual([
    [1, false],
    [1, true],
    [0, false],
  ]);
});

test('aListenerMaySetTheTimeThatItIsTold', () => {
  follow = (time) => write('time', String(time));
  write('time', '0.9');
  expect([attributes.get('time'), told]).toEqual(['1', [[1, false]]]);
});

test('theInstantsOfAMovieAreShownAndNotTold', () => {
  mesh.ahead.filmed = {time: 1, ahead: [1]};
  write('range', '0,1');
  expect([shownTime(), mesh.ahead.request(mesh.progress.here)]).toEqual(['t = 1', [1]]);
  mesh.ahead.filmed = null;
  write('range', '0,2');
  expect([attributes.get('time'), told]).toEqual([undefined, []]);
});

test('instantsAreLookedUpOnceForASeries', () => {
  const {fields} = mesh.manifest!;
  let reads = 0;
  const instant = fields[2]!.instant!;
  const {fields: byTime} = instant;
  Object.defineProperty(instant, 'fields', {get: () => (++reads, byTime)});
  write('field', 'S');
  const once = reads;
  expect(once).toBeGreaterThan(0);
  write('range', '0,1');
  expect(reads).toBe(once);
});

/** A picture of the asked instant comes. */
function drawn(): void {
  const shown = mesh.manifest!.fields.findIndex(({instant}) => instant?.isShown);
  mesh.snapshot = {color: {field: shown, component: -1}} as Snapshot;
  mesh.drawn = kNoStatistics;
  bar.follow();
}

/** Ten instants, those of `here` decoded, the first one in the picture. */
function showSeries(here: readonly number[]): void {
  const fields = Array.from({length: 10}, (_, i) => field(`T@${i}`));
  markSeries(fields);
  mesh.manifest = {fields} as Manifest;
  mesh.progress.here = here;
  write('range', '0,1');
  drawn();
}
const kAll = Array.from({length: 10}, (_, i) => i);

test.each([
  [false, ['t = 0', 't = 1', 't = 2', 't = 3']],
  [true, ['t = 0', 't = 0', 't = 1', 't = 1']],
])('whilePlayingTheBarHasThePicturesTimeAndOverSlowGraphicsAtTheBeat', (slow, times) => {
  isHurried = slow;
  showSeries(kAll);
  vi.advanceTimersByTime(untilBeat() - 50);
  bar.toggle();
  const shown = times.map((_, i) => {
    vi.advanceTimersByTime(125);
    if (i > 0) drawn();
    return shownTime();
  });
  expect(shown).toEqual(times);
});

test('atTheBeatBehindAnotherMeshTheBarIsStill', () => {
  isHurried = true;
  showSeries(kAll);
  bar.toggle();
  vi.advanceTimersByTime(125);
  drawn();
  mesh.manifest = {fields: [field('p')]} as Manifest;
  write('range', '0,2');
  vi.advanceTimersByTime(300);
  expect([bar.isShown, bar.isPlaying]).toEqual([false, false]);
});

test('whilePlayingTheHandleStaysWhereItIsHeld', () => {
  showSeries(kAll);
  bar.toggle();
  const slider = part('.track input');
  slider.value = '7';
  slider.dispatch('input');
  expect([slider.value, attributes.get('time')]).toEqual(['7', '7']);
});

test('aTypedTimeShowsTheNearestInstant', () => {
  showSeries(kAll);
  const typed = part('label input');
  for (const [text, time] of [
    ['6,6', '7'],
    ['-3', '0'],
    ['no number', '0'],
  ]) {
    typed.value = text!;
    typed.dispatch('change');
    expect([typed.value, shownTime()]).toEqual([time, `t = ${time}`]);
  }
});

test('aPartIsMarkedAtTheShownInstantsAndItsInstantsAreFetchedAhead', () => {
  showSeries(kAll);
  const mark = (at: number, end: string): string | undefined => {
    bar.goTo(at);
    part(end).dispatch('click');
    return attributes.get('time-range');
  };
  expect([mark(3, '.from'), mark(5, '.to')]).toEqual(['3,9', '3,5']);
  expect([part('.to').getAttribute('aria-pressed'), mark(7, '.from')]).toEqual(['true', '7,9']);
  bar.toggle();
  expect(mesh.ahead.playing).toEqual([7, 8, 9]);
  expect(mark(7, '.from')).toBeUndefined();
});

test('playingOnceEndsAtTheLastInstant', () => {
  showSeries(kAll);
  part('.loop').dispatch('click');
  expect(attributes.get('time-loop')).toBe('off');
  write('time-range', '2,3');
  bar.toggle();
  drawn();
  for (let i = 0; i < 3; ++i) {
    vi.advanceTimersByTime(125);
    drawn();
  }
  expect([bar.isPlaying, shownTime()]).toEqual([false, 't = 3']);
});

test('fieldsAheadGoRoundTheEndAndLeaveGapsOut', () => {
  const fields = Array.from({length: 40}, (_, i) => i);
  expect(fieldsAhead(fields, 15)).toEqual(fields.slice(0, 32));
  expect(fieldsAhead(fields, 16)).toEqual([...fields.slice(16), ...fields.slice(0, 8)]);
  expect(fieldsAhead([4, -1, 5], 1)).toEqual([4, 5]);
});

/** Two segments with the instants 0, 1 and 2, 3, 4. The first one is shown, with all instants. */
function showSegments(): void {
  const segments = [
    {log: 'a.qtet', times: [0, 1]},
    {log: 'b.qtet', times: [2, 3, 4]},
  ];
  const list = readSegmentList({qtet: 'series', segments}, 100);
  mesh = new ShownMesh({list, segment: 0});
  const fields = ['T@0', 'T@1'].map(field);
  markSeries(fields);
  mesh.manifest = {fields} as Manifest;
  mesh.progress.here = [0, 1];
  write('range', '0,1');
  drawn();
}

/** The second segment is opened, and has a picture that is not drawn yet. */
function openSecond(): void {
  mesh = mesh.successor({...mesh.place!, segment: 1});
  const fields = ['T@3', 'T@2', 'T@4'].map(field);
  markSeries(fields, 1);
  mesh.manifest = {fields} as Manifest;
  mesh.progress.here = [0, 1, 2];
  mesh.snapshot = {color: {field: 1, component: -1}} as Snapshot;
  opening = null;
  write('range', '0,1');
  bar.follow();
}

test('theBarHasTheInstantsOfAllSegments', () => {
  showSegments();
  const {max, value} = part('.track input') as unknown as {
    max: string;
    value: string;
  };
  expect([max, value]).toEqual(['4', '0']);
  bar.step(-1);
  expect(attributes.get('time')).toBe('4');
  bar.step(1);
  expect(attributes.get('time')).toBeUndefined();
});

test('aListsTimeMayLackTheLastDigitsOfItsLogs', () => {
  const segments = [{log: 'a.qtet', times: [0, 0.3]}];
  mesh = new ShownMesh({list: readSegmentList({qtet: 'series', segments}, 100), segment: 0});
  const fields = ['T@0', 'T@0.30000000000000004'].map(field);
  markSeries(fields);
  mesh.manifest = {fields} as Manifest;
  write('range', '0,1');
  bar.toggle();
  expect(mesh.ahead.playing).toContain(1);
});

test('playingWaitsUntilASegmentIsOnTheScreenAndGoesOnInIt', () => {
  showSegments();
  bar.toggle();
  vi.advanceTimersByTime(100);
  drawn();
  vi.advanceTimersByTime(100);
  expect(attributes.get('time')).toBe('2');
  vi.advanceTimersByTime(5000);
  expect(attributes.get('time')).toBe('2');
  openSecond();
  vi.advanceTimersByTime(5000);
  expect(attributes.get('time')).toBe('2');
  drawn();
  expect([bar.isPlaying, mesh.ahead.request(mesh.progress.here)]).toEqual([true, [1, 0, 2]]);
  expect(attributes.get('time')).toBe('3');
});

test('slowPicturesDoNotLeaveOutTheNextSegment', () => {
  showSegments();
  bar.toggle();
  vi.advanceTimersByTime(100);
  expect(attributes.get('time')).toBe('1');
  vi.advanceTimersByTime(450);
  drawn();
  expect(attributes.get('time')).toBe('2');
});

test('aLateInstantIsPassedOverForTheNextSegment', () => {
  showSegments();
  mesh.progress.here = [0];
  bar.toggle();
  vi.advanceTimersByTime(100);
  expect(attributes.get('time')).toBe('1');
  vi.advanceTimersByTime(1100);
  expect(attributes.get('time')).toBe('2');
});

test('playingPassesOverASegmentThatFails', () => {
  showSegments();
  bar.toggle();
  write('time', '2');
  opening = 'failed';
  vi.advanceTimersByTime(1100);
  expect(attributes.get('time')).toBeUndefined();
});

test('anotherSegmentOpensWithTheFieldAndTheCutOfTheOneBefore', () => {
  showSegments();
  mesh.manifest = {
    fields: [field('S@0'), ...mesh.manifest!.fields],
    opening: {field: 1, cut: 2},
  } as Manifest;
  markSeries(mesh.manifest.fields, 1);
  openSecond();
  mesh.manifest = {fields: mesh.manifest.fields, opening: {field: 0, cut: null}} as Manifest;
  expect([mesh.keptField, mesh.firstField, mesh.firstCut]).toEqual(['T', 1, 2]);
  mesh.manifest = {fields: [field('q')]} as Manifest;
  expect([mesh.firstField, mesh.firstCut]).toEqual([0, 2]);
});
