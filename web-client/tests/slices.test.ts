import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {Slices} from '../core/session/slices';

/** Messages under way. A real channel needs a few tasks, and nobody knows how many. */
let queue: (() => void)[];

class FakeChannel {
  readonly port1 = {onmessage: (): void => undefined};
  readonly port2 = {postMessage: (): void => void queue.push(() => this.port1.onmessage())};
}

function deliverAll(): void {
  for (let next = queue.shift(); next; next = queue.shift()) next();
}

beforeEach(() => {
  queue = [];
  vi.stubGlobal('MessageChannel', FakeChannel);
});
afterEach(() => void vi.unstubAllGlobals());

test('aSliceRunsOnceHoweverOftenItIsCalledAndBehindWhatIsQueued', () => {
  const run = vi.fn();
  const slices = new Slices(run);
  slices.call();
  slices.call();
  expect([slices.isDue, run.mock.calls.length]).toEqual([true, 0]);
  deliverAll();
  expect([slices.isDue, run.mock.calls.length]).toEqual([false, 1]);
});

test('aSliceThatWasDroppedDoesNotRunUnlessItIsCalledAgain', () => {
  const run = vi.fn();
  const slices = new Slices(run);
  slices.call();
  slices.drop();
  deliverAll();
  expect(run).not.toHaveBeenCalled();
  slices.call();
  slices.drop();
  slices.call(); // the message of the dropped one is still under way
  deliverAll();
  expect(run).toHaveBeenCalledTimes(1);
});

test('aSliceMayCallTheNextOne', () => {
  let left = 3;
  const slices: Slices = new Slices(() => {
    if (--left > 0) slices.call();
  });
  slices.call();
  deliverAll();
  expect(left).toBe(0);
});
