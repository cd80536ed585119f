import {afterEach, beforeEach, describe, expect, test, vi} from 'vitest';
import type {Assembler} from '../core/decode/assembler';
import type {Scalar} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import type {Vector} from '../core/protocol/geometry';
import type {Manifest} from '../core/protocol/manifest';
import {readSegmentList} from '../core/protocol/segment_list';
import {markSeries} from '../core/protocol/series';
import {Inspector} from '../core/session/inspector';
import type {Fetch} from '../core/transport/ranged_file';
import {kMaxPauseMs, seriesServer, type SeriesServer} from '../core/transport/series_server';
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
let server: SeriesServer | null;
let isExactOffered: boolean;
let announced: string[];

beforeEach(() => {
  const fields = kFields.map((name) => field(name, name.startsWith('u') ? 2 : 1));
  markSeries(fields);
  mesh = new ShownMesh();
  const lattice = {bits: 16, step: 0.5, origin: [10, 20, 30]};
  mesh.manifest = {fields, lattice, levels: [{level: 0}, {level: 7}]} as unknown as Manifest;
  here = new Map([[1, [3, 4]]]);
  asked = [];
  times = [];
  announced = [];
  server = null;
  isExactOffered = false;
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
      get seriesServer() {
        return server;
      },
      fieldTitle: 'u',
      announce: (text) => announced.push(text),
      apply: () => overTime.update(),
      showTime: (text) => times.push(text),
    },
    {
      open: (act, isWanted) => {
        choose = act;
        const plot = {show: (its: TimeCurve) => void (curve = its), destroy: () => undefined};
        return Promise.resolve(isWanted() ? plot : null);
      },
      offerExact: (isOffered) => void (isExactOffered = isOffered),
      close: () => void (curve = null),
    },
  );
});

async function settled(): Promise<void> {
  if (vi.isFakeTimers()) await vi.advanceTimersByTimeAsync(0);
  else await new Promise((resolve) => setTimeout(resolve));
}
afterEach(() => void vi.useRealTimers());

describe('a plot over time', () => {
  test('isOfferedOnlyForASeries', () => {
    expect(overTime.isOffered).toBe(true);
    color = {field: 4, component: -1};
    expect(overTime.isOffered).toBe(false);
  });

  test('fetchesItsInstantsAndShowsThoseThatAreHere', async () => {
    await overTime.begin(kPlace);
    await settled();
    expect([mesh.ahead.request(mesh.progress.here), asked]).toEqual([[1, 0], [[1, 0]]]);
    expect(curve).toEqual({
      at: [0, 1],
      values: [5, NaN],
      title: 'u',
      atTitle: 'time',
      time: 0,
      status: '1 of 2 instants are here, 0\u00a0B so far.',
    });
    here.set(0, [6, 8]);
    mesh.progress.received = 1500;
    overTime.takeProgress();
    await settled();
    const status = '2 of 2 instants are here, 1.50\u00a0kB so far.';
    expect(curve).toMatchObject({values: [5, 10], status});
  });

  test('keepsValuesThatAreNotHereAgainAndSaysThatNoMoreCome', async () => {
    await overTime.begin(kPlace);
    await settled();
    here.clear();
    mesh.progress.aheadEnded = true;
    overTime.takeProgress();
    await settled();
    expect(curve!.values).toEqual([5, NaN]);
    expect(curve!.status).toMatch(/^1 of 2 instants are here, .*\. The others come when/);
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
    expect([mesh.ahead.request(mesh.progress.here), asked.at(-1), curve!.values]).toEqual([
      [2, 3],
      [2, 3],
      [NaN, NaN],
    ]);
  });

  test('saysThatItHasOnlyTheInstantsOfItsSegment', async () => {
    const segments = ['a.qtet', 'b.qtet'].map((log, i) => ({log, times: [i]}));
    const list = readSegmentList({qtet: 'series', segments}, 100);
    Object.assign(mesh, {place: {list, segment: 0}});
    await overTime.begin(kPlace);
    expect(curve!.status).toMatch(/ The plot has only the instants of the shown segment\.$/);
  });

  test('setsTheTimeByAClick', async () => {
    await overTime.begin(kPlace);
    choose(1);
    choose(2);
    expect(times).toEqual(['1']);
  });

  test('endsWithAFieldThatIsNoSeriesAndLeavesWhatPlays', async () => {
    mesh.ahead.playing = [1];
    await overTime.begin(kPlace);
    expect(mesh.ahead.request(mesh.progress.here)).toEqual([1, 0]);
    color = {field: 4, component: -1};
    overTime.update();
    overTime.takeProgress();
    expect([overTime.isOpen, curve, mesh.ahead.request(mesh.progress.here)]).toEqual([
      false,
      null,
      [1],
    ]);
  });

  test('thatIsNotWantedAnyMoreIsNotMade', async () => {
    const opening = overTime.begin(kPlace);
    overTime.end();
    await opening;
    expect(curve).toBeNull();
  });
});

/** A server's answers, which come when they are given. */
class FakeServer {
  readonly requests: URL[] = [];
  private readonly answers: ((answer: Response | Error) => void)[] = [];

