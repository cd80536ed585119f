import {describe, expect, test} from 'vitest';
import type {Vector} from '../core/protocol/geometry';
import type {Lens} from '../webgl/lens';
import {MeshCamera} from '../webgl/mesh_camera';
import {product, transformed} from '../webgl/matrix';
import {partsOf, straighten, type Part} from '../webgl/tiles';
import type {Frame} from '../webgl/view';
import {WorkerCanvas} from '../webgl/worker_canvas';

const kAround = {left: 0, right: 0, top: 0.05, bottom: 0.15};
const kFrame: Frame = {width: 3000, height: 2100, insets: kAround, pixelRatio: 2};
const kWhole: Part = {x: 0, y: 0, width: 3000, height: 2100};
const kInsets = {left: 0.05, right: 0.25, top: 0, bottom: 0.15};

test('partsCoverThePictureOnce', () => {
  for (const [width, height] of [
    [1, 1],
    [2048, 2048],
    [2049, 100],
    [7680, 4320],
  ] as const) {
    const parts = partsOf({width, height});
    expect(parts.reduce((sum, part) => sum + part.width * part.height, 0)).toBe(width * height);
    expect(new Set(parts.map(({x, y}) => `${x} ${y}`)).size).toBe(parts.length);
    for (const part of parts) {
      expect(Math.max(part.width, part.height)).toBeLessThanOrEqual(2048);
      expect(part.x + part.width).toBeLessThanOrEqual(width);
      expect(part.y + part.height).toBeLessThanOrEqual(height);
    }
  }
});

test('coloursAreDividedByTheirOpacity', () => {
  const pixels = new Uint8ClampedArray([10, 20, 30, 255, 0, 0, 0, 0, 50, 100, 128, 128]);
  straighten(pixels);
  expect([...pixels]).toEqual([10, 20, 30, 255, 0, 0, 0, 0, 100, 199, 255, 128]);
});

/** The camera of a box of 200 x 100 x 50 lattice steps on a canvas of 1280 x 800. */
function meshCamera(): MeshCamera {
  const canvas = new WorkerCanvas({} as OffscreenCanvas);
  canvas.resize({width: 1280, height: 800, pixelRatio: 1});
  const camera = new MeshCamera(canvas, () => undefined);
  camera.setRoom({insets: kInsets});
  camera.resize(1280, 800);
  camera.growTo({bounds: [0, 0, 0, 200, 100, 50]});
  return camera;
}

/** The places of the box's corners in a part, in pixels of the whole picture. */
function corners(camera: MeshCamera, part: Part): [number, number][] {
  const {toCanvas} = camera.sightOf(camera.lensFor(kFrame, part));
  return Array.from({length: 8}, (_, i) => {
    const corner: Vector = [i & 1 ? 200 : 0, i & 2 ? 100 : 0, i & 4 ? 50 : 0];
    const at = transformed(toCanvas, corner);
    const {x, y, width, height} = part;
    return [x + ((at[0] + 1) / 2) * width, y + ((1 - at[1]) / 2) * height];
  });
}

function boundsOf(places: [number, number][], side: 0 | 1): [number, number] {
  const all = places.map((place) => place[side]);
  return [Math.min(...all), Math.max(...all)];
}

describe('the camera of a picture', () => {
  test.each([false, true])('isTheSameInEveryPart (moved: %s)', (moved) => {
    const camera = meshCamera();
    if (moved) camera.orbit.orbit(0.3, 0.1);
    const whole = corners(camera, kWhole);
    for (const part of partsOf(kFrame))
      corners(camera, part).forEach((place, i) =>
        expect(Math.hypot(place[0] - whole[i]![0], place[1] - whole[i]![1])).toBeLessThan(1e-6),
      );
  });

  test.each([false, true])('fitsTheMeshIntoItsFreeRectangle (moved: %s)', (moved) => {
    const camera = meshCamera();
    if (moved) {
      camera.orbit.orbit(0.3, 0.1);
      camera.orbit.zoom(1.7);
    }
    const state = camera.orbit.state;
    const places = corners(camera, kWhole);
    const [left, right] = boundsOf(places, 0);
    const [top, bottom] = boundsOf(places, 1);
    expect((left + right) / 2).toBeCloseTo(1500, 0);
    // It is fitted exactly in one direction, and nearly in the other: 105 to 1785 pixels are free.
    expect(Math.abs((top + bottom) / 2 - 945)).toBeLessThan(10);
    expect(left).toBeGreaterThan(0);
    expect(Math.max((right - left) / 3000, (bottom - top) / 1680)).toBeCloseTo(0.88, 1);
    expect(camera.orbit.state).toEqual(state);
  });

  test('showsAPartOfAMeshAsLargeAsItsFreeAreaAllows', () => {
    const camera = meshCamera();
    camera.orbit.zoom(0.7);
    const {lens, target} = camera.orbit;
    expect(lens.part!.x).not.toBe(0);
    // 896 x 680 CSS pixels are free; the picture's height without its insets is 1680 pixels.
    const scale = Math.min(3000 / (1280 * 0.7), 1680 / (800 * 0.85));
    const seen = camera.lensFor(kFrame, kWhole);
    expect(seen.part!.fullWidth).toBeCloseTo(1280 * scale);
    expect(seen.part!.fullHeight).toBeCloseTo(800 * scale);
    const [x, y] = transformed(product(seen.toCube, seen.toEye), target);
    expect(x).toBeCloseTo(0);
    expect(y).toBeCloseTo(0.1);
  });
});

