import {afterEach, beforeEach, describe, expect, test, vi} from 'vitest';
import type {Assembler} from '../core/decode/assembler';
import {kPlainDisplay, type Display} from '../core/picture/display';
import type {ArrowsRequest} from '../core/picture/arrows';
import type {FieldInfo} from '../core/protocol/fields';
import {markSeries} from '../core/protocol/series';
import {Publisher} from '../core/session/publisher';
import {kNoStatistics} from '../core/decode/statistics';
import type {Snapshot} from '../core/session/worker_messages';
import {FakeCodec} from './fakes';

let bytes: number;
let pictures: Snapshot[];
let publisher: Publisher;

/** A mesh whose bytes the test sets. Its first picture has been sent and shown at once. */
beforeEach(() => {
  vi.useFakeTimers();
  bytes = 1000;
  pictures = [];
  const codec = new FakeCodec({fields: [], chunks: 1});
  codec.chunksApplied = 1;
  const assembler = {codec, manifest: {fields: []}, statistics: () => ({...kNoStatistics, bytes})};
  publisher = new Publisher(
    assembler as unknown as Assembler,
    (snapshot) => void pictures.push(snapshot),
  );
  publisher.show(kPlainDisplay);
  grow(1000);
  vi.advanceTimersByTime(1);
  publisher.shown();
});
afterEach(() => void vi.useRealTimers());

function grow(to: number, isLast = false): void {
  bytes = to;
  publisher.changed(isLast);
}

/** Milliseconds until the next picture. */
function untilNext(maxMs = 10000): number {
  const before = pictures.length;
  for (let ms = 0; ms <= maxMs; ++ms) {
    if (pictures.length > before) return ms;
    vi.advanceTimersByTime(1);
  }
  return Infinity;
}

test('aMeshThatGrowsFastIsShownTenTimesASecond', () => {
  for (let i = 1; i <= 3; ++i) {
    grow(1000 * 2 ** i);
    const ms = untilNext();
    expect(ms).toBeGreaterThan(80);
    expect(ms).toBeLessThanOrEqual(101);
    publisher.shown();
  }
});

test('aPictureThatTookLongOnItsWayIsFollowedByALongerPause', () => {
  grow(2000);
  untilNext();
  vi.advanceTimersByTime(60);
  grow(4000);
  expect(untilNext(100)).toBe(Infinity); // the previous one is not yet on the screen
  publisher.shown();
  expect(untilNext()).toBeGreaterThan(500);
});

test('whatTheUserChangesComesAtOnceAllTheSame', () => {
  grow(2000);
  untilNext();
  vi.advanceTimersByTime(100);
  publisher.shown();
  publisher.show({...kPlainDisplay, planes: [{normal: [1, 0, 0], offset: 3}]});
  expect(untilNext()).toBeLessThan(12);
});

test('aPageThatWasOutOfSightWaitsNoLongerThanASecond', () => {
  grow(2000);
  untilNext();
  vi.advanceTimersByTime(600000);
  grow(4000);
  publisher.shown();
  expect(untilNext()).toBeLessThanOrEqual(1001);
});

test('aMeshThatHasHardlyGrownWaitsForMoreButNotForEver', () => {
  grow(1050);
  vi.advanceTimersByTime(200);
  expect(pictures).toHaveLength(1);
  grow(1110);
  expect(untilNext()).toBeLessThanOrEqual(1);
  publisher.shown();
  grow(1120);
  expect(untilNext()).toBeLessThanOrEqual(501);
});

/** Shows a picture of `to` bytes that takes `ms` to the screen. */
function shownAfter(ms: number, to: number): void {
  grow(to);
  untilNext();
  vi.advanceTimersByTime(ms);
  publisher.shown();
}

test('wherePicturesAreDearTheMeshHasToDouble', () => {
  shownAfter(150, 2000);
  vi.advanceTimersByTime(2000);
  grow(3900);
  vi.advanceTimersByTime(400);
  expect(pictures).toHaveLength(2);
  grow(4000);
  expect(untilNext()).toBeLessThanOrEqual(1);
});

