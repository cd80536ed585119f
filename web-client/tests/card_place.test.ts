// The place of a card that opens.

import {expect, test} from 'vitest';
import {placeCard, type Point, type Surroundings} from '../viewer/page/card_place';

const around = (more: Partial<Surroundings>): Surroundings => ({
  width: 1280,
  height: 800,
  cards: [{left: 968, top: 20, right: 1260, bottom: 780}],
  picked: [{x: 500, y: 400}],
  mesh: [],
  ...more,
});
const boxAt = ({x, y}: Point): [number, number, number, number] => [x, y, x + 330, y + 250];

test('opensBesideThePointer', () => {
  const [left, top, right, bottom] = boxAt(placeCard(330, 250, around({})));
  const far = Math.hypot(
    Math.max(left - 500, 500 - right, 0),
    Math.max(top - 400, 400 - bottom, 0),
  );
  expect(far).toBeGreaterThanOrEqual(14);
  expect(far).toBeLessThan(48);
});

test('opensWhereTheMeshIsNot', () => {
  const mesh = [
    {x: 400, y: 100},
    {x: 940, y: 100},
    {x: 940, y: 700},
    {x: 400, y: 700},
    {x: 600, y: 300}, // inside
  ];
  const [, , right] = boxAt(placeCard(330, 250, around({mesh})));
  expect(right).toBeLessThan(400 + 330 / 6);
});

test('neverCoversAPickedPointNorTheOtherCards', () => {
  for (let x = 0; x <= 960; x += 96)
    for (let y = 0; y <= 800; y += 100) {
      const picked = [
        {x: 960 - x, y: 800 - y},
        {x, y},
      ];
      const [left, top, right, bottom] = boxAt(placeCard(330, 250, around({picked})));
      expect(left >= 0 && top >= 0 && right <= 968 && bottom <= 800).toBe(true);
      for (const at of picked)
        expect(at.x > left && at.x < right && at.y > top && at.y < bottom).toBe(false);
    }
});

test('onAPhoneItCoversThePanelRatherThanThePoint', () => {
  const phone = around({
    width: 390,
    height: 700,
    cards: [{left: 0, top: 300, right: 390, bottom: 700}],
    picked: [{x: 195, y: 150}],
  });
  expect(placeCard(358, 200, phone).y).toBeGreaterThan(150);
});