  readonly fetch: Fetch = (url, {signal}) => {
    this.requests.push(new URL(url));
    return new Promise((resolve, reject) => {
      signal!.addEventListener('abort', () => reject(new Error('aborted')));
      this.answers.push((answer) => (answer instanceof Error ? reject(answer) : resolve(answer)));
    });
  };

  async answer(answer: Response | Error): Promise<void> {
    this.answers.shift()!(answer);
    await settled();
  }
}

const kTwo = [
  [3, 4],
  [6, 8],
];

const answerOf = (level: number, values: (number | null)[][], at: unknown[] = [0, 1]): Response =>
  Response.json({level, times: at, values}, {headers: {'Content-Length': '18000'}});

describe('a plot over time from a server', () => {
  const kLog = 'https://x/a/v1/meshes/fin/log';
  let fake: FakeServer;

  beforeEach(async () => {
    fake = new FakeServer();
    server = seriesServer(kLog, '', '', fake.fetch);
    await overTime.begin(kPlace);
  });

  test('asksOnceAndShowsTheAnswerWithoutBlocks', async () => {
    expect(fake.requests.map(String)).toEqual([
      'https://x/a/v1/meshes/fin/series?x=10.5&y=21&z=31.5&field=u',
    ]);
    expect(curve).toMatchObject({at: [], status: 'The server is asked for the values.'});
    await fake.answer(
      answerOf(3, [
        [3, 4],
        [null, 1],
      ]),
    );
    overTime.takeProgress();
    expect(curve).toMatchObject({
      at: [0, 1],
      values: [5, NaN],
      time: 0,
      status: '18.0\u00a0kB from the server, rms error at most 1\u202f%, level 3 of 7.',
    });
    expect([isExactOffered, announced]).toEqual([true, [curve!.status]]);
    expect([asked, mesh.ahead.request(mesh.progress.here), fake.requests.length]).toEqual([
      [],
      [],
      1,
    ]);
    const values = [
      [3, 4],
      [NaN, 1],
    ];
    expect(overTime.table()).toEqual({field: 1, times: [0, 1], values});
    color = {field: 0, component: 1};
    overTime.update();
    expect(curve).toMatchObject({values: [4, 1], time: 1});
    expect(fake.requests).toHaveLength(1);
  });

  test('getsTheExactValuesOnRequest', async () => {
    await fake.answer(
      answerOf(3, [
        [3, 4],
        [6, 8],
      ]),
    );
    overTime.askExact();
    expect([isExactOffered, curve!.values]).toEqual([false, [5, 10]]);
    expect(curve!.status).toMatch(/level 3 of 7\. The exact values are on their way\.$/);
    await fake.answer(new Response(null, {status: 500}));
    expect([isExactOffered, curve!.values]).toEqual([true, [5, 10]]);
    expect(curve!.status).toMatch(/ The server does not give the exact values now\.$/);
    overTime.askExact();
    await fake.answer(
      answerOf(7, [
        [0, 1],
        [0, 2],
      ]),
    );
    expect([isExactOffered, curve!.values]).toEqual([false, [1, 2]]);
    expect(curve!.status).toBe('18.0\u00a0kB from the server, exact, level 7 of 7.');
    expect(fake.requests.map(({searchParams}) => searchParams.get('level'))).toEqual([
      null,
      '7',
      '7',
    ]);
  });

  test('asksForTheLastLevelWhereACoarseOneLeavesThePointOut', async () => {
    await fake.answer(new Response(null, {status: 404}));
    expect(fake.requests.map(({searchParams}) => searchParams.get('level'))).toEqual([null, '7']);
    expect([curve!.status, asked]).toEqual(['The server is asked for the values.', []]);
    const exact = [
      [0, 1],
      [0, 2],
    ];
    await fake.answer(answerOf(7, exact));
    expect([curve!.values, isExactOffered]).toEqual([[1, 2], false]);
  });

  test('goesOnWithBlocksForAPointOutside', async () => {
    await fake.answer(new Response(null, {status: 404}));
    await fake.answer(new Response(null, {status: 404}));
    await settled();
    expect([asked, mesh.ahead.request(mesh.progress.here), fake.requests.length]).toEqual([
      [[1, 0]],
      [1, 0],
      2,
    ]);
  });

  test.each([
    new Response(null, {status: 500}),
    new Response('no JSON'),
    answerOf(3, [[3, 4]]),
    answerOf(3, kTwo, [0, 1, 2]),
    answerOf(3, kTwo, [1, 0]),
    answerOf(3, kTwo, [1, 1]),
    answerOf(3, kTwo, [0, null]),
    answerOf(3, kTwo, [0, '1']),
    new Response(`{"level": 3, "times": [0, 1e999], "values": ${JSON.stringify(kTwo)}}`),
    answerOf(3, [[3], [4]]),
    new Error('no network'),
  ])('goesOnWithBlocksIfTheServerFails', async (answer) => {
    await fake.answer(answer);
    await settled();
    expect([asked, mesh.ahead.request(mesh.progress.here)]).toEqual([[[1, 0]], [1, 0]]);
    expect(curve!.values).toEqual([5, NaN]);
    expect(curve!.status).toMatch(/^1 of 2 instants are here, /);
    expect([isExactOffered, fake.requests.length]).toEqual([false, 1]);
  });

  const busy = (status: number, pause?: string): Response =>
    new Response(null, {status, headers: pause === undefined ? {} : {'Retry-After': pause}});

  test.each([
    [429, '3', 3000],
    [503, '0', 0],
    [503, undefined, 2000],
    [503, 'soon', 2000],
    [429, new Date(4000).toUTCString(), 4000],
    [503, new Date(0).toUTCString(), 0],
    [503, '3600', kMaxPauseMs],
  ])('asksABusyServerOnceMoreAfterThePauseThatItNames', async (status, pause, ms) => {
    vi.useFakeTimers({now: 0});
    await fake.answer(busy(status, pause));
    await vi.advanceTimersByTimeAsync(Math.max(0, ms - 1));
    expect(fake.requests).toHaveLength(ms > 0 ? 1 : 2);
    await vi.advanceTimersByTimeAsync(1);
    expect(fake.requests.map(String)).toEqual(Array(2).fill(String(fake.requests[0])));
    expect([curve!.status, asked]).toEqual(['The server is asked for the values.', []]);
    await fake.answer(answerOf(3, kTwo));
    expect([curve!.values, asked]).toEqual([[5, 10], []]);
  });

  test('goesOnWithBlocksIfTheServerStaysBusy', async () => {
    vi.useFakeTimers();
    await fake.answer(busy(503, '1'));
    await vi.advanceTimersByTimeAsync(1000);
    await fake.answer(busy(429, '1'));
    await vi.advanceTimersByTimeAsync(kMaxPauseMs);
    expect([fake.requests.length, asked, mesh.ahead.request(mesh.progress.here)]).toEqual([
      2,
      [[1, 0]],
      [1, 0],
    ]);
  });

  test('doesNotAskABusyServerAgainOnceItIsClosed', async () => {
    vi.useFakeTimers();
    await fake.answer(busy(503, '1'));
    overTime.end();
    await vi.advanceTimersByTimeAsync(kMaxPauseMs);
    expect([fake.requests.length, asked, vi.getTimerCount()]).toEqual([1, [], 0]);
  });

  test('isAbortedByAnotherPointAnotherSeriesAndTheEnd', async () => {
    await overTime.begin([0, 0, 0]);
    color = {field: 2, component: -1};
    overTime.update();
    expect(fake.requests.map(({searchParams}) => searchParams.get('field'))).toEqual([
      'u',
      'u',
      'T',
    ]);
    await fake.answer(
      answerOf(3, [
        [3, 4],
        [6, 8],
      ]),
    );
    await fake.answer(
      answerOf(3, [
        [3, 4],
        [6, 8],
      ]),
    );
    expect(curve!.at).toEqual([]);
    overTime.end();
    await fake.answer(answerOf(3, [[1], [2]]));
    expect([curve, asked, mesh.ahead.request(mesh.progress.here), announced]).toEqual([
      null,
      [],
      [],
      [],
    ]);
  });

  test('showsTheTimeOfAnInstantThatTheManifestDoesNotHaveYet', async () => {
    await fake.answer(
      answerOf(
        3,
        [
          [3, 4],
          [6, 8],
          [0, 0],
        ],
        [0, 1, 2.5],
      ),
    );
    choose(1);
    choose(2);
    expect(times).toEqual(['1', '2.5']);
  });
});

