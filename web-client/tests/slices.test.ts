import {expect, test, vi} from 'vitest';
import {Slices} from '../core/session/slices';

/** Messages between channels take a few tasks. */
async function rest(): Promise<void> {
  await new Promise((resolve) => setTimeout(resolve, 20));
}

test('aSliceRunsOnceHoweverOftenItIsCalledAndBehindWhatIsQueued', async () => {
  const run = vi.fn();
  const slices = new Slices(run);
  slices.call();
  slices.call();
  expect([slices.isDue, run.mock.calls.length]).toEqual([true, 0]);
  await rest();
  expect([slices.isDue, run.mock.calls.length]).toEqual([false, 1]);
});

test('aSliceThatWasDroppedDoesNotRunUnlessItIsCalledAgain', async () => {
  const run = vi.fn();
  const slices = new Slices(run);
  slices.call();
  slices.drop();
  await rest();
  expect(run).not.toHaveBeenCalled();
  slices.call();
  slices.drop();
  slices.call(); // the message of the dropped one is still under way
  await rest();
  expect(run).toHaveBeenCalledTimes(1);
});

test('aSliceMayCallTheNextOne', async () => {
  let left = 3;
  const slices: Slices = new Slices(() => {
    if (--left > 0) slices.call();
  });
  slices.call();
  await rest();
  expect(left).toBe(0);
});