test('aPictureThatWouldHardlyBeSeenBeforeTheLastOneIsLeftOut', () => {
  shownAfter(150, 2000);
  vi.advanceTimersByTime(2000);
  let end = performance.now() + 310;
  publisher.pace.untilLast = () => Math.max(0, end - performance.now());
  grow(5000);
  expect(untilNext()).toBeLessThanOrEqual(1); // it will be seen for as long as it takes
  publisher.shown();
  shownAfter(150, 10000);
  vi.advanceTimersByTime(2000);
  end = performance.now() + 290;
  grow(30000);
  vi.advanceTimersByTime(100);
  grow(50000);
  vi.advanceTimersByTime(100);
  expect(pictures).toHaveLength(4);
  grow(60000, true);
  expect(untilNext()).toBeLessThanOrEqual(1);
});

test('whatDrawingTookTellsOfTheFirstPictureWhichWaitedForTheGraphics', () => {
  publisher.reset();
  publisher.show(kPlainDisplay);
  grow(1000);
  untilNext();
  vi.advanceTimersByTime(900);
  publisher.shown(20);
  publisher.pace.untilLast = () => 50;
  vi.advanceTimersByTime(4000);
  grow(2000);
  expect(untilNext()).toBeLessThanOrEqual(1);
});

test('theLastPictureComesAtOnce', () => {
  grow(1001, true);
  expect(untilNext()).toBeLessThanOrEqual(1);
});

test('aPictureThatIsLostComesAgainWholeWithoutWaitingForTheLostOne', () => {
  grow(2000);
  untilNext();
  publisher.repeat();
  expect(untilNext()).toBeLessThanOrEqual(1);
  expect(pictures.at(-1)!.surface).toBeDefined();
});

test('creasesComeWithAPictureOfTheirOwn', () => {
  publisher.useCreases(() => Uint8Array.of(1, 1, 1));
  expect(untilNext()).toBeLessThanOrEqual(501);
  expect(pictures.map(({surface}) => surface?.creases?.join())).toEqual([undefined, '1,1,1']);
});

test('fieldsAheadMakeNoOtherPicture', () => {
  publisher.show({...kPlainDisplay, ahead: [1, 2]});
  expect(untilNext()).toBe(Infinity);
});

test('aWishComesWithoutPauseWhereNothingIsLeftToDecode', () => {
  publisher.pace.untilLast = () => 0;
  publisher.show({...kPlainDisplay, planes: [{normal: [1, 0, 0], offset: 3}]});
  expect(untilNext()).toBeLessThanOrEqual(1);
});

