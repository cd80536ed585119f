import {describe, expect, test} from 'vitest';
import {extentAlong, planeOf} from '../viewer/settings/clip_plane';
import {axisNormal} from '../core/layers/clip';

const kBounds = [0, 0, 0, 100, 200, 50];

describe('a clip plane in the lattice', () => {
  test('standsAtItsShareOfTheExtentWhicheverSideIsCutAway', () => {
    for (const flipped of [false, true]) {
      const {normal, offset} = planeOf({normal: axisNormal(0, flipped), share: 0.25}, kBounds);
      expect(Math.abs(normal[0] * offset - 25)).toBe(0.5);
    }
    expect(
      Math.abs(planeOf({normal: axisNormal(1, false), share: 0.25}, kBounds).offset + 50),
    ).toBe(0.5);
  });

  test('liesBetweenTwoLatticePlanes', () => {
    for (let i = 0; i <= 10; ++i)
      expect(planeOf({normal: axisNormal(2, false), share: i / 10}, kBounds).offset % 1).toBe(0.5);
  });

  test('acrossAnyDirectionCountsAlongIt', () => {
    expect(extentAlong(kBounds, [0.6, -0.8, 0])).toEqual([-160, 60]);
    expect(planeOf({normal: [0.6, -0.8, 0], share: 0}, kBounds).offset).toBe(-159.5);
    expect(planeOf({normal: [0.6, -0.8, 0], share: 1}, kBounds).offset).toBe(60.5);
  });
});
