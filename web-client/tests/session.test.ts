import {afterEach, beforeEach, describe, expect, test, vi} from 'vitest';
import {Assembler} from '../core/decode/assembler';
import {kLongestDelayMs} from '../core/transport/backoff';
import {kPlainDisplay} from '../core/picture/display';
import {kFull} from '../core/protocol/limit';
import {Publisher} from '../core/session/publisher';
import {parseFrame} from '../core/protocol/messages';
import {Session} from '../core/session/session';
import {SocketTransport} from '../core/transport/socket_transport';
import type {FromWorker, Snapshot, Source} from '../core/session/worker_messages';
import {
  carrier,
  errorsOf,
  FakeCodec,
  FakeSocket,
  fakeHead,
  fieldFrame,
  headFrame,
  kFakeBlockBytes,
  kFakeValues,
  meshFrame,
  statesOf,
  until,
  type FakeLog,
} from './fakes';

const kLog: FakeLog = {fields: ['p', 'v'], chunks: 3};

let codec: FakeCodec;
let decoder: Assembler;
let session: Session;
let sockets: FakeSocket[];
let received: FromWorker[];
let publisher: Publisher;
let pictures: Snapshot[];

beforeEach(() => {
  vi.useFakeTimers();
  sockets = [];
  received = [];
  codec = new FakeCodec(kLog);
  decoder = new Assembler(codec, kFakeValues);
  pictures = [];
  publisher = new Publisher(decoder, (snapshot) => void pictures.push(snapshot));
  const makeSocket = (): FakeSocket => {
    sockets.push(new FakeSocket());
    return sockets.at(-1)!;
  };
  session = new Session(
    decoder,
    publisher,
    (message) => received.push(message),
    ({url}, _, handlers) => new SocketTransport(url, handlers, makeSocket, () => 0),
  );
});

afterEach(() => void vi.useRealTimers());

function start(source: Partial<Source> = {}): FakeSocket {
  session.start({
    url: 'ws://x',
    log: '',
    transport: 'auto',
    mesh: 'm',
    fields: ['p'],
    limit: kFull,
    ...source,
  });
  sockets.at(-1)!.accept();
  return sockets.at(-1)!;
}

function opened(socket: FakeSocket, stream: number): void {
  socket.deliver(
    JSON.stringify({
      type: 'opened',
      stream,
      mesh: 'm',
      digest: 'd1',
      bytes: 1000,
      planned: 100,
    }),
  );
}

const states = (): string[] => statesOf(received);
const opens = (): Record<string, unknown>[] => sockets.flatMap((socket) => socket.sentOf('open'));
const errors = (): string[] => errorsOf(received);

function sendAll(socket: FakeSocket, stream: number, field: number, from = 0): void {
  for (let chunk = from; chunk < kLog.chunks; ++chunk) {
    socket.deliver(meshFrame(stream, chunk));
    socket.deliver(fieldFrame(stream, chunk, field));
  }
  socket.deliver(JSON.stringify({type: 'done', stream}));
}

describe('the first picture', () => {
  test('goesOutBeforeAnythingFinerIsDecoded', () => {
    const socket = start({pictureFirst: true});
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    expect(codec.chunksApplied).toBe(1);
    publisher.show({...kPlainDisplay, color: {field: 0, component: -1}});
    vi.advanceTimersByTime(20);
    expect(pictures.map(({statistics}) => statistics.chunks)).toEqual([1]);
    expect(codec.chunksApplied).toBe(kLog.chunks);
    expect(states().at(-1)).toBe('complete');
  });

  test('isNotWaitedForWithoutEnd', () => {
    const socket = start({pictureFirst: true});
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    vi.advanceTimersByTime(499);
    expect(codec.chunksApplied).toBe(1);
    vi.advanceTimersByTime(1);
    expect(codec.chunksApplied).toBe(kLog.chunks);
  });
});

describe('a codec that is still on its way', () => {
  test('isWaitedForWhileTheLineOpensAndTheStreamComes', async () => {
    let come = (): void => undefined;
    decoder.codecReady = new Promise((resolve) => void (come = resolve));
    session.waitForCodec();
    const socket = start();
    expect(opens()).toHaveLength(1);
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    expect([decoder.manifest, states().at(-1)]).toEqual([null, 'connecting']);
    come();
    await decoder.codecReady;
    expect([codec.chunksApplied, states().at(-1)]).toEqual([kLog.chunks, 'complete']);
  });
});