describe('a series', () => {
  let codec: FakeCodec;
  let received: number;
  const display = (field: number): Display => ({
    ...kPlainDisplay,
    color: {field, component: -1},
  });

  /** Two instants and a lone field. The first instant is decoded and shown. */
  beforeEach(() => {
    const names = ['T@0', 'T@1', 'p'];
    const fields = names.map((name): FieldInfo => ({
      ...{name, components: 1, association: 'point', step: 1, minimum: [0], range: [0, 8]},
    }));
    markSeries(fields);
    codec = new FakeCodec({fields: names, chunks: 1});
    codec.open();
    codec.chunksApplied = 1;
    codec.applyField(0, 0);
    received = 1;
    const assembler = {
      ...{codec, manifest: {fields}, statistics: () => kNoStatistics},
      receivedOfField: () => received,
    };
    publisher = new Publisher(
      assembler as unknown as Assembler,
      (snapshot) => void pictures.push(snapshot),
    );
    publisher.show(display(0));
    untilNext();
    publisher.shown();
  });

  const shown = (): (number | undefined)[] => pictures.slice(1).map(({color}) => color?.field);

  test('anInstantWithoutValuesLeavesTheLastOneOnTheScreen', () => {
    publisher.show(display(1));
    expect(untilNext()).toBe(Infinity);
    codec.applyField(1, 0);
    publisher.changed(true);
    expect(untilNext()).toBeLessThanOrEqual(1);
    expect(shown()).toEqual([0, 1]);
  });

  test('theFieldsThatAnInstantIsPredictedFromMakeNoPicture', () => {
    publisher.show(display(1));
    codec.applyField(2, 0);
    publisher.changed();
    expect(untilNext()).toBe(Infinity);
    publisher.repeat();
    expect(untilNext()).toBeLessThanOrEqual(1);
    expect(shown()).toEqual([0, 0]);
  });

  test('aFinerMeshIsShownWhileAnInstantHasNoValues', () => {
    publisher.show(display(1));
    codec.chunksApplied = 2;
    publisher.changed(true);
    expect(untilNext()).toBeLessThanOrEqual(1);
  });

  test('aPartOfAnInstantIsShownOnceNoMoreOfItIsHere', () => {
    codec.chunksApplied = 2;
    publisher.changed(true);
    untilNext();
    publisher.shown();
    publisher.show(display(1));
    codec.applyField(1, 0);
    received = 2;
    publisher.changed(true);
    expect(untilNext()).toBe(Infinity);
    received = 1;
    publisher.changed(true);
    expect(untilNext()).toBeLessThanOrEqual(1);
    expect(shown()).toEqual([0, 0, 1]);
  });

  test('backFromAnInstantThatHasComeTheFirstIsDrawnAnew', () => {
    publisher.show(display(1));
    codec.applyField(1, 0);
    publisher.changed(true);
    untilNext();
    publisher.shown();
    publisher.show(display(0));
    untilNext();
    expect(shown()).toEqual([0, 1, 0]);
  });

  test('aCutThroughAnInstantWithoutValuesShowsTheLastOne', () => {
    publisher.show({...display(1), planes: [{normal: [1, 0, 0], offset: 3}]});
    untilNext();
    expect(shown()).toEqual([0, 0]);
    expect(pictures.at(-1)!.planes).toHaveLength(1);
  });

  test('aFieldOfNoSeriesIsNoStandIn', () => {
    publisher.show(display(2));
    untilNext();
    expect(shown()).toEqual([0, undefined]);
  });

  test('instantsShareTheCreasesOfTheirSurface', () => {
    let calls = 0;
    publisher.useCreases(() => {
      ++calls;
      return Uint8Array.of(1, 1, 1);
    });
    untilNext();
    publisher.shown();
    codec.applyField(1, 0);
    publisher.show(display(1));
    untilNext();
    const creases = pictures.slice(-2).map(({surface}) => surface!.creases!);
    expect([calls, creases.map(String)]).toEqual([1, ['1,1,1', '1,1,1']]);
    expect(creases[0]).not.toBe(creases[1]);
  });
});

test('aComponentOfASeriesHasOneRangeForAllInstants', () => {
  const fields = ['V@0', 'V@1'].map((name, instant): FieldInfo => ({
    name,
    components: 2,
    association: 'point',
    step: 1,
    bits: 3,
    minimum: [-instant, 0],
    range: [0, 8],
  }));
  markSeries(fields);
  const codec = new FakeCodec({fields: ['V@0', 'V@1'], chunks: 1});
  codec.open();
  codec.chunksApplied = 1;
  for (const field of [0, 1]) codec.applyField(field, 0);
  const assembler = {codec, manifest: {fields}, statistics: () => kNoStatistics};
  publisher = new Publisher(
    assembler as unknown as Assembler,
    (snapshot) => void pictures.push(snapshot),
  );
  for (const field of [0, 1]) {
    publisher.show({...kPlainDisplay, color: {field, component: 0}});
    publisher.changed(true);
    untilNext();
    publisher.shown();
    expect(pictures.at(-1)).toMatchObject({
      scaleRange: [-8, 8],
      extent: [7 / 16, 15 / 16],
      middle: [7 / 16, 15 / 16],
    });
  }
});

