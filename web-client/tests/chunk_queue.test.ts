import {expect, test} from 'vitest';
import {ChunkQueue} from '../core/decode/chunk_queue';

function drained(queue: ChunkQueue): number[] {
  const order: number[] = [];
  for (; queue.first >= 0; queue.removeFirst()) order.push(queue.first);
  return order;
}

/** 0 to 99, each once, in an order without a pattern. */
const kShuffled = Array.from({length: 100}, (_, i) => (37 * i) % 100);

test('givesTheSmallestRankFirstAndEachChunkOnce', () => {
  const queue = new ChunkQueue((chunk) => chunk);
  for (const chunk of [...kShuffled, ...kShuffled]) queue.add(chunk);
  expect(drained(queue)).toEqual(Array.from({length: 100}, (_, i) => i));
});

test('followsRanksThatHaveChanged', () => {
  let sign = 1;
  const queue = new ChunkQueue((chunk) => sign * chunk);
  kShuffled.forEach((chunk) => queue.add(chunk));
  sign = -1;
  queue.reorder();
  expect(drained(queue)).toEqual(Array.from({length: 100}, (_, i) => 99 - i));
});

test('takesAChunkAgainThatHasBeenRemoved', () => {
  const queue = new ChunkQueue((chunk) => chunk);
  queue.add(5);
  queue.removeFirst();
  expect(queue.first).toBe(-1);
  queue.add(5);
  expect(queue.first).toBe(5);
  queue.clear();
  queue.add(5);
  expect(drained(queue)).toEqual([5]);
});