test('theServerOfALogIsKnownByItsAddress', async () => {
  const kDigest = 'ab'.repeat(32);
  const urlOf = async (log: string, digest = ''): Promise<string | null> => {
    const urls: [string, string | null][] = [];
    const its = seriesServer(log, digest, 'secret', (url, {headers}) => {
      urls.push([url, new Headers(headers).get('authorization')]);
      return Promise.resolve(answerOf(0, [[1], [2]]));
    });
    const fields = ['T@0', 'T@1'].map((name) => ({...field(name), association: 'cell' as const}));
    markSeries(fields);
    await its?.values(
      {point: [1, 0, -2], field: fields[0]!, level: 0},
      new AbortController().signal,
    );
    expect(urls.map(([, authorization]) => authorization)).toEqual(its ? ['Bearer secret'] : []);
    return urls[0]?.[0] ?? null;
  };
  const query = '/series?x=1&y=0&z=-2&field=cell%3AT&level=0';
  expect(await urlOf('http://x/v1/meshes/a%20b/log', kDigest)).toBe(
    `http://x/v1/logs/${kDigest}${query}`,
  );
  expect(await urlOf('http://x/v1/meshes/a%20b/log', '5f-1')).toBe(
    `http://x/v1/meshes/a%20b${query}`,
  );
  expect(await urlOf(`https://x/p/v1/logs/${kDigest}/log`)).toBe(
    `https://x/p/v1/logs/${kDigest}${query}`,
  );
  for (const log of ['https://x/a/fin.qtet', 'blob:https://x/v1#fin.qtet', ''])
    expect(await urlOf(log, kDigest)).toBeNull();
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
