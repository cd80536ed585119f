import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {openView} from '../webgl/worker_view';
import type {Pose} from '../webgl/pose';
import type {View, ViewListeners} from '../webgl/view';
import type {FromView, ToView} from '../webgl/view_messages';

/** The worker that draws; the test speaks for it. */
class FakeWorker {
  static last: FakeWorker;
  posted: ToView[] = [];
  terminated = false;
  onmessage: ((event: {data: FromView}) => void) | null = null;
  onerror: ((event: {message: string}) => void) | null = null;
  constructor() {
    FakeWorker.last = this;
    queueMicrotask(() => this.say({type: 'hello', url: '', draws: true}));
  }
  postMessage(message: ToView): void {
    this.posted.push(message);
    const begun = {type: 'begun', pose: {} as Pose, renderer: 'a card'} as const;
    if (message.type === 'begin') queueMicrotask(() => this.say(begun));
  }
  say(message: FromView): void {
    this.onmessage!({data: message});
  }
  terminate(): void {
    this.terminated = true;
  }
}

let queries: {text: string; target: EventTarget}[] = [];

beforeEach(() => {
  queries = [];
  vi.stubGlobal('Worker', FakeWorker);
  vi.stubGlobal('window', {devicePixelRatio: 1});
  vi.stubGlobal('matchMedia', (text: string) => {
    const target = new EventTarget();
    queries.push({text, target});
    return target;
  });
  vi.stubGlobal('document', new EventTarget());
  vi.stubGlobal(
    'ResizeObserver',
    class {
      observe(): void {
        return;
      }
      disconnect(): void {
        return;
      }
    },
  );
});
afterEach(() => void vi.unstubAllGlobals());

function open(listeners: ViewListeners = {}): Promise<View> {
  const canvas = Object.assign(new EventTarget(), {
    style: {},
    clientWidth: 90,
    clientHeight: 60,
    transferControlToOffscreen: () => ({}),
  });
  return openView(canvas as unknown as HTMLCanvasElement, listeners);
}

test('anErrorWhileDrawingIsToldAndTheWorkerGoesOn', async () => {
  const reported: string[] = [];
  const view = await open({failed: (message) => reported.push(message)});
  FakeWorker.last.onerror!({message: 'too much'});
  expect([reported, FakeWorker.last.terminated]).toEqual([['too much'], false]);
  view.dispose();
});

test('aPictureThatCannotBeTakenIsRefused', async () => {
  const view = await open();
  const picture = view.picture('#fff');
  const asked = FakeWorker.last.posted.find((message) => message.type === 'picture')!;
  FakeWorker.last.say({type: 'failed', id: asked.id, message: 'no memory'});
  await expect(picture).rejects.toThrow('no memory');
});

test('aPictureThatIsUnderWayWhenTheViewEndsIsRefused', async () => {
  const view = await open();
  const picture = view.picture('#fff');
  view.dispose();
  await expect(picture).rejects.toThrow('the graphics have ended');
});

test('aViewOrCameraThatThereIsNotIsRefusedBeforeItIsSent', async () => {
  const view = await open();
  const sent = FakeWorker.last.posted.length;
  expect(() => view.look('left' as never)).toThrow(/no view from "left".*\+x/);
  for (const state of [[1, 2, 3], [1, 2, 3, 4, 5, NaN], '1,2,3,4,5,6'])
    expect(() => (view.cameraState = state as never)).toThrow(/six finite numbers/);
  expect(FakeWorker.last.posted).toHaveLength(sent);
  view.look('-z');
  view.cameraState = [1, 2, 3, 4, 5, 6];
  expect(FakeWorker.last.posted).toHaveLength(sent + 2);
});

test('anotherScreensDensityIsToldEveryTime', async () => {
  const view = await open();
  for (const density of [2, 1.5]) {
    vi.stubGlobal('window', {devicePixelRatio: density});
    queries.at(-1)!.target.dispatchEvent(new Event('change'));
    expect(queries.at(-1)!.text).toBe(`(resolution: ${density}dppx)`);
    expect(FakeWorker.last.posted.at(-1)).toMatchObject({
      type: 'size',
      size: {pixelRatio: density},
    });
  }
  view.dispose();
  const sent = FakeWorker.last.posted.length;
  queries.at(-1)!.target.dispatchEvent(new Event('change'));
  expect(FakeWorker.last.posted).toHaveLength(sent);
});

test('aWorkerThatDoesNotAnswerIsToldOfUntilItDoes', async () => {
  vi.useFakeTimers();
  const reported: boolean[] = [];
  const view = await open({silent: (silent) => reported.push(silent)});
  vi.advanceTimersByTime(29000);
  FakeWorker.last.say({type: 'pong'});
  vi.advanceTimersByTime(30000);
  expect(reported).toEqual([]);
  vi.advanceTimersByTime(10000);
  expect(reported).toEqual([true]);
  FakeWorker.last.say({type: 'lost', lost: false});
  expect(reported).toEqual([true, false]);
  Object.assign(document, {hidden: true}); // browsers stop workers of pages that nobody sees
  vi.advanceTimersByTime(600000);
  expect(reported).toEqual([true, false]);
  view.dispose();
  Object.assign(document, {hidden: false});
  vi.advanceTimersByTime(600000);
  expect(reported).toEqual([true, false]);
  vi.useRealTimers();
});
