import {beforeEach, expect, test} from 'vitest';
import {joinTimeGroup, type Membership, type TimeMember} from '../viewer/page/time_group';

/** Leads when its time changes, as an element's attribute does. */
class FakeViewer implements TimeMember {
  isPlaying = false;
  changes = 0;
  private membership: Membership | null = null;

  constructor(public time: string | null = null) {}

  join(name = 'a', document: object = kDocument): this {
    this.membership = joinTimeGroup(document, name, this);
    return this;
  }
  leave(): void {
    this.membership!.leave();
    this.membership = null;
  }
  take(time: string | null): void {
    if (time === this.time) return;
    ++this.changes;
    this.time = time;
    this.membership?.lead();
  }
  play(): void {
    this.isPlaying = true;
    this.membership!.lead();
  }
  stop(): void {
    this.isPlaying = false;
  }
}

let kDocument: object;
beforeEach(() => {
  kDocument = {};
});

const timesOf = (...viewers: FakeViewer[]): (string | null)[] => viewers.map(({time}) => time);

test('whoIsMovedLeadsAndEachChangesOnce', () => {
  const viewers = [new FakeViewer(), new FakeViewer(), new FakeViewer()].map((its) => its.join());
  viewers[1]!.take('3');
  expect(timesOf(...viewers)).toEqual(['3', '3', '3']);
  viewers[2]!.take('4.5');
  expect(timesOf(...viewers)).toEqual(['4.5', '4.5', '4.5']);
  viewers[1]!.take(null);
  expect(timesOf(...viewers)).toEqual([null, null, null]);
  expect(viewers.map(({changes}) => changes)).toEqual([3, 3, 3]);
});

test('aTimeThatTheGroupDoesNotKnowYetIsTheJoiners', () => {
  const first = new FakeViewer().join();
  expect(timesOf(first, new FakeViewer('5').join())).toEqual(['5', '5']);
});

test('whoJoinsTakesTheTimeOfTheGroupAndGoesOnPlaying', () => {
  const first = new FakeViewer('2').join();
  const second = new FakeViewer('5');
  second.isPlaying = true;
  second.join();
  expect(timesOf(first, second)).toEqual(['2', '2']);
  expect(second.isPlaying).toBe(true);
  first.take('7');
  expect(timesOf(first, second, new FakeViewer().join())).toEqual(['7', '7', '7']);
});

test('theOneThatPlaysLastLeads', () => {
  const [first, second] = [new FakeViewer('1').join(), new FakeViewer().join()];
  first.play();
  expect([first.isPlaying, second.isPlaying]).toEqual([true, false]);
  second.play();
  expect([first.isPlaying, second.isPlaying]).toEqual([false, true]);
  second.take('2');
  expect([first.time, second.isPlaying]).toEqual(['2', true]);
  first.take('6');
  expect([second.time, second.isPlaying]).toEqual(['6', false]);
});

test('whoLeavesIsNoLongerMoved', () => {
  const [first, second] = [new FakeViewer().join(), new FakeViewer().join()];
  second.leave();
  first.take('3');
  second.take('4');
  expect(timesOf(first, second)).toEqual(['3', '4']);
  first.leave();
  expect(new FakeViewer('9').join().time).toBe('9');
});

test('otherNamesAndOtherDocumentsAreOtherGroups', () => {
  const viewers = [
    new FakeViewer().join(),
    new FakeViewer().join('b'),
    new FakeViewer().join('a', {}),
  ];
  viewers[0]!.take('3');
  expect(timesOf(...viewers)).toEqual(['3', null, null]);
});