describe('decoding', () => {
  test('takesOneSliceHoweverManyFramesComeAtOnce', async () => {
    const apply = codec.apply.bind(codec);
    let elapsedMs = 0;
    vi.spyOn(performance, 'now').mockImplementation(() => elapsedMs);
    codec.apply = (chunk) => {
      elapsedMs += 1000;
      apply(chunk);
    };
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    expect(codec.chunksApplied).toBe(1);
    vi.useRealTimers();
    await until(() => states().at(-1) === 'complete');
    expect(codec.chunksApplied).toBe(kLog.chunks);
    vi.restoreAllMocks();
  });
});

test('whatLiesAheadIsToldWithTheHeadAndAnewForOtherFields', () => {
  const socket = start();
  opened(socket, 1);
  socket.deliver(headFrame(1, kLog));
  session.want([0, 1]);
  const plans = received.flatMap((message) => (message.type === 'plan' ? [message.plan] : []));
  const head = fakeHead(kLog).length;
  expect(plans).toEqual(
    [3, 4].map((blocks) =>
      [1, 2, 3].map((chunks) => ({
        bytes: head + chunks * blocks * kFakeBlockBytes,
        level: chunks - 1,
      })),
    ),
  );
});

describe('a stream', () => {
  test('goesFromConnectingToCompleteAndCountsItsBytes', () => {
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    vi.advanceTimersByTime(0);
    sendAll(socket, 1, 0);
    expect(states()).toEqual(['connecting', 'streaming', 'complete']);
    const progress = received.flatMap((message) =>
      message.type === 'progress' ? [message.statistics] : [],
    );
    const needed = fakeHead(kLog).length + 9 * kFakeBlockBytes;
    // one for the head, and one for everything before the state
    expect(progress).toHaveLength(2);
    expect(progress[0]).toMatchObject({
      bytes: fakeHead(kLog).length,
      bytesNeeded: needed,
      total: {tetrahedra: 3},
    });
    expect(progress.at(-1)).toMatchObject({
      bytes: needed,
      bytesNeeded: needed,
      tetrahedra: 3,
      chunks: 3,
    });
  });

  test('resumesWithWhatIsApplied', () => {
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(1, 0));
    socket.deliver(fieldFrame(1, 0, 0));
    socket.deliver(meshFrame(1, 1));
    socket.lose(1006);
    expect(states().at(-1)).toBe('reconnecting');
    vi.advanceTimersByTime(kLongestDelayMs);
    sockets.at(-1)!.accept();
    expect(opens().at(-1)).toMatchObject({
      have: {chunks: 2, fields: {p: 1}},
      digest: 'd1',
      fields: ['p'],
    });
    opened(sockets.at(-1)!, 1);
    sockets.at(-1)!.deliver(fieldFrame(1, 1, 0));
    sendAll(sockets.at(-1)!, 1, 0, 2);
    expect(states().at(-1)).toBe('complete');
  });

  test('ofAnotherMeshUnderTheSameNameStartsAnew', () => {
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(1, 0));
    socket.lose(1006);
    vi.advanceTimersByTime(kLongestDelayMs);
    const again = sockets.at(-1)!;
    again.accept();
    again.deliver('{"type":"error","code":"log-changed","detail":"another"}');
    expect(opens().at(-1)).toMatchObject({have: {chunks: 0, fields: {}}});
    expect(opens().at(-1)).not.toHaveProperty('digest');
    again.deliver(headFrame(2, kLog));
    sendAll(again, 2, 0);
    expect(states().at(-1)).toBe('complete');
    expect(errors()).toEqual([]);
  });

  test('withADamagedBlockFailsWithItsCode', () => {
    codec.corrupt = 1;
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    expect(errors()).toEqual(['bad-checksum']);
    expect(received.find(({type}) => type === 'error')).toMatchObject({
      message: expect.stringMatching(
        /chunk 1 is damaged\. What came before is sound and stays/,
      ) as string,
    });
    expect(states().at(-1)).toBe('failed');
    expect(socket.closed).toBe(true);
  });

  test('withADamagedBlockShowsAllThatCameBeforeIt', () => {
    codec.corrupt = 2;
    const socket = start({pictureFirst: true});
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    expect([errors(), codec.chunksApplied]).toEqual([['bad-checksum'], 1]);
    vi.advanceTimersByTime(500);
    expect([states().at(-1), codec.chunksApplied]).toEqual(['failed', 2]);
  });

  test('withADamagedBaseDoesNotSayThatSomethingStays', () => {
    codec.corrupt = 0;
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(1, 0));
    expect(received.find(({type}) => type === 'error')).toMatchObject({
      message: expect.stringMatching(/chunk 0 is damaged\. Nothing can be shown yet\./) as string,
    });
  });

  test('thatEndsEarlyIsNotCalledComplete', () => {
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(1, 0));
    socket.deliver('{"type":"done","stream":1}');
    expect(errors()).toEqual(['incomplete']);
  });

  test('canBeTriedAgainAfterAFailure', () => {
    codec.corrupt = 0;
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(1, 0));
    codec.corrupt = -1;
    session.resume();
    const again = sockets.at(-1)!;
    again.accept();
    again.deliver(headFrame(1, kLog));
    sendAll(again, 1, 0);
    expect(states().at(-1)).toBe('complete');
  });
});

