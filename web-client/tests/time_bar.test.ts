import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import type {FieldInfo} from '../core/protocol/fields';
import type {Manifest} from '../core/protocol/manifest';
import {markSeries} from '../core/protocol/series';
import type {Snapshot} from '../core/session/worker_messages';
import {settingsFor, ShownMesh} from '../viewer/page/shown_mesh';
import {fieldsAhead, TimeBar} from '../viewer/panels/time_bar';

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
  setAttribute(): void {
    return;
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
let bar: TimeBar;
let root: Part;
let attributes: Map<string, string>;
let told: [number, boolean][];
let follow: (time: number) => void;
let write: (name: string, value: string | null) => void;

beforeEach(() => {
  vi.useFakeTimers();
  mesh = new ShownMesh();
  const fields = ['T@0', 'T@1', 'S@0', 'S@1', 'p'].map(field);
  markSeries(fields);
  mesh.manifest = {fields} as Manifest;
  attributes = new Map();
  root = new Part();
  told = [];
  follow = () => undefined;
  const read = (name: string): string | null => attributes.get(name) ?? null;
  const apply = (): void => bar.update(settingsFor(mesh, read), mesh);
  write = (name: string, value: string | null): void => {
    if (value === null) attributes.delete(name);
    else attributes.set(name, value);
    apply();
  };
  bar = new TimeBar(
    root as unknown as ParentNode,
    {read, write},
    {
      mesh,
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

test('onlyASeriesThatPlaysHasFieldsAhead', () => {
  bar.step(1);
  expect(mesh.ahead).toEqual([]);
  bar.toggle();
  expect([bar.isPlaying, mesh.ahead]).toEqual([true, [0, 1]]);
  bar.toggle();
  expect([bar.isPlaying, mesh.ahead]).toEqual([false, []]);
});

test('anotherSeriesHasOtherFieldsAheadAndAFieldOfNoneHasNone', () => {
  bar.toggle();
  write('field', 'S');
  expect(mesh.ahead).toEqual([2, 3]);
  write('field', 'p');
  expect(mesh.ahead).toEqual([]);
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
  mesh.filmed = {time: 1, ahead: [1]};
  write('range', '0,1');
  expect([root.querySelector('.time').querySelector('output').textContent, mesh.ahead]).toEqual([
    't = 1',
    [1],
  ]);
  mesh.filmed = null;
  write('range', '0,2');
  expect([attributes.get('time'), told]).toEqual([undefined, []]);
});

test('instantsAreLookedUpOnceForASeries', () => {
  const {fields} = mesh.manifest!;
  let reads = 0;
  const {instant} = fields[4]!;
  Object.defineProperty(fields[4]!, 'instant', {get: () => (++reads, instant)});
  write('range', '0,1');
  const once = reads;
  write('field', 'S');
  expect(reads - once).toBeGreaterThan(once);
});

/** A picture of the asked instant comes. */
function drawn(): void {
  const shown = mesh.manifest!.fields.findIndex(({instant}) => instant?.isShown);
  mesh.snapshot = {color: {field: shown, component: -1}} as Snapshot;
  bar.follow();
}

/** Ten instants, those of `here` decoded, the first one in the picture. */
function showSeries(here: readonly number[]): void {
  const fields = Array.from({length: 10}, (_, i) => field(`T@${i}`));
  markSeries(fields);
  mesh.manifest = {fields} as Manifest;
  mesh.here = here;
  write('range', '0,1');
  drawn();
}
const kAll = Array.from({length: 10}, (_, i) => i);

test('tenInstantsASecondPassAtTheFirstSpeed', () => {
  showSeries(kAll);
  bar.toggle();
  for (let ms = 0; ms < 500; ms += 25) {
    vi.advanceTimersByTime(25);
    drawn();
  }
  expect(attributes.get('time')).toBe('5');
});

test('instantsWhoseTimePassesWhileOneIsDrawnAreLeftOut', () => {
  showSeries(kAll);
  bar.toggle();
  vi.advanceTimersByTime(100);
  expect(attributes.get('time')).toBe('1');
  vi.advanceTimersByTime(320);
  expect(attributes.get('time')).toBe('1');
  drawn();
  expect(attributes.get('time')).toBe('4');
});

test('onlyInstantsThatAreHereAreGoneTo', () => {
  showSeries([0, 1, 3]);
  bar.toggle();
  vi.advanceTimersByTime(100);
  vi.advanceTimersByTime(320);
  drawn();
  expect(attributes.get('time')).toBe('3');
});

test('theClockStandsWhileAnInstantIsNotHere', () => {
  showSeries([0]);
  bar.toggle();
  vi.advanceTimersByTime(700);
  expect(attributes.get('time')).toBe('1');
  mesh.here = kAll;
  drawn();
  expect(attributes.get('time')).toBe('2');
});

test('anInstantThatIsLateForASecondIsPassedOver', () => {
  showSeries([0, 4]);
  bar.toggle();
  vi.advanceTimersByTime(1050);
  expect(attributes.get('time')).toBe('1');
  vi.advanceTimersByTime(100);
  expect(attributes.get('time')).toBe('4');
});

test('fieldsAheadGoRoundTheEndAndLeaveGapsOut', () => {
  const fields = Array.from({length: 40}, (_, i) => i);
  expect(fieldsAhead(fields, 15)).toEqual(fields.slice(0, 32));
  expect(fieldsAhead(fields, 16)).toEqual([...fields.slice(16), ...fields.slice(0, 8)]);
  expect(fieldsAhead([4, -1, 5], 1)).toEqual([4, 5]);
});
