import {describe, expect, test} from 'vitest';
import type {Vector} from '../core/protocol/geometry';
import {Lens} from '../webgl/lens';
import {product} from '../webgl/matrix';
import {rulerOf, type Line, type Ruler} from '../viewer/panels/ruler';

const kBounds = [0, 0, 0, 100, 50, 25];
const kScale = {origin: [10, 0, -1], step: 0.1, unit: 'mm'};
const kSize = {width: 1000, height: 800};

/** From `eye` to the middle of the box. */
function seenFrom(eye: Vector, bounds = kBounds): Ruler {
  const lens = new Lens(40);
  lens.aspect = kSize.width / kSize.height;
  lens.eye = eye;
  lens.lookAt([50, 25, 12]);
  Object.assign(lens, {near: 1, far: 1000});
  return rulerOf(bounds, kScale, {toCanvas: product(lens.toCube, lens.toEye), ...kSize});
}

const lengthOf = ([x1, y1, x2, y2]: Line): number => Math.hypot(x2 - x1, y2 - y1);
const texts = (ruler: Ruler): string[] => ruler.numbers.map(({text}) => text);

describe('Ruler', () => {
  test('aCornerViewHasNineEdgesAndNumbersOnThree', () => {
    const ruler = seenFrom([200, -150, 120]);
    expect(ruler.box).toHaveLength(9); // the three in front would cross the mesh
    expect(ruler.names.map(({text}) => text)).toEqual(['x [mm]', 'y [mm]', 'z [mm]']);
    expect(texts(ruler)).toEqual(expect.arrayContaining(['10', '12', '20', '0', '2', '4']));
  });

  test('numbersStandOutsideTheBox', () => {
    const {box, numbers, names} = seenFrom([200, -150, 120]);
    const middle = [500, 400];
    const reach = Math.max(
      ...box.map((line) => lengthOf([middle[0]!, middle[1]!, line[0], line[1]])),
    );
    expect(reach).toBeGreaterThan(100);
    for (const {x, y} of [...numbers, ...names])
      for (const [x1, y1, x2, y2] of box) {
        const [dx, dy] = [x2 - x1, y2 - y1];
        const share = Math.min(
          1,
          Math.max(0, ((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy)),
        );
        expect(Math.hypot(x - x1 - share * dx, y - y1 - share * dy)).toBeGreaterThan(8);
      }
  });

  test('aFrontViewHasNoNumbersAlongTheLineOfSight', () => {
    const {box, names} = seenFrom([50, -200, 12]);
    expect(names.map(({text}) => text)).toEqual(['x [mm]', 'z [mm]']);
    expect(box.length).toBeGreaterThanOrEqual(4);
  });

  test('anEyeInTheBoxDrawsOnlyWhatLiesBeforeIt', () => {
    const {box, names, numbers} = seenFrom([20, 25, 12]);
    expect(names).toEqual([]);
    expect(numbers).toEqual([]);
    expect(box.length).toBeGreaterThan(0);
    for (const line of box) expect(line.every(Number.isFinite)).toBe(true);
  });

  test('aFlatMeshHasNoNumbersAcross', () => {
    const {names, box} = seenFrom([200, -150, 120], [0, 0, 0, 100, 50, 0]);
    expect(names.map(({text}) => text)).toEqual(['x [mm]', 'y [mm]']);
    for (const line of box) expect(line.every(Number.isFinite)).toBe(true);
  });

  test('aCanvasWithoutASizeHasOnlyFiniteLines', () => {
    const {box, grid, ticks, numbers} = rulerOf(kBounds, kScale, {
      toCanvas: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
      ...{width: 0, height: 0},
    });
    for (const line of [...box, ...grid, ...ticks]) expect(line.every(Number.isFinite)).toBe(true);
    for (const {x, y} of numbers) expect(Number.isFinite(x + y)).toBe(true);
  });

  test('noNumberHidesAnother', () => {
    const {numbers} = seenFrom([160, -9, 12.2]);
    numbers.forEach((a, i) =>
      numbers.slice(i + 1).forEach((b) => {
        const isApart = Math.abs(a.y - b.y) >= 12 || Math.abs(a.x - b.x) >= 8;
        expect(isApart, `${a.text} and ${b.text}`).toBe(true);
      }),
    );
  });
});