const kCovered = {left: 0, right: 0, top: 0.1, bottom: 0.6};

test.each([false, true])('aCoveredPictureGoesToTheFreeArea (moved: %s)', (isMoved) => {
  const camera = meshCamera();
  if (isMoved) camera.orbit.orbit(0.3, 0.1);
  const [state, saved] = [camera.orbit.state, corners(camera, kWhole)];
  const seenBy = (its: Lens): number[] => {
    camera.orbit.setDepths(its);
    return transformed(camera.sightOf(its).toCanvas, [200, 100, 0]).slice(0, 2);
  };
  const before = seenBy(camera.orbit.lens).map((share) => expect.closeTo(share) as number);
  expect(camera.setRoom({covered: kCovered})).toBe(true);
  expect(camera.setRoom({covered: {...kCovered}})).toBe(false);
  camera.resize(1280, 800);
  const {lens, target} = camera.orbit;
  const [x, y] = transformed(product(lens.toCube, lens.toEye), target);
  expect([x, y]).toEqual([expect.closeTo(0), expect.closeTo(0.5)]);
  expect(seenBy(lens)).not.toEqual(before);
  expect(camera.orbit.state).toEqual(state);
  expect(corners(camera, kWhole)).toEqual(saved);
  expect(seenBy(camera.uncovered())).toEqual(before);
  expect(camera.setRoom({covered: null})).toBe(true);
  camera.resize(1280, 800);
  expect(seenBy(lens)).toEqual(before);
});

test('aMoveInACoveredPictureFollowsThePointer', () => {
  const camera = meshCamera();
  camera.setRoom({covered: kCovered});
  camera.resize(1280, 800);
  const {lens, target} = camera.orbit;
  const placeOf = (): Vector => transformed(product(lens.toCube, lens.toEye), target);
  expect(lens.part!.fullHeight).toBeLessThan(800);
  const before = placeOf();
  camera.orbit.pan(0.1, 0.05);
  const after = placeOf();
  expect(after[0] - before[0]).toBeCloseTo((2 * 0.1 * 800) / 1280);
  expect(after[1] - before[1]).toBeCloseTo(2 * 0.05);
});

describe('room for numbers', () => {
  const cameraOf = (width: number, height: number, room: [number, number]): MeshCamera => {
    const camera = meshCamera();
    camera.setRoom({
      insets: {left: 0, right: 0, top: 0.6, bottom: 0.6},
      boxed: [room[0] / width, room[1] / height],
    });
    camera.resize(width, height);
    return camera;
  };

  test.each([
    [320, 240],
    [100, 40],
    [1, 1],
  ])('leavesSomeToTheMeshOnAPageOf %d x %d', (width, height) => {
    const camera = cameraOf(width, height, [52, 36]);
    const {lens} = camera.orbit;
    camera.orbit.setDepths();
    const {toCanvas} = camera.sightOf(lens);
    for (let i = 0; i < 8; ++i) {
      const at = transformed(toCanvas, [i & 1 ? 200 : 0, i & 2 ? 100 : 0, i & 4 ? 50 : 0]);
      for (const share of at) expect(Math.abs(share)).toBeLessThan(1); // before the eye, too
    }
    camera.setRoom({covered: {left: 0, right: 0, top: 0.6, bottom: 0.6}});
    camera.resize(width, height);
    expect(lens.part!.fullHeight).toBeGreaterThan(0);
    expect(lens.part!.fullHeight).toBeLessThanOrEqual(height);
  });

  test.each([false, true])('leavesSomeToTheMeshOfAFlatPicture (moved: %s)', (isMoved) => {
    const camera = meshCamera();
    if (isMoved) camera.orbit.orbit(0.3, 0.1);
    const {fullWidth, fullHeight} = camera.lensFor(
      {...kFrame, width: 7680, height: 200, boxed: [0.02, 0.6]},
      {x: 0, y: 0, width: 7680, height: 200},
    ).part!;
    expect(fullWidth).toBeGreaterThan(0);
    expect(fullHeight).toBeGreaterThan(0);
  });
});
