// How a session follows a series that plays: fields ahead, and wishes that follow each other fast.

import {afterEach, beforeEach, describe, expect, test, vi} from 'vitest';
import {Assembler} from '../core/decode/assembler';
import {kFull} from '../core/protocol/limit';
import {parseFrame, type OpenRequest} from '../core/protocol/messages';
import {Publisher} from '../core/session/publisher';
import {Session} from '../core/session/session';
import type {FromWorker, Source} from '../core/session/worker_messages';
import type {TransportHandlers} from '../core/transport/transport';
import {
  carrier,
  errorsOf,
  FakeCodec,
  fieldFrame,
  headFrame,
  kFakeBlockBytes,
  kFakeValues,
  meshFrame,
  statesOf,
  type FakeLog,
} from './fakes';

const kLog: FakeLog = {fields: ['a', 'b', 'c', 'd'], chunks: 2};
const kSeries: FakeLog = {fields: ['T@0', 'T@1'], chunks: 2};

let codec: FakeCodec;
let session: Session;
let requests: OpenRequest[];
let told: FromWorker[];
let credit: number;
let connections: number;
let isConnected: boolean;

beforeEach(() => {
  vi.useFakeTimers();
  codec = new FakeCodec(kLog);
  requests = [];
  told = [];
  credit = connections = 0;
  isConnected = true;
});
afterEach(() => void vi.useRealTimers());

function start(source: Partial<Source> = {}, log = kLog): void {
  const assembler = new Assembler(codec, kFakeValues);
  session = new Session(
    assembler,
    new Publisher(assembler, () => undefined),
    (message) => told.push(message),
    () => ({
      ...carrier({
        connect: () => {
          ++connections;
        },
        open: (request) => requests.push(request),
        applied: (bytes) => void (credit += bytes),
      }),
      get isConnected() {
        return isConnected;
      },
    }),
  );
  session.start({
    url: 'ws://x',
    log: '',
    transport: 'auto',
    mesh: 'm',
    fields: ['a'],
    limit: kFull,
    ...source,
  });
  session.connected();
  receive(headFrame(1, log));
}

function receive(...frames: ArrayBuffer[]): void {
  for (const frame of frames) (session as TransportHandlers).frame(parseFrame(frame));
}
const wholeField = (field: number): ArrayBuffer[] =>
  [0, 1].map((chunk) => fieldFrame(1, chunk, field));
const chunkOf = (chunk: number, field: number): ArrayBuffer[] => [
  meshFrame(1, chunk),
  fieldFrame(1, chunk, field),
];
function startWhole(): void {
  start();
  receive(...chunkOf(0, 0), ...chunkOf(1, 0));
}
const state = (): string | undefined => statesOf(told).at(-1);

test('fieldsAheadComeBehindAllElseAndChangeNothingThatIsShown', () => {
  startWhole();
  expect(state()).toBe('complete');
  const before = statesOf(told).length;
  session.want([0], [1, 2]);
  expect(requests.at(-1)).toMatchObject({
    fields: ['a', 'b', 'c'],
    have: {chunks: 2, fields: {a: 2, b: 0, c: 0}},
  });
  receive(...wholeField(1), ...wholeField(2));
  expect(codec.fieldChunksApplied(2)).toBe(2);
  expect(statesOf(told)).toHaveLength(before);
  const count = requests.length;
  session.want([1], [1, 2]);
  expect([requests.length, state()]).toEqual([count, 'complete']);
});

test('aFieldThatTheStreamBringsIsWaitedFor', () => {
  startWhole();
  session.want([0], [1, 2]);
  session.want([2], [1, 2]);
  expect([requests.length, state()]).toEqual([2, 'streaming']);
  receive(...wholeField(2));
  expect(state()).toBe('complete');
  vi.advanceTimersByTime(1000);
  expect(requests).toHaveLength(2);
});

test('wishesThatFollowEachOtherFastOpenTenStreamsASecondAndTheLastOneCounts', () => {
  startWhole();
  requests = [];
  for (let ms = 0; ms < 1000; ms += 10) {
    session.want([1 + ((ms / 10) % 2)]);
    vi.advanceTimersByTime(10);
  }
  expect(requests.length).toBeLessThanOrEqual(11);
  session.want([3]);
  vi.advanceTimersByTime(100);
  expect(requests.at(-1)!.fields).toEqual(['d']);
  session.want([0]);
  vi.advanceTimersByTime(1000);
  expect(requests.at(-1)!.fields).toEqual(['d']); // a is here
});

test('theEndOfAStreamIsNoErrorWhileAnotherOneIsDue', () => {
  startWhole();
  session.want([1]);
  session.want([2]);
  session.message({type: 'done', stream: 2});
  expect(errorsOf(told)).toEqual([]);
  vi.advanceTimersByTime(100);
  expect(requests.at(-1)!.fields).toEqual(['c']);
  session.message({type: 'done', stream: 3});
  expect(errorsOf(told)).toEqual(['incomplete']);
});