test('colourWarpAndArrowsOfTwoSeriesChangeTogether', () => {
  const names = ['T@0', 'T@1', 'u@0', 'u@1'];
  const fields = names.map((name, field): FieldInfo => {
    const components = field < 2 ? 1 : 3;
    const minimum = Array<number>(components).fill(0);
    return {name, components, association: 'point', step: 1, bits: 3, minimum, range: [0, 8]};
  });
  markSeries(fields);
  const codec = new FakeCodec({fields: names, chunks: 1});
  codec.open();
  codec.chunksApplied = 1;
  const assembler = {
    codec,
    manifest: {fields, lattice: {step: 1}},
    statistics: () => kNoStatistics,
    receivedOfField: () => 1,
  };
  publisher = new Publisher(
    assembler as unknown as Assembler,
    (snapshot) => void pictures.push(snapshot),
  );
  const seen = (): (number | undefined)[] => {
    publisher.changed(true);
    untilNext(1500);
    publisher.shown();
    const {color, warp} = pictures.at(-1)!;
    return [color?.field, warp?.field, warp?.scale];
  };
  const show = (instant: number, scale: number): void =>
    publisher.show({
      ...kPlainDisplay,
      color: {field: instant, component: -1},
      warp: {field: 2 + instant, scale},
      arrows: {field: 2 + instant} as unknown as ArrowsRequest,
    });
  show(0, 5);
  codec.applyField(0, 0);
  expect(seen()).toEqual([0, undefined, undefined]);
  codec.applyField(2, 0);
  expect(seen()).toEqual([0, 2, 5]);
  show(1, 6);
  codec.applyField(1, 0);
  expect([seen(), publisher.now.warp]).toEqual([[0, 2, 6], {field: 2, scale: 6}]);
  expect(publisher.now.arrows?.field).toBe(2);
  codec.applyField(3, 0);
  expect(seen()).toEqual([1, 3, 6]);
  expect(publisher.now.arrows?.field).toBe(3);
});

describe('theEdgesAtRest', () => {
  const kUp: FieldInfo = {
    name: 'u',
    components: 3,
    association: 'point',
    step: 1,
    bits: 3,
    minimum: [0, 0, 0],
    range: [0, 8],
  };
  /** A line for each of the triangle's sides that comes from its lower end. */
  const kLines = 2;
  let codec: FakeCodec;

  beforeEach(() => {
    codec = new FakeCodec({fields: ['u'], chunks: 1});
    codec.open();
    codec.chunksApplied = 1;
    vi.spyOn(codec, 'points').mockReturnValue(Int32Array.of(0, 0, 0, 10, 0, 0, 0, 10, 0));
    vi.spyOn(codec, 'boundary').mockReturnValue(Uint32Array.of(0, 1, 2));
    const manifest = {fields: [kUp], lattice: {step: 1}};
    const assembler = {codec, manifest, statistics: () => kNoStatistics};
    publisher = new Publisher(
      assembler as unknown as Assembler,
      (snapshot) => void pictures.push(snapshot),
    );
    publisher.useCreases(() => Uint8Array.of(7, 7, 7));
  });

  /** The count of the lines; undefined: none are drawn. */
  function linesOf(change: Partial<Display>): number | undefined {
    publisher.show({...kPlainDisplay, warp: {field: 0, scale: 5}, restEdges: true, ...change});
    untilNext(1500);
    publisher.shown();
    const lines = pictures.at(-1)!.warp?.restEdges;
    return lines && lines.length / 6;
  }

  test('areDrawnOnlyWhileAWarpMovesTheMesh', () => {
    expect(linesOf({})).toBeUndefined(); // the vectors are not here yet
    codec.applyField(0, 0);
    publisher.changed(true);
    expect(linesOf({})).toBe(kLines);
    expect(linesOf({restEdges: false})).toBeUndefined();
    expect(linesOf({warp: null})).toBeUndefined();
  });

  test('endAtPlanesAndStayWholeRoundSlices', () => {
    codec.applyField(0, 0);
    expect(linesOf({})).toBe(kLines);
    const planes = [{normal: [1, 0, 0] as [number, number, number], offset: -1e6}];
    expect([linesOf({planes}), linesOf({planes, mode: 'cells'})]).toEqual([0, 0]);
    expect(linesOf({planes, mode: 'slice'})).toBe(kLines);
  });
});