describe('fields', () => {
  test('anotherFieldIsAskedForBehindTheChunksThatAreHere', () => {
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    session.want([1]);
    expect(opens().at(-1)).toMatchObject({fields: ['v'], have: {chunks: 3, fields: {v: 0}}});
    for (let chunk = 0; chunk < 3; ++chunk) socket.deliver(fieldFrame(2, chunk, 1));
    socket.deliver('{"type":"done","stream":2}');
    expect(states().slice(-2)).toEqual(['streaming', 'complete']);
    session.want([0]);
    expect(opens()).toHaveLength(2);
    expect(states().at(-1)).toBe('complete');
  });

  test('withoutANameOneByteOfCreditBuysTheHeadAndTheFirstFieldIsAskedFor', () => {
    const socket = start({fields: null});
    expect(opens()[0]).toMatchObject({fields: [], credit: 1});
    socket.deliver(headFrame(1, kLog));
    expect(opens()[1]).toMatchObject({fields: ['p'], have: {chunks: 0}});
  });

  test('ofCellsAreAskedForByTheirKey', () => {
    const socket = start({fields: ['cell:p']});
    socket.deliver(headFrame(1, {...kLog, cellFields: ['p']}));
    expect(opens()).toHaveLength(1);
    expect(received.find(({type}) => type === 'manifest')).toMatchObject({fields: [2]});
  });

  test('ofWhichSeveralAreWantedAllCome', () => {
    const socket = start({fields: ['p', 'v']});
    expect(opens()[0]).toMatchObject({fields: ['p', 'v']});
    socket.deliver(headFrame(1, kLog));
    for (let chunk = 0; chunk < 3; ++chunk) socket.deliver(fieldFrame(1, chunk, 1));
    sendAll(socket, 1, 0);
    expect(states().at(-1)).toBe('complete');
    expect([codec.fieldChunksApplied(0), codec.fieldChunksApplied(1)]).toEqual([3, 3]);
  });

  test('anUnknownFieldIsReportedAndTheFirstOneShown', () => {
    const socket = start({fields: ['nope']});
    socket.deliver('{"type":"error","code":"unknown-field","detail":"no nope"}');
    socket.deliver(headFrame(2, kLog));
    socket.deliver(headFrame(3, kLog));
    sendAll(socket, 3, 0);
    expect(errors()).toEqual(['unknown-field']);
    expect(states().at(-1)).toBe('complete');
  });
});

describe('a limit', () => {
  test('holdsTheMeshAndTheCreditAndGoesOnFromWhatIsHere', () => {
    const socket = start({limit: {kind: 'cells', value: 2}});
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 2, 0);
    expect([codec.chunksApplied, states().at(-1)]).toEqual([2, 'held']);
    session.setLimit(kFull);
    expect([codec.chunksApplied, states().at(-1)]).toEqual([3, 'complete']);
    expect(opens()).toHaveLength(2);
  });

  test('coarserThanNowGoesBackWithoutTheNetwork', () => {
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    session.setLimit({kind: 'cells', value: 1});
    expect([codec.chunksApplied, codec.fieldChunksApplied(0), states().at(-1)]).toEqual([
      1,
      1,
      'held',
    ]);
    expect(opens()).toHaveLength(1);
    session.setLimit({kind: 'bytes', value: fakeHead(kLog).length + 50});
    expect([codec.chunksApplied, states().at(-1)]).toEqual([2, 'held']);
  });

  test('ofWhichTheRestIsNotHereAsksTheServerForIt', () => {
    const socket = start({limit: {kind: 'cells', value: 1}});
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(2, 0));
    socket.deliver(fieldFrame(2, 0, 0));
    socket.lose(1006);
    vi.advanceTimersByTime(10 * kLongestDelayMs);
    expect([sockets.length, states().at(-1)]).toEqual([1, 'held']);
    session.setLimit(kFull);
    sockets.at(-1)!.accept();
    expect(opens().at(-1)).toMatchObject({have: {chunks: 1, fields: {p: 1}}});
  });
});

