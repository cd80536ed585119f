import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {kFirstDelayMs, kLongestDelayMs, reconnectDelayMs} from '../core/transport/backoff';
import type {Frame, OpenRequest} from '../core/protocol/messages';
import {kCreditShare, SocketTransport} from '../core/transport/socket_transport';
import type {TransportHandlers} from '../core/transport/transport';
import {FakeSocket, frame} from './fakes';

const kOpen: OpenRequest = {mesh: 'm', fields: [], have: {chunks: 0, fields: {}}, credit: 80};

let sockets: FakeSocket[];
let received: string[];
let handlers: TransportHandlers;
let transport: SocketTransport;

beforeEach(() => {
  vi.useFakeTimers();
  sockets = [];
  received = [];
  handlers = {
    connected: () => received.push('connected'),
    message: (message) => received.push(message.type),
    frame: ({chunk}) => received.push(`chunk ${chunk}`),
    down: (attempt, delayMs) => received.push(`down ${attempt} ${delayMs}`),
    failed: (error) => received.push(`failed ${error.code}`),
  };
  const makeSocket = (): FakeSocket => {
    sockets.push(new FakeSocket());
    return sockets.at(-1)!;
  };
  transport = new SocketTransport('ws://x/v1/stream', handlers, makeSocket, () => 0.5);
  transport.connect();
});

afterEach(() => void vi.useRealTimers());

test('framesAndRepliesOfASupersededStreamAreDropped', () => {
  sockets[0]!.accept();
  transport.open(kOpen);
  transport.open(kOpen);
  sockets[0]!.deliver(frame({stream: 1, chunk: 5}));
  sockets[0]!.deliver('{"type":"done","stream":1}');
  sockets[0]!.deliver(frame({stream: 2, chunk: 6}));
  sockets[0]!.deliver('{"type":"done","stream":2}');
  expect(received).toEqual(['connected', 'chunk 6', 'done']);
});

test('piecesOfABlockAreJoinedAndCreditedWhenTheyArrive', () => {
  const frames: Frame[] = [];
  handlers.frame = (whole) => frames.push(whole);
  const socket = sockets[0]!;
  const deliver = (chunk: number, parts: number, ...bytes: number[]): void =>
    socket.deliver(frame({stream: 1, chunk, firstPart: 2, parts, payload: new Uint8Array(bytes)}));
  socket.accept();
  transport.open({...kOpen, credit: 2 * kCreditShare});
  deliver(3, 0, 1, 2);
  deliver(4, 0, 9);
  deliver(3, 0, 3);
  expect(socket.sentOf('credit').map(({bytes}) => bytes)).toEqual([2, 2]);
  deliver(3, 2, 4, 5, 6);
  deliver(4, 1, 8);
  expect(
    frames.map(({chunk, firstPart, parts, payload}) => [chunk, firstPart, parts, ...payload]),
  ).toEqual([
    [3, 2, 2, 1, 2, 3, 4, 5, 6],
    [4, 2, 1, 9, 8],
  ]);
  transport.applied(8);
  expect(socket.sentOf('credit').map(({bytes}) => bytes)).toEqual([2, 2, 4]);
});

test('anotherStreamForgetsThePiecesOfTheOneBefore', () => {
  const frames: Frame[] = [];
  handlers.frame = (whole) => frames.push(whole);
  const piece = {chunk: 3, payload: new Uint8Array([1])};
  sockets[0]!.accept();
  transport.open(kOpen);
  sockets[0]!.deliver(frame({...piece, stream: 1, parts: 0}));
  transport.open(kOpen);
  sockets[0]!.deliver(frame({...piece, stream: 2, parts: 1}));
  expect(frames.map(({payload}) => [...payload])).toEqual([[1]]);
});

test('creditGoesBackInPortionsOfAnEighthOfTheWindow', () => {
  sockets[0]!.accept();
  transport.open(kOpen);
  for (let i = 0; i < 5; ++i) transport.applied(4);
  expect(sockets[0]!.sentOf('credit')).toEqual([{type: 'credit', bytes: 12}]);
});

test('aLostConnectionComesBackLaterEachTimeAndCountsStreamsFromOneAgain', () => {
  sockets[0]!.accept();
  transport.open(kOpen);
  sockets[0]!.lose(1006);
  expect(received.at(-1)).toBe(`down 1 ${reconnectDelayMs(0, 0.5)}`);
  vi.advanceTimersByTime(reconnectDelayMs(0, 0.5) - 1);
  expect(sockets).toHaveLength(1);
  vi.advanceTimersByTime(1);
  expect(sockets).toHaveLength(2);
  sockets[1]!.lose(1006);
  expect(received.at(-1)).toBe(`down 2 ${reconnectDelayMs(1, 0.5)}`);
  vi.advanceTimersByTime(kLongestDelayMs);
  sockets[2]!.accept();
  transport.open(kOpen);
  sockets[2]!.deliver(frame({stream: 1, chunk: 0}));
  expect(received.at(-1)).toBe('chunk 0');
  sockets[2]!.lose(1006);
  expect(received.at(-1)).toBe(`down 1 ${reconnectDelayMs(0, 0.5)}`);
});

test('aServerThatDoesNotUnderstandUsIsNotAskedAgain', () => {
  sockets[0]!.accept();
  sockets[0]!.lose(1008);
  vi.advanceTimersByTime(10 * kLongestDelayMs);
  expect(received).toEqual(['connected', 'failed bad-message']);
  expect(sockets).toHaveLength(1);
});

test('aFrameThatCannotBeReadEndsTheConversation', () => {
  sockets[0]!.accept();
  transport.open(kOpen);
  sockets[0]!.deliver(new ArrayBuffer(3));
  expect(received.at(-1)).toBe('failed bad-message');
  expect(sockets[0]!.closed).toBe(true);
});

test('disconnectEndsTheAttempts', () => {
  sockets[0]!.lose(1006);
  transport.disconnect();
  vi.advanceTimersByTime(10 * kLongestDelayMs);
  expect(sockets).toHaveLength(1);
});

test('delaysDoubleUpToTheLongestAndStayWithinTheirHalf', () => {
  for (let attempt = 0; attempt < 40; ++attempt) {
    const full = Math.min(kLongestDelayMs, kFirstDelayMs * 2 ** attempt);
    expect(reconnectDelayMs(attempt, 0)).toBe(full / 2);
    expect(reconnectDelayMs(attempt, 0.999999)).toBeLessThanOrEqual(full);
  }
});
