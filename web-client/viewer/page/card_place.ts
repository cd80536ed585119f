// Where a card opens: beside the pointer, where the mesh is not, and never over a picked point.

export interface Point {
  x: number;
  y: number;
}

export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** Pixels between the candidates for a place. */
const kStep = 16;
/** Pixels round a picked point that stay visible. */
const kMargin = 14;
/** Pixels between the card and the viewer's edge, another card or the pointer. */
const kGap = 16;
/** Samples of the card along each side, to find how much of the mesh it covers. */
const kSamples = 6;
/** The cost of covering nothing but mesh, in diagonals of the viewer that the card is farther. */
const kMeshCost = 0.7;
/** The same for another card. This is only paid if there is no other place. */
const kCardCost = 10;
/** The same for a picked point. */
const kPointCost = 100;

export interface Surroundings {
  /** The viewer's size. */
  width: number;
  height: number;
  /** The other cards. */
  cards: readonly Box[];
  /** The picked points; the last is the pointer's. */
  picked: readonly Point[];
  /** The mesh lies inside the convex hull of these. */
  mesh: readonly Point[];
}

/** The place of a card's top left corner, for a card of this size, in pixels of the viewer. */
export function placeCard(
  width: number,
  height: number,
  {width: fullWidth, height: fullHeight, cards, picked, mesh}: Surroundings,
): Point {
  const hull = convexHull(mesh);
  const pointer = picked.at(-1);
  const diagonal = Math.hypot(fullWidth, fullHeight);
  const costAt = (left: number, top: number): number => {
    const box = {left, top, right: left + width, bottom: top + height};
    const far = pointer ? distanceTo(grown(box, kGap), pointer) / diagonal : 0;
    return (
      far +
      kMeshCost * shareInside(box, hull) +
      kCardCost * cards.filter((card) => overlap(grown(box, kGap), card)).length +
      kPointCost * picked.filter((point) => distanceTo(grown(box, kMargin), point) === 0).length
    );
  };
  let best = {x: kGap, y: kGap};
  let least = Infinity;
  for (let top = kGap; top <= Math.max(kGap, fullHeight - kGap - height); top += kStep)
    for (let left = kGap; left <= Math.max(kGap, fullWidth - kGap - width); left += kStep) {
      const cost = costAt(left, top);
      if (cost < least) [best, least] = [{x: left, y: top}, cost];
    }
  return best;
}

export function grown({left, top, right, bottom}: Box, by: number): Box {
  return {left: left - by, top: top - by, right: right + by, bottom: bottom + by};
}

export function overlap(a: Box, b: Box): boolean {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/** 0 inside. */
function distanceTo({left, top, right, bottom}: Box, {x, y}: Point): number {
  return Math.hypot(Math.max(left - x, x - right, 0), Math.max(top - y, y - bottom, 0));
}

function shareInside({left, top, right, bottom}: Box, hull: readonly Point[]): number {
  let inside = 0;
  for (let i = 0; i < kSamples; ++i)
    for (let k = 0; k < kSamples; ++k) {
      const x = left + ((i + 0.5) / kSamples) * (right - left);
      const y = top + ((k + 0.5) / kSamples) * (bottom - top);
      if (isInside(hull, {x, y})) ++inside;
    }
  return inside / kSamples ** 2;
}

function isInside(hull: readonly Point[], point: Point): boolean {
  return (
    hull.length > 2 && hull.every((at, i) => turn(at, hull[(i + 1) % hull.length]!, point) >= 0)
  );
}

/** Above 0 if the way from a by b to c turns towards positive angles. */
function turn(a: Point, b: Point, c: Point): number {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/** Its corners in the order of positive angles, by Andrew's monotone chain. */
function convexHull(points: readonly Point[]): Point[] {
  const sorted = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  const chain = (from: readonly Point[]): Point[] => {
    const kept: Point[] = [];
    for (const point of from) {
      while (kept.length > 1 && turn(kept.at(-2)!, kept.at(-1)!, point) <= 0) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}
