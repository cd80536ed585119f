import {expect, test} from 'vitest';
import {section} from '../core/picture/section';

/**
 * The crossing is halfway between two 32-bit floats, so that the last bit of a 64-bit float
 * decides.
 */
const kFar = 46137355;
const kAbove = 5;
const kBelow = -6;

/** The x of the corners that lie on the x axis. */
function onTheAxis(positions: Float32Array): number[] {
  return [...positions].filter((_, i) => i % 3 === 0 && !positions[i + 1] && !positions[i + 2]);
}

test('cellsThatShareAnEdgeCrossItAtTheSameFloatsWhicheverEndTheyTakeFirst', () => {
  const points = Int32Array.from([
    ...[0, 0, 0, kFar, 0, 0], // the edge
    ...[0, 9, 0, 0, 0, 9], // below, with its far end
    ...[0, -9, 0, 0, 0, -9], // above, with its near end
  ]);
  const distances = Float64Array.of(kAbove, kBelow, kBelow, kBelow, kAbove, kAbove);
  const crossing = (tetrahedra: number[]): number[] =>
    onTheAxis(
      section({points, tetrahedra: Uint32Array.from(tetrahedra)}, distances, null).positions,
    );
  const [fromNear] = crossing([0, 1, 2, 3]);
  const [fromFar] = crossing([0, 1, 4, 5]);
  expect(fromNear).toBeCloseTo((kFar * kAbove) / (kAbove - kBelow), -1);
  expect(fromFar).toBe(fromNear);
});
