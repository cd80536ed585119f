import {beforeEach, describe, expect, test} from 'vitest';
import type {Assembler} from '../core/decode/assembler';
import type {Scalar} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import type {Vector} from '../core/protocol/geometry';
import type {Manifest} from '../core/protocol/manifest';
import {markSeries} from '../core/protocol/series';
import {Inspector} from '../core/session/inspector';
import {ShownMesh} from '../viewer/page/shown_mesh';
import {OverTime} from '../viewer/panels/over_time';
import type {TimeCurve} from '../viewer/panels/probe_plot';
import {cubes} from './cubes';

function field(name: string, components = 1): FieldInfo {
  const minimum = Array<number>(components).fill(0);
  return {name, components, association: 'point', step: 1, minimum, range: [0, 40]};
}

const kPlace: Vector = [1, 2, 3];
/** In the order of time: 1, 0. */
const kFields = ['u@1', 'u@0', 'T@0', 'T@1', 'p'];
/** The answers of the worker, by field. */
let here: Map<number, number[]>;
let asked: (readonly number[])[];
let mesh: ShownMesh;
let color: Scalar | null;
let curve: TimeCurve | null;
let choose: (i: number) => void;
let times: string[];
let overTime: OverTime;

beforeEach(() => {
  const fields = kFields.map((name) => field(name, name.startsWith('u') ? 2 : 1));
  markSeries(fields);
  mesh = new ShownMesh();
  mesh.manifest = {fields} as Manifest;
  here = new Map([[1, [3, 4]]]);
  asked = [];
  times = [];
  curve = null;
  color = {field: 1, component: -1};
  overTime = new OverTime(
    {
      client: {
        values: (_place, instants) => {
          asked.push(instants);
          return Promise.resolve(instants.map((instant) => here.get(instant) ?? []));
        },
      },
      mesh,
      get color() {
        return color;
      },
      fieldTitle: 'u',
      apply: () => overTime.update(),
      showTime: (text) => times.push(text),
    },
    {
      open: (act, isWanted) => {
        choose = act;
        const plot = {show: (its: TimeCurve) => void (curve = its), destroy: () => undefined};
        return Promise.resolve(isWanted() ? plot : null);
      },
      close: () => void (curve = null),
    },
  );
});

const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

describe('a plot over time', () => {
  test('isOfferedOnlyForASeries', () => {
    expect(overTime.isOffered).toBe(true);
    color = {field: 4, component: -1};
    expect(overTime.isOffered).toBe(false);
  });

  test('fetchesItsInstantsAndShowsThoseThatAreHere', async () => {
    await overTime.begin(kPlace);
    await settled();
    expect([mesh.ahead, asked]).toEqual([[1, 0], [[1, 0]]]);
    expect(curve).toEqual({
      at: [0, 1],
      values: [5, NaN],
      title: 'u',
      time: 0,
      status: '1 of 2 instants are here.',
    });
    here.set(0, [6, 8]);
    overTime.takeProgress();
    await settled();
    expect(curve).toMatchObject({values: [5, 10], status: 'u'});
  });

  test('keepsValuesThatAreNotHereAgainAndSaysThatNoMoreCome', async () => {
    await overTime.begin(kPlace);
    await settled();
    here.clear();
    mesh.aheadEnded = true;
    overTime.takeProgress();
    await settled();
    expect(curve!.values).toEqual([5, NaN]);
    expect(curve!.status).toMatch(/^1 of 2 instants are here\. The others come when/);
  });

  test('followsTheComponentTheTimeAndTheSeries', async () => {
    await overTime.begin(kPlace);
    await settled();
    color = {field: 0, component: 1};
    overTime.update();
    expect(curve).toMatchObject({values: [4, NaN], time: 1});
    color = {field: 2, component: -1};
    overTime.update();
    await settled();
    expect([mesh.ahead, asked.at(-1), curve!.values]).toEqual([
      [2, 3],
      [2, 3],
      [NaN, NaN],
    ]);
  });

  test('setsTheTimeByAClick', async () => {
    await overTime.begin(kPlace);
    choose(1);
    choose(2);
    expect(times).toEqual(['1']);
  });

  test('endsWithAFieldThatIsNoSeriesAndLeavesWhatPlays', async () => {
    mesh.playing = [1];
    await overTime.begin(kPlace);
    expect(mesh.ahead).toEqual([1, 0]);
    color = {field: 4, component: -1};
    overTime.update();
    overTime.takeProgress();
    expect([overTime.isOpen, curve, mesh.ahead]).toEqual([false, null, [1]]);
  });

  test('thatIsNotWantedAnyMoreIsNotMade', async () => {
    const opening = overTime.begin(kPlace);
    overTime.end();
    await opening;
    expect(curve).toBeNull();
  });
});

test('valuesAtAPlaceAreThoseOfWholeFields', () => {
  const {points, tetrahedra} = cubes(4, 10);
  const along = points.filter((_, i) => i % 3 === 0);
  const assembler = {
    manifest: {fields: [field('a'), field('b')]},
    codec: {
      chunksApplied: 1,
      points: () => points,
      tetrahedra: () => tetrahedra,
      boundary: () => new Uint32Array(0),
      field: () => along,
    },
    wholeFields: [0],
  };
  const inspector = new Inspector(assembler as unknown as Assembler);
  const [values, none] = inspector.values([11.3, 17.7, 3.1], [0, 1]);
  expect([values![0], none]).toEqual([expect.closeTo(11.3), []]);
  expect(inspector.values([40.2, 17.7, 3.1], [0])[0]![0]).toBeCloseTo(40);
});
