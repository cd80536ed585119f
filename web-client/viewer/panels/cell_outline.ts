// A cell as it is seen, for the picture's marks.

import type {Point} from '../page/card_place';

/** Its four sides, for SVG: all turn the same way, so that none cuts a hole into another. */
export function cellPath(corners: readonly Point[]): string {
  return corners
    .map((_, left) => {
      const [a, b, c] = corners.filter((corner) => corner !== corners[left]) as [
        Point,
        Point,
        Point,
      ];
      const area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
      const order = area < 0 ? [a, c, b] : [a, b, c];
      return `M${order.map(({x, y}) => `${x.toFixed(1)} ${y.toFixed(1)}`).join('L')}z`;
    })
    .join('');
}
