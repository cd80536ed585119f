import {expect, test} from 'vitest';
import {FrameBudget, kMovingMs} from '../webgl/frame_budget';

function stepAfter(ms: number, everyMs = 100): number {
  const budget = new FrameBudget();
  budget.learn(1, ms);
  return budget.steadyShare(everyMs);
}

test('picturesThatAreFastEnoughKeepAllPixels', () => {
  expect(stepAfter(kMovingMs)).toBe(1);
});

test('slowerPicturesHaveTheNextSmallerOfFewShares', () => {
  expect(stepAfter(kMovingMs + 1)).toBe(0.7);
  expect(stepAfter(kMovingMs / 0.49 - 1)).toBe(0.7);
  expect(stepAfter(kMovingMs / 0.49 + 1)).toBe(0.5);
});

test('picturesThatFollowSoonerHaveFewerPixels', () => {
  expect(stepAfter(kMovingMs, 25)).toBe(0.5);
  expect(stepAfter(25, 25)).toBe(1);
  expect(stepAfter(26, 25)).toBe(0.7);
});

test('theLeastShareStillShowsASurface', () => {
  expect(stepAfter(100 * kMovingMs)).toBe(0.35);
});
