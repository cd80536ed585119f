import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {TimeClock} from '../viewer/panels/time_clock';

/** Ten instants of one segment; those of `here` are decoded. */
let here: readonly number[];
let onScreen: number;
let clock: TimeClock;
let hasEnded: boolean;
const kAll = Array.from({length: 10}, (_, i) => i);

beforeEach(() => {
  vi.useFakeTimers();
  here = kAll;
  onScreen = 0;
  const line = {
    times: kAll.map((time) => ({time, text: String(time)})),
    isHere: (at: number) => here.includes(at % 10),
    isOnScreen: (at: number) => at === onScreen,
    awaitsFrame: false,
    isOpening: false,
    areTogether: () => true,
  };
  hasEnded = false;
  clock = new TimeClock(
    line,
    () => undefined,
    () => {
      hasEnded = true;
      clock.stop();
    },
  );
  clock.play();
});
afterEach(() => {
  clock.stop();
  vi.useRealTimers();
});

/** A picture of the asked instant comes. */
function drawn(): void {
  onScreen = clock.at;
  clock.tick();
}

test.each([
  [1, 5],
  [0.5, 2],
])('tenInstantsASecondPassAtTheFirstSpeed', (speed, at) => {
  clock.speed = speed;
  clock.play();
  for (let ms = 0; ms < 500; ms += 25) {
    vi.advanceTimersByTime(25);
    drawn();
  }
  expect(clock.at).toBe(at);
});

test('instantsWhoseTimePassesWhileOneIsDrawnAreLeftOut', () => {
  vi.advanceTimersByTime(100);
  expect(clock.at).toBe(1);
  vi.advanceTimersByTime(320);
  expect(clock.at).toBe(1);
  drawn();
  expect(clock.at).toBe(4);
});

test('onlyInstantsThatAreHereAreGoneTo', () => {
  here = [0, 1, 3];
  vi.advanceTimersByTime(100);
  vi.advanceTimersByTime(320);
  drawn();
  expect(clock.at).toBe(3);
});

test('theClockStandsWhileAnInstantIsNotHere', () => {
  here = [0];
  vi.advanceTimersByTime(700);
  expect([clock.at, clock.isLate]).toEqual([1, true]);
  here = kAll;
  drawn();
  expect([clock.at, clock.isLate]).toEqual([2, false]);
});

test('anInstantThatIsLateForASecondIsPassedOver', () => {
  here = [0, 4];
  vi.advanceTimersByTime(1050);
  expect(clock.at).toBe(1);
  vi.advanceTimersByTime(100);
  expect(clock.at).toBe(4);
});

/** The instants that are drawn in so many steps. */
function played(steps: number): number[] {
  return Array.from({length: steps}, () => {
    vi.advanceTimersByTime(100);
    drawn();
    return clock.at;
  });
}

test('aPartIsPlayedRoundAndRound', () => {
  clock.part = [3, 5];
  clock.play();
  drawn();
  expect(clock.at).toBe(3);
  expect(played(5)).toEqual([4, 5, 3, 4, 5]);
});

test('anInstantOutsideThePartIsFollowedByItsFirstOne', () => {
  clock.part = [3, 5];
  clock.show(8);
  drawn();
  expect(played(2)).toEqual([3, 4]);
});

test('playingOnceEndsWithTheLastInstantOfThePart', () => {
  clock.loops = false;
  clock.part = [7, 8];
  clock.play();
  drawn();
  expect(played(3)).toEqual([8, 8, 8]);
  expect([hasEnded, clock.isPlaying]).toEqual([true, false]);
  clock.play(); // from its beginning
  expect(clock.at).toBe(7);
});

test('slowPicturesDoNotPassOverTheEnd', () => {
  clock.loops = false;
  clock.part = [0, 2];
  clock.play();
  vi.advanceTimersByTime(1000);
  drawn();
  expect([clock.at, hasEnded]).toEqual([2, false]);
});