describe('a target', () => {
  test('stopsTheServerAtTheLevelThatTheLimitReaches', () => {
    const socket = start({limit: {kind: 'cells', value: 2}});
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    expect(opens()).toMatchObject([{credit: 1}, {target: {level: 1}}]);
    opened(socket, 2);
    for (const chunk of [0, 1]) {
      socket.deliver(meshFrame(2, chunk));
      socket.deliver(fieldFrame(2, chunk, 0));
    }
    socket.deliver(JSON.stringify({type: 'done', stream: 2}));
    expect([errors(), states().at(-1)]).toEqual([[], 'held']);
    session.setLimit(kFull);
    expect(socket.sentOf('target')).toEqual([{type: 'target', target: null}]);
    sendAll(socket, 2, 0, 2);
    expect([opens().length, states().at(-1)]).toEqual([2, 'complete']);
  });

  test('thatWasNotReachedIsAnError', () => {
    const socket = start({limit: {kind: 'bytes', value: fakeHead(kLog).length + 50}});
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(2, 0));
    socket.deliver(JSON.stringify({type: 'done', stream: 2}));
    expect(errors()).toEqual(['incomplete']);
  });

  test('ofBeforeMayBeDoneWhileTheNewOneIsOnItsWay', () => {
    const socket = start({limit: {kind: 'cells', value: 1}});
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    opened(socket, 2);
    session.setLimit({kind: 'cells', value: 2});
    socket.deliver(meshFrame(2, 0));
    socket.deliver(fieldFrame(2, 0, 0));
    socket.deliver(JSON.stringify({type: 'done', stream: 2}));
    expect(errors()).toEqual([]);
    expect(opens().at(-1)).toMatchObject({target: {level: 1}, have: {chunks: 1, fields: {p: 1}}});
    opened(socket, 3);
    socket.deliver(JSON.stringify({type: 'done', stream: 3})); // the current one
    expect(errors()).toEqual(['incomplete']);
  });

  test('standsInTheOpenOfAConnectionThatComesBack', () => {
    const socket = start({limit: {kind: 'cells', value: 3}});
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    socket.lose(1006);
    vi.advanceTimersByTime(kLongestDelayMs);
    sockets.at(-1)!.accept();
    expect(opens().at(-1)).toMatchObject({target: {level: 2}, have: {chunks: 0}});
  });

  test('aPauseKeepsTheStreamAndTheCreditOfWhatCameMeanwhile', () => {
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    session.pause();
    expect(socket.sentOf('pause')).toHaveLength(1);
    for (const chunk of [0, 1]) {
      socket.deliver(meshFrame(1, chunk));
      socket.deliver(fieldFrame(1, chunk, 0));
    }
    expect(socket.sentOf('credit')).toEqual([]);
    session.resume();
    expect([opens().length, socket.sentOf('resume').length]).toEqual([1, 1]);
    sendAll(socket, 1, 0, 2);
    expect(states().at(-1)).toBe('complete');
  });

  test('aPauseBeforeTheHeadIsHereGoesOnWithTheSameStream', () => {
    const socket = start({fields: null});
    opened(socket, 1);
    session.pause();
    session.resume();
    expect([opens().length, socket.sentOf('resume').length]).toEqual([1, 1]);
    socket.deliver(headFrame(1, kLog));
    expect(opens().map(({credit}) => credit)).toEqual([1, 1 << 20]);
  });

  test('aPauseBeforeTheHeadOfAnotherLogIsHereHasNoMeshToShow', () => {
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    start({mesh: 'n'});
    session.pause();
    session.resume();
    expect(errors()).toEqual([]);
    expect(states().at(-1)).not.toBe('failed');
  });

  test('aPauseInWhichAnotherFieldWasAskedForEndsWithAnOpen', () => {
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    session.pause();
    session.want([1]);
    session.resume();
    expect([opens().at(-1)!.fields, socket.sentOf('resume').length]).toEqual([['v'], 0]);
  });

  test('aLimitThatIsSetDuringAPauseEndsIt', () => {
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    session.pause();
    session.setLimit({kind: 'cells', value: 1});
    expect(states().at(-1)).toBe('streaming');
    expect([socket.sentOf('target').at(-1)!.target, socket.sentOf('resume').length]).toEqual([
      {level: 0},
      1,
    ]);
  });
});

