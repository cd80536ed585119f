import {afterEach, beforeEach, describe, expect, test, vi} from 'vitest';
import {Assembler} from '../core/assembler';
import {kLongestDelayMs} from '../core/backoff';
import {kFull} from '../core/limit';
import {Publisher} from '../core/publisher';
import {Session} from '../core/session';
import {SocketTransport} from '../core/socket_transport';
import type {FromWorker, Source} from '../core/worker_messages';
import {FakeCodec, FakeSocket, fakeHead, fieldFrame, headFrame, kFakeBlockBytes, kFakeValues, meshFrame, type FakeLog} from './fakes';

const kLog: FakeLog = {fields: ['p', 'v'], chunks: 3};

let codec: FakeCodec;
let session: Session;
let sockets: FakeSocket[];
let heard: FromWorker[];

beforeEach(() => {
  vi.useFakeTimers();
  sockets = [];
  heard = [];
  codec = new FakeCodec(kLog);
  const assembler = new Assembler(codec, kFakeValues);
  const publisher = new Publisher(assembler, () => undefined);
  const makeSocket = (): FakeSocket => {
    sockets.push(new FakeSocket());
    return sockets.at(-1)!;
  };
  session = new Session(assembler, publisher, (message) => heard.push(message), ({url}, _, handlers) =>
    new SocketTransport(url, handlers, makeSocket, () => 0));
});

afterEach(() => void vi.useRealTimers());

function start(source: Partial<Source> = {}): FakeSocket {
  session.start({url: 'ws://x', log: '', transport: 'auto', mesh: 'm', fields: ['p'], limit: kFull, ...source});
  sockets.at(-1)!.accept();
  return sockets.at(-1)!;
}

function opened(socket: FakeSocket, stream: number, digest = 'd1'): void {
  socket.deliver(JSON.stringify({type: 'opened', stream, mesh: 'm', digest, bytes: 1000, planned: 100}));
}

const states = (): string[] => heard.flatMap((message) => (message.type === 'state' ? [message.state] : []));
const opens = (): Record<string, unknown>[] => sockets.flatMap((socket) => socket.sentOf('open'));
const errors = (): string[] => heard.flatMap((message) => (message.type === 'error' ? [message.code] : []));

function sendAll(socket: FakeSocket, stream: number, field: number, from = 0): void {
  for (let chunk = from; chunk < kLog.chunks; ++chunk) {
    socket.deliver(meshFrame(stream, chunk));
    socket.deliver(fieldFrame(stream, chunk, field));
  }
  socket.deliver(JSON.stringify({type: 'done', stream}));
}

describe('a stream', () => {
  test('goesFromConnectingToCompleteAndCountsItsBytes', () => {
    const socket = start();
    opened(socket, 1);
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    expect(states()).toEqual(['connecting', 'streaming', 'complete']);
    const progress = heard.flatMap((message) => (message.type === 'progress' ? [message.statistics] : []));
    const needed = fakeHead(kLog).length + 9 * kFakeBlockBytes;
    expect(progress[0]).toMatchObject({bytes: fakeHead(kLog).length, bytesNeeded: needed, total: {tetrahedra: 3}});
    expect(progress.at(-1)).toMatchObject({bytes: needed, bytesNeeded: needed, tetrahedra: 3, chunks: 3});
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
    expect(opens().at(-1)).toMatchObject({have: {chunks: 2, fields: {p: 1}}, digest: 'd1', fields: ['p']});
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
    expect(heard.find(({type}) => type === 'error')).toMatchObject({message: expect.stringMatching(/chunk 1 is damaged\. What came before is sound and stays/)});
    expect(states().at(-1)).toBe('failed');
    expect(socket.closed).toBe(true);
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
    expect(heard.find(({type}) => type === 'manifest')).toMatchObject({fields: [2]});
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
    sendAll(socket, 1, 0);
    expect([codec.chunksApplied, states().at(-1)]).toEqual([2, 'held']);
    session.setLimit(kFull);
    expect([codec.chunksApplied, states().at(-1)]).toEqual([3, 'complete']);
    expect(opens()).toHaveLength(1);
  });

  test('coarserThanNowGoesBackWithoutTheNetwork', () => {
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    sendAll(socket, 1, 0);
    session.setLimit({kind: 'cells', value: 1});
    expect([codec.chunksApplied, codec.fieldChunksApplied(0), states().at(-1)]).toEqual([1, 1, 'held']);
    expect(opens()).toHaveLength(1);
    session.setLimit({kind: 'bytes', value: fakeHead(kLog).length + 50});
    expect([codec.chunksApplied, states().at(-1)]).toEqual([2, 'held']);
  });

  test('ofWhichTheRestIsNotHereAsksTheServerForIt', () => {
    const socket = start({limit: {kind: 'cells', value: 1}});
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(1, 0));
    socket.deliver(fieldFrame(1, 0, 0));
    socket.lose(1006);
    vi.advanceTimersByTime(10 * kLongestDelayMs);
    expect([sockets.length, states().at(-1)]).toEqual([1, 'held']);
    session.setLimit(kFull);
    sockets.at(-1)!.accept();
    expect(opens().at(-1)).toMatchObject({have: {chunks: 1, fields: {p: 1}}});
  });
});

describe('pausing', () => {
  test('stopsTheServerAndGoesOnBehindWhatIsHere', () => {
    const socket = start();
    socket.deliver(headFrame(1, kLog));
    socket.deliver(meshFrame(1, 0));
    socket.deliver(fieldFrame(1, 0, 0));
    session.pause();
    expect([socket.sentOf('stop').length, states().at(-1)]).toEqual([1, 'paused']);
    session.resume();
    expect(opens().at(-1)).toMatchObject({have: {chunks: 1, fields: {p: 1}}});
    sendAll(socket, 2, 0, 1);
    expect(states().at(-1)).toBe('complete');
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
