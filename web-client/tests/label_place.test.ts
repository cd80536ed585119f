import {expect, test} from 'vitest';
import {overlap, type Box} from '../viewer/page/card_place';
import {placeLabels, type LabelledDot, type LabelPlace} from '../viewer/page/label_place';

const kPhone = {width: 390, height: 844};
const dot = (x: number, y: number, last = 0): LabelledDot => ({x, y, width: 60, height: 24, last});

function boxOf({x, y, width, height}: LabelledDot, place: LabelPlace): Box {
  const [left, top] = [x + place.x, y + place.y];
  return {left, top, right: left + width, bottom: top + height};
}

test('aLabelStandsRightOfItsDot', () => {
  expect(placeLabels([dot(100, 100)], kPhone)).toEqual([{x: 10, y: -12, choice: 0}]);
});

test('aLabelThatWouldLeaveTheViewerStandsOnTheOtherSide', () => {
  expect(placeLabels([dot(350, 100)], kPhone)).toEqual([{x: -70, y: -12, choice: 1}]);
});

test('aLabelStaysWhereItWasWhileThatIsFree', () => {
  expect(placeLabels([dot(200, 100, 1)], kPhone)[0]!.choice).toBe(1);
  expect(placeLabels([dot(40, 100, 1)], kPhone)[0]!.choice).toBe(0);
});

test('theLabelOfADotOutsideIsFoldedAndTakesNoRoom', () => {
  const places = placeLabels([dot(-1, 200), dot(20, 200)], kPhone);
  expect(places.map((place) => place?.choice)).toEqual([undefined, 0]);
});

test('labelsOfCloseDotsCoverNeitherEachOtherNorADot', () => {
  for (let seed = 1; seed <= 200; ++seed) {
    let state = seed;
    const next = (): number => (state = (state * 48271) % 2147483647) / 2147483647;
    const dots = Array.from({length: 8}, () => dot(150 + 60 * next(), 400 + 60 * next()));
    const places = placeLabels(dots, kPhone);
    expect(places[0]).not.toBeNull();
    const boxes = places.flatMap((place, i) => (place ? [boxOf(dots[i]!, place)] : []));
    boxes.forEach((box, i) => {
      expect(boxes.some((other, k) => k > i && overlap(box, other))).toBe(false);
      expect(box.left >= 0 && box.top >= 0 && box.right <= 390 && box.bottom <= 844).toBe(true);
    });
    places.forEach((place, i) => {
      if (!place) return;
      const box = boxOf(dots[i]!, place);
      for (const [k, {x, y}] of dots.entries())
        if (k !== i) expect(overlap(box, {left: x, top: y, right: x, bottom: y})).toBe(false);
    });
  }
});

test('aLabelWithoutRoomIsFolded', () => {
  const places = placeLabels([dot(30, 12), dot(30, 12)], {width: 100, height: 24});
  expect(places).toEqual([{x: 10, y: -12, choice: 0}, null]);
});
