import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import type {Statistics} from '../core/decode/statistics';
import type {FieldInfo} from '../core/protocol/fields';
import type {Manifest} from '../core/protocol/manifest';
import {markSeries, shownInstant} from '../core/protocol/series';
import type {Snapshot, StreamState} from '../core/session/worker_messages';
import type {View} from '../webgl/view';
import {settingsFor, ShownMesh} from '../viewer/page/shown_mesh';
import type {Settings} from '../viewer/settings/settings';
import {SeriesStage} from '../viewer/picture/series_stage';

function field(name: string): FieldInfo {
  return {name, components: 1, association: 'point', step: 1, minimum: [0], range: [0, 1]};
}

const figures = (bytes: number): Statistics => ({bytes, bytesNeeded: 100}) as Statistics;

let host: {
  view: View | null;
  mesh: ShownMesh;
  settings: Settings;
  stream: {state: StreamState};
  apply(): void;
};
let ends: AbortController;

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal('document', {hidden: false});
  const mesh = new ShownMesh();
  const fields = ['T@2', 'p', 'T@0', 'T@1'].map(field);
  markSeries(fields);
  mesh.manifest = {fields} as Manifest;
  const apply = (): void => void settingsFor(host.mesh, (name) => (name === 'time' ? '2' : null));
  host = {
    view: {} as View,
    mesh,
    settings: {timePart: null} as Settings,
    stream: {state: 'complete'},
    apply,
  };
  ends = new AbortController();
  apply();
  mesh.progress.here = [0, 2];
  arrive(0);
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

/** A picture comes and is drawn. */
function arrive(its: number, bytes = 100): void {
  const {mesh} = host;
  mesh.snapshot = {color: {field: its, component: -1}, statistics: figures(bytes)} as Snapshot;
  mesh.drawn = mesh.snapshot.statistics;
}

const stageOf = (onlyLoaded = false): SeriesStage =>
  new SeriesStage(host, onlyLoaded, () => Promise.reject(new Error()));
const shown = (): number => shownInstant(host.mesh.manifest!.fields, 0);

/** Shows instant `i`. Returns what has become of it after `ms`. */
async function showing(i: number, ms = 100): Promise<string> {
  let became = 'waits';
  stageOf()
    .show(i, ends.signal)
    .then(
      () => (became = 'whole'),
      (error: unknown) => (became = String(error)),
    );
  for (let passed = 0; passed < ms; passed += 20) await vi.advanceTimersByTimeAsync(20);
  return became;
}

test('instantsGoByTimeAndOnRequestOnlyThoseThatAreLoaded', () => {
  expect(stageOf().instants).toEqual([2, 3, 0]);
  expect(stageOf(true).instants).toEqual([2, 0]);
});

test('aMovieHasThePartThatPlays', () => {
  host.settings.timePart = [0.9, 5]; // as the time bar, the instants nearest to both ends
  expect(stageOf().instants).toEqual([3, 0]);
  expect(stageOf(true).instants).toEqual([0]);
  host.settings.timePart = [0, 0.2];
  expect(stageOf().instants).toEqual([2]);
});

test('aFieldWithoutInstantsHasNoMovie', () => {
  arrive(1);
  expect(() => stageOf()).toThrow(/No series is shown/);
  host.mesh.progress.here = [];
  arrive(0);
  expect(() => stageOf(true)).toThrow(/No instant is loaded/);
});

test('anInstantIsShownWithoutTheAttributeAndThenTheOneBefore', async () => {
  const stage = stageOf();
  const done = stage.show(1, ends.signal);
  expect([shown(), host.mesh.ahead.request(host.mesh.progress.here)]).toEqual([3, [2, 3, 0]]);
  host.mesh.progress.here = [3];
  arrive(3);
  await vi.advanceTimersByTimeAsync(20);
  await done;
  stage.restore();
  expect([shown(), host.mesh.ahead.request(host.mesh.progress.here)]).toEqual([0, []]);
});

test('onlyAWholePictureOnTheScreenCounts', async () => {
  expect(await showing(1)).toBe('waits'); // the last one stays
  arrive(3);
  expect(await showing(1)).toBe('waits'); // not all values are here
  host.mesh.progress.here = [3];
  expect(await showing(1)).toBe('whole');
  host.mesh.drawn = figures(100);
  expect(await showing(1)).toBe('waits'); // a newer picture is not drawn
  arrive(3, 60);
  host.mesh.progress.statistics = figures(80);
  expect(await showing(1)).toBe('waits'); // a finer one follows
  host.mesh.progress.statistics = figures(60);
  host.stream.state = 'held';
  expect(await showing(1)).toBe('whole');
  host.stream.state = 'streaming';
  expect(await showing(1)).toBe('waits');
});

test('anInstantThatCannotComeIsNamed', async () => {
  host.stream.state = 'failed';
  expect(await showing(1)).toMatch(/The instant t = 1 did not come: the stream has failed\./);
  host.stream.state = 'paused';
  expect(await showing(1)).toMatch(/The instant t = 1 did not come: the stream is paused\./);
  host.stream.state = 'streaming';
  expect(await showing(1, 59000)).toBe('waits');
  expect(await showing(1, 61000)).toMatch(/t = 1 did not come: nothing came for 60 s\./);
});

test('aHiddenPageAndBytesThatComeProlongTheWait', async () => {
  vi.stubGlobal('document', {hidden: true});
  expect(await showing(1, 61000)).toBe('waits');
  vi.stubGlobal('document', {hidden: false});
  const more = setTimeout(() => (host.mesh.progress.statistics = figures(50)), 30000);
  expect(await showing(1, 61000)).toBe('waits');
  clearTimeout(more);
});

test('aCancelledAnOtherMeshAndAnOtherFieldEndTheWait', async () => {
  const {mesh} = host;
  const stage = stageOf();
  arrive(1);
  await expect(stage.show(1, ends.signal)).rejects.toThrow(/Another field/);
  arrive(0);
  host.view = null;
  await expect(stage.show(1, ends.signal)).rejects.toThrow(/graphics/);
  host.mesh = new ShownMesh();
  await expect(stage.show(1, ends.signal)).rejects.toThrow(/Another mesh/);
  stage.restore();
  expect(mesh.ahead.filmed).toBeNull();
  ends.abort();
  await expect(stage.show(1, ends.signal)).rejects.toThrow(/abort/i);
});
