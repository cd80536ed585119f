// Where small labels stand beside their dots: none covers another one, or another dot.

import {grown, overlap, type Box, type Point} from './card_place';

export interface LabelledDot extends Point {
  /** The label's, in pixels. */
  width: number;
  height: number;
  /** The place that the label had last, so that labels do not jump; 0 is the first choice. */
  last: number;
}

/** The label's upper left corner, from the dot. */
export interface LabelPlace extends Point {
  /** It goes back into `last`. */
  choice: number;
}

/** Pixels between a dot's middle and its label. */
const kAway = 10;
/** Half of a dot with its ring, in pixels. */
const kRadius = 9;
/** Pixels between two labels. */
const kGap = 2;

/** Beside the dot, then at its corners, then above and below it. */
const kChoices: readonly (readonly [x: -1 | 0 | 1, y: -1 | 0 | 1])[] = [
  [1, 0],
  [-1, 0],
  [1, -1],
  [1, 1],
  [-1, -1],
  [-1, 1],
  [0, -1],
  [0, 1],
];

/**
 * A place for each label in a viewer of this size, or null if it has no room. Labels that come
 * first choose first. The label of a dot outside the viewer has none.
 */
export function placeLabels(
  dots: readonly LabelledDot[],
  viewer: {width: number; height: number},
): (LabelPlace | null)[] {
  const whole: Box = {left: 0, top: 0, right: viewer.width, bottom: viewer.height};
  const placed: Box[] = [];
  const boxes = dots.map(boxOfDot);
  return dots.map((dot, at) => {
    if (!contains(whole, {left: dot.x, top: dot.y, right: dot.x, bottom: dot.y})) return null;
    const isFree = (place: LabelPlace): boolean => {
      const box = boxOf(dot, place);
      return (
        contains(whole, box) &&
        !placed.some((other) => overlap(grown(box, kGap), other)) &&
        !boxes.some((other, i) => i !== at && overlap(box, other))
      );
    };
    const places = [dot.last, ...kChoices.keys()].map((choice) => placeOf(dot, choice));
    const free = places.find(isFree) ?? null;
    if (free) placed.push(boxOf(dot, free));
    return free;
  });
}

function placeOf({width, height}: LabelledDot, choice: number): LabelPlace {
  const [x, y] = kChoices[choice]!;
  const along = (side: number, size: number): number =>
    side === 0 ? -size / 2 : side > 0 ? kAway : -kAway - size;
  return {x: along(x, width), y: along(y, height), choice};
}

const boxOf = (dot: LabelledDot, {x, y}: Point): Box => ({
  left: dot.x + x,
  top: dot.y + y,
  right: dot.x + x + dot.width,
  bottom: dot.y + y + dot.height,
});

const boxOfDot = ({x, y}: Point): Box => grown({left: x, top: y, right: x, bottom: y}, kRadius);

function contains(outer: Box, inner: Box): boolean {
  return (
    inner.left >= outer.left &&
    inner.right <= outer.right &&
    inner.top >= outer.top &&
    inner.bottom <= outer.bottom
  );
}
