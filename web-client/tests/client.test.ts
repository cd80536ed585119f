import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {Client} from '../core/session/client';
import {kPlainDisplay} from '../core/picture/display';
import {Assembler} from '../core/decode/assembler';
import {Publisher} from '../core/session/publisher';
import {Session} from '../core/session/session';
import {SocketTransport} from '../core/transport/socket_transport';
import {kFull} from '../core/protocol/limit';
import type {Posted, ToWorker} from '../core/session/worker_messages';
import {ShownMesh} from '../viewer/page/shown_mesh';
import {Requests} from '../viewer/requests';
import {FakeCodec, FakeSocket, fieldFrame, headFrame, kFakeValues, meshFrame} from './fakes';

vi.mock('qtet-codec.wasm?url', () => ({default: 'codec.wasm'}));
vi.mock('qtet-base.wasm?url', () => ({default: 'base.wasm'}));

class FakeWorker {
  static last: FakeWorker;
  posted: ToWorker[] = [];
  onmessage: ((event: {data: Posted}) => void) | null = null;
  constructor() {
    FakeWorker.last = this;
  }
  postMessage(message: ToWorker): void {
    this.posted.push(message);
  }
  say(message: Posted): void {
    this.onmessage!({data: message});
  }
}

beforeEach(() => void vi.stubGlobal('Worker', FakeWorker));
afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

const state = (run?: number): Posted => ({
  type: 'state',
  state: 'streaming',
  attempt: 0,
  delayMs: 0,
  ...(run !== undefined && {run}),
});

test('whatTheWorkerSaysOfTheMeshBeforeIsNotHeard', () => {
  const received: unknown[] = [];
  const client = new Client((message) => received.push(message));
  const worker = FakeWorker.last;
  client.start({mesh: 'a'});
  client.start({mesh: 'b'});
  const runs = worker.posted.flatMap((message) => (message.type === 'start' ? [message.run] : []));
  worker.say(state(runs[0]));
  expect(received).toEqual([]);
  worker.say(state(runs[1]));
  expect(received).toHaveLength(1);
  worker.say(state()); // a decoder that could not be loaded has no run
  expect(received).toHaveLength(2);
});

test('anAnswerComesWhicheverMeshItWasAskedOf', async () => {
  const client = new Client(() => undefined);
  client.start({mesh: 'a'});
  const digest = client.digest();
  client.start({mesh: 'b'});
  FakeWorker.last.say({type: 'answer', id: 0, answer: 'abc', run: 1});
  expect(await digest).toBe('abc');
});

test('theFirstPictureOfAMeshDoesNotWaitForThatOfTheMeshBefore', () => {
  vi.useFakeTimers();
  const log = {fields: ['p'], chunks: 1};
  const assembler = new Assembler(new FakeCodec(log), kFakeValues);
  let pictures = 0,
    socket = new FakeSocket();
  const publisher = new Publisher(assembler, () => {
    ++pictures;
  });
  const session = new Session(
    assembler,
    publisher,
    () => undefined,
    ({url}, _, handlers) =>
      new SocketTransport(
        url,
        handlers,
        () => (socket = new FakeSocket()),
        () => 0,
      ),
  );
  for (const mesh of ['a', 'b']) {
    session.start({url: 'ws://x', log: '', transport: 'auto', mesh, fields: ['p'], limit: kFull});
    socket.accept();
    socket.deliver(headFrame(1, log));
    socket.deliver(meshFrame(1, 0));
    socket.deliver(fieldFrame(1, 0, 0));
    publisher.show({...kPlainDisplay, color: {field: 0, component: -1}});
    vi.advanceTimersByTime(1000);
  }
  expect(pictures).toBe(2);
});

test('aRequestThatHasNotChangedIsNotSentAgain', () => {
  const requests = new Requests(new Client(() => undefined));
  const sent = (type: string): number =>
    FakeWorker.last.posted.filter((message) => message.type === type).length;
  const mesh = new ShownMesh();
  expect(requests.show(kPlainDisplay, mesh)).toBe(true);
  expect(requests.show({...kPlainDisplay}, mesh)).toBe(false);
  expect(sent('display')).toBe(1);
  expect(requests.show(kPlainDisplay, new ShownMesh())).toBe(true);
});
