import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {kLongestDelayMs} from '../core/transport/backoff';
import {errorText} from '../core/protocol/errors';
import {kMaxAttempts, retry} from '../core/transport/retry';

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

test('whatFailsForAWhileSucceedsInTheEnd', async () => {
  let calls = 0;
  const result = retry(async () => {
    if (++calls < 4) throw new Error('no network');
    return calls;
  });
  await vi.advanceTimersByTimeAsync(4 * kLongestDelayMs);
  expect(await result).toBe(4);
});

test('whatNeverSucceedsFailsWithItsLastError', async () => {
  let calls = 0;
  const result = retry(() => Promise.reject(new Error(`call ${++calls}`)));
  const caught = result.catch((thrown: unknown) => errorText(thrown));
  await vi.advanceTimersByTimeAsync(kMaxAttempts * kLongestDelayMs);
  expect(await caught).toBe(`call ${kMaxAttempts}`);
});