describe('pausing', () => {
  test('stopsTheServerAndGoesOnBehindWhatIsHere', () => {
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(1, 0));
    socket.deliver(fieldFrame(1, 0, 0));
    session.pause();
    expect([socket.sentOf('pause').length, states().at(-1)]).toEqual([1, 'paused']);
    session.resume();
    expect([socket.sentOf('resume').length, opens().length]).toEqual([1, 1]);
    sendAll(socket, 1, 0, 1);
    expect(states().at(-1)).toBe('complete');
  });

  test('beforeTheHeadEndsWithAnOpen', () => {
    session.start({
      url: 'ws://x',
      log: '',
      transport: 'auto',
      mesh: 'm',
      fields: null,
      limit: kFull,
    });
    session.pause();
    sockets[0]!.accept();
    expect([opens(), states().at(-1)]).toEqual([[], 'paused']);
    session.resume();
    expect(opens()).toMatchObject([{fields: [], credit: 1}]);
    sockets[0]!.deliver(headFrame(1, kLog));
    session.pause();
    session.resume();
    sendAll(sockets[0]!, 2, 0);
    expect(states().at(-1)).toBe('complete');
  });

  test('fromTheStartAsksNothingBeforeItEnds', () => {
    session.pause();
    expect(received).toEqual([]); // about what is not there yet
    session.start({
      url: 'ws://x',
      log: '',
      transport: 'auto',
      mesh: 'm',
      fields: ['p'],
      limit: kFull,
      paused: true,
    });
    expect([sockets.length, states()]).toEqual([0, ['paused']]);
    session.resume();
    sockets[0]!.accept();
    sockets[0]!.deliver(headFrame(1, kLog));
    sendAll(sockets[0]!, 1, 0);
    expect(states().at(-1)).toBe('complete');
  });

  test('fromTheStartIsOverWhenAFailureIsTriedAgain', () => {
    codec.corrupt = 0;
    session.start({
      url: 'ws://x',
      log: '',
      transport: 'auto',
      mesh: 'm',
      fields: ['p'],
      limit: kFull,
      paused: true,
    });
    session.resume();
    sockets[0]!.accept();
    sockets[0]!.deliver(headFrame(1, kLog));
    sockets[0]!.deliver(meshFrame(1, 0));
    expect(states().at(-1)).toBe('failed');
    session.resume();
    expect([sockets.length, states().at(-1)]).toEqual([2, 'connecting']);
  });

  test('aLostConnectionDuringAPauseWaitsForTheUser', () => {
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    session.pause();
    socket.lose(1006);
    vi.advanceTimersByTime(10 * kLongestDelayMs);
    expect(sockets).toHaveLength(1);
    session.resume();
    expect(sockets).toHaveLength(2);
  });
});

describe('memory', () => {
  test('whereItEndsTheMeshStaysAtALevelThatFits', () => {
    codec.room = 2;
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    expect(errors()).toEqual(['out-of-memory']);
    expect(codec.restarts).toBe(1);
    expect(states().at(-1)).toBe('held');
    expect(codec.chunksApplied).toBe(1);
  });

  test('whereThereIsMoreOfItByNowTheMeshGoesOn', () => {
    codec.room = 2;
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    codec.room = Infinity;
    session.setLimit(kFull);
    sockets.at(-1)!.accept();
    sockets.at(-1)!.deliver(fieldFrame(1, 2, 0)); // it had arrived when the connection was given up
    expect([codec.chunksApplied, states().at(-1)]).toEqual([kLog.chunks, 'complete']);
  });

  test('whereNotEvenTheFirstChunkFitsItFails', () => {
    codec.room = 0;
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    expect(errors()).toEqual(['out-of-memory']);
    expect(states().at(-1)).toBe('failed');
  });
});

test('creditIsGivenBackOnceForWhatWasApplied', () => {
  const given: number[] = [];
  const assembler = new Assembler(codec, kFakeValues);
  const giving = new Session(
    assembler,
    new Publisher(assembler, () => undefined),
    () => undefined,
    () => carrier({applied: (bytes) => given.push(bytes)}),
  );
  giving.start({url: 'ws://x', log: '', transport: 'auto', mesh: 'm', fields: ['p'], limit: kFull});
  giving.connected();
  giving.frame(parseFrame(headFrame(1, kLog)));
  giving.frame(parseFrame(meshFrame(1, 0)));
  giving.frame(parseFrame(fieldFrame(1, 0, 0)));
  giving.setLimit(kFull); // decoding continues without a new byte
  expect(given).toEqual([fakeHead(kLog).length, 2 * kFakeBlockBytes, kFakeBlockBytes]);
});
