import {expect, test} from 'vitest';
import {isFree} from '../viewer/panels/cube_place';

const kCorner = {left: 20, right: 96, top: 20, bottom: 96};
const leaning = [
  {x: 300, y: 20},
  {x: 500, y: 20},
  {x: 20, y: 500},
  {x: 200, y: 500},
];

test('aCornerBesideALeaningMeshIsFree', () => expect(isFree(kCorner, leaning)).toBe(true));

test('aCornerUnderTheMeshIsNot', () => {
  expect(isFree(kCorner, [...leaning, {x: 60, y: 60}])).toBe(false);
  // no point lies there, but the mesh between them does
  expect(isFree({left: 250, right: 326, top: 250, bottom: 326}, leaning)).toBe(false);
});
