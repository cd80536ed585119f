// Shapes of SVG that mark something on the picture.

import type {Vector} from '../../core/protocol/geometry';
import type {View} from '../../webgl/view';
import type {Point} from '../page/card_place';

export function shape(name: string, attributes: Record<string, number | string>): SVGElement {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes))
    element.setAttribute(key, typeof value === 'number' ? value.toFixed(1) : value);
  return element;
}

/** A cell as it is seen; `places` are its corners on the lattice. */
export const cellOutline = (places: readonly Vector[], view: View): SVGElement =>
  shape('path', {d: cellPath(places.map((place) => view.project(place)))});

/** Its four sides: all turn the same way, so that none cuts a hole into another. */
function cellPath(corners: readonly Point[]): string {
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