test('aConnectionThatIsBeingMadeIsNotMadeAgain', () => {
  startWhole();
  isConnected = false;
  session.down(1, 50);
  const before = connections;
  for (let i = 0; i < 20; ++i) {
    session.want([1 + (i % 3)], [1, 2, 3]);
    vi.advanceTimersByTime(100);
  }
  expect(connections).toBe(before + 1);
});

test('aLimitThatIsReachedLetsFieldsAheadComeWithoutFurtherStreams', () => {
  start({limit: {kind: 'cells', value: 1}});
  receive(...chunkOf(0, 0));
  expect(state()).toBe('held');
  session.want([0], [1, 2]);
  const count = requests.length;
  const before = credit;
  receive(fieldFrame(1, 0, 1));
  expect([credit - before, state()]).toEqual([kFakeBlockBytes, 'held']);
  session.want([1], [1, 2]);
  expect(state()).toBe('held');
  session.want([2], [1, 2]);
  expect(state()).toBe('streaming');
  receive(fieldFrame(1, 0, 2));
  expect([requests.length, state()]).toEqual([count, 'held']);
});

test('aPauseIsNotEndedByFieldsAhead', () => {
  start();
  receive(...chunkOf(0, 0));
  session.pause();
  session.want([0], [1, 2]);
  session.want([1], [1, 2]);
  vi.advanceTimersByTime(1000);
  expect([requests.length, state()]).toEqual([1, 'paused']);
  session.resume();
  expect(requests.at(-1)!.fields).toEqual(['b', 'c']);
});

describe('a field ahead', () => {
  test('thatIsDamagedEndsOnlyWhatIsAhead', () => {
    codec.corruptField = 2;
    startWhole();
    session.want([0], [1, 2]);
    receive(...wholeField(1), ...wholeField(2));
    expect([errorsOf(told), state()]).toEqual([['bad-checksum'], 'complete']);
    const count = requests.length;
    session.want([1], [1, 2]);
    vi.advanceTimersByTime(1000);
    expect([requests.length, state()]).toEqual([count, 'complete']);
    session.want([2], [1, 2]);
    expect(requests.at(-1)!.fields).toEqual(['c']);
    receive(fieldFrame(1, 0, 2));
    expect([errorsOf(told), state()]).toEqual([['bad-checksum', 'bad-checksum'], 'failed']);
  });

  test('thatIsDamagedLetsTheShownOneGoOn', () => {
    codec.corruptField = 1;
    start();
    session.want([0], [1]);
    receive(...chunkOf(0, 0), fieldFrame(1, 0, 1), ...chunkOf(1, 0));
    expect([errorsOf(told), state()]).toEqual([['bad-checksum'], 'complete']);
  });

  test('thatDoesNotFitLeavesWhatIsShown', () => {
    codec.fieldRoom = 5;
    startWhole();
    session.want([0], [1, 2]);
    receive(...wholeField(1), ...wholeField(2));
    expect([errorsOf(told), state()]).toEqual([['out-of-memory'], 'complete']);
    expect([codec.restarts, codec.chunksApplied]).toEqual([1, 2]);
    vi.advanceTimersByTime(100);
    const ended = told.flatMap((its) => (its.type === 'progress' ? [its.aheadEnded] : []));
    expect(ended.at(-1)).toBe(true);
    expect(kLog.fields.map((_, field) => codec.fieldChunksApplied(field))).toEqual([2, 0, 0, 0]);
  });

  test('makesRoomForOneThatIsShown', () => {
    codec.fieldRoom = 5;
    startWhole();
    session.want([0], [1]);
    receive(...wholeField(1));
    session.want([2], []);
    receive(...wholeField(2));
    expect([errorsOf(told), state(), codec.chunksApplied]).toEqual([[], 'complete', 2]);
    expect(kLog.fields.map((_, field) => codec.fieldChunksApplied(field))).toEqual([0, 0, 2, 0]);
  });
});

test('aFileIsAskedForTheInstantOfASeriesAtTheTime', () => {
  codec = new FakeCodec(kSeries);
  start({fields: ['T'], time: 0.8}, kSeries);
  expect(requests.at(-1)!.fields).toEqual(['T@1']);
  start({fields: null, time: 0.8}, kSeries);
  expect(requests.at(-1)!.fields).toEqual(['T@1']);
  start({fields: ['T']}, kSeries);
  expect(requests.at(-1)!.fields).toEqual(['T@0']);
  expect(errorsOf(told)).toEqual([]);
});

test.each([
  [true, 'T'],
  [false, undefined],
])('aSingleInstantIsASeriesInASegmentOnly', (isSegment, series) => {
  start({fields: ['T'], time: 7, isSegment}, {fields: ['T@7'], chunks: 2});
  const manifests = told.flatMap((message) => (message.type === 'manifest' ? [message] : []));
  expect(manifests.map(({fields}) => fields)).toEqual([[0]]);
  expect(manifests[0]!.manifest.fields[0]!.instant?.series).toBe(series);
  expect(errorsOf(told)).toEqual(isSegment ? [] : ['unknown-field']);
});
