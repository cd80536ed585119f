// The cube in the corner, which turns with the camera. A face looks along its axis: by a click, or
// by the keyboard, where arrows go from face to face.

import type {Point} from '../page/card_place';
import {isFree} from './cube_place';
import {dot, type Vector} from '../../core/protocol/geometry';
import {kDirections, type Direction} from '../../webgl/directions';
import type {Axes} from '../../webgl/lens';

/** Half of an edge: so far are faces from the middle. The corners stay inside the picture. */
export const kHalf = 16;
/** The side of the picture, in its own unit (template.ts). */
const kSpan = 60;
/** A face that is seen more obliquely than this has no room for its name. */
const kMinNear = 0.2;
/** A face turned away further than this is not seen. */
const kMinSeen = 0.01;
/** Sideways and upwards on each face as its own view shows it. */
const kSides: Record<Direction, [Vector, Vector]> = {
  '+x': [
    [0, 1, 0],
    [0, 0, 1],
  ],
  '-x': [
    [0, -1, 0],
    [0, 0, 1],
  ],
  '+y': [
    [-1, 0, 0],
    [0, 0, 1],
  ],
  '-y': [
    [1, 0, 0],
    [0, 0, 1],
  ],
  '+z': [
    [1, 0, 0],
    [0, 1, 0],
  ],
  '-z': [
    [1, 0, 0],
    [0, -1, 0],
  ],
};

export interface FacePlace {
  direction: Direction;
  /** For the SVG `transform`: the face as seen from its front becomes the face on the screen. */
  matrix: [number, number, number, number, number, number];
  /** The cosine between the face's normal and the line of sight; above 0 it is seen. */
  near: number;
}

/** The places of all faces. */
export function facePlaces([right, up, near]: Axes): FacePlace[] {
  return kDirections.map((direction) => {
    const [side, above] = kSides[direction];
    const normal = [0, 0, 0] as Vector;
    normal['xyz'.indexOf(direction[1]!)] = direction[0] === '+' ? 1 : -1;
    return {
      direction,
      matrix: [
        dot(side, right),
        -dot(side, up),
        -dot(above, right),
        dot(above, up),
        kHalf * dot(normal, right),
        -kHalf * dot(normal, up),
      ],
      near: dot(normal, near),
    };
  });
}

/** The seen face whose middle is nearest to a place in the cube's picture. */
export function nearestFace(places: readonly FacePlace[], x: number, y: number): Direction {
  const away = ({matrix}: FacePlace): number => Math.hypot(matrix[4] - x, matrix[5] - y);
  return places
    .filter(({near}) => near > kMinSeen)
    .reduce((best, place) => (away(place) < away(best) ? place : best)).direction;
}

export class OrientationCube {
  /** Names the face that has the focus, which may lie at the back. */
  private readonly caption: SVGTextElement;
  private readonly faces = new Map<Direction, SVGGElement>();
  private places: readonly FacePlace[] = [];

  constructor(
    private readonly svg: SVGSVGElement,
    look: (direction: Direction) => void,
  ) {
    for (const direction of kDirections) {
      const face = faceOf(svg, direction);
      face.addEventListener('click', () => look(direction));
      face.addEventListener('focus', () => {
        this.caption.textContent = face.querySelector('text')!.textContent;
      });
      face.addEventListener('keydown', (event) => this.press(event, direction, look));
      this.faces.set(direction, face);
    }
    // For fingers the whole cube is one target: its faces are too small.
    svg.addEventListener('click', (event) => {
      if (event.target !== svg || this.places.length === 0) return;
      const {left, top, width, height} = svg.getBoundingClientRect();
      const at = (place: number, size: number): number => kSpan * (place / size - 0.5);
      look(
        nearestFace(this.places, at(event.clientX - left, width), at(event.clientY - top, height)),
      );
    });
    this.rove('+x');
    this.caption = document.createElementNS(svg.namespaceURI, 'text') as SVGTextElement;
    this.caption.setAttribute('y', '24');
    this.caption.classList.add('caption');
    svg.replaceChildren(...this.faces.values(), this.caption);
  }

  turn(axes: Axes): void {
    const focused = (this.svg.getRootNode() as ShadowRoot).activeElement;
    const places = facePlaces(axes);
    this.places = places;
    for (const {direction, matrix, near} of places) {
      const face = this.faces.get(direction)!;
      face.setAttribute('transform', `matrix(${matrix.map((x) => x.toFixed(3)).join(' ')})`);
      face.classList.toggle('back', near <= kMinSeen);
      face.classList.toggle('flat', near < kMinNear);
    }
    // A child that moves loses the focus: only the others move.
    if (!focused || !this.svg.contains(focused))
      this.svg.append(
        ...places.sort((a, b) => a.near - b.near).map(({direction}) => this.faces.get(direction)!),
      );
  }

  /** Goes to the other side if the mesh, which lies between these places, is here. */
  avoid(places: readonly Point[]): void {
    if (places.length === 0) return; // once the user has moved the mesh, the cube stays
    const {svg} = this;
    const whole = (svg.getRootNode() as ShadowRoot).host.getBoundingClientRect();
    const isFreeAt = (isAside: boolean): boolean => {
      svg.classList.toggle('aside', isAside);
      const {left, right, top, bottom} = svg.getBoundingClientRect();
      const [x, y] = [whole.left, whole.top];
      const place = {left: left - x, right: right - x, top: top - y, bottom: bottom - y};
      return isFree(place, places);
    };
    if (!isFreeAt(false) && !isFreeAt(true)) svg.classList.remove('aside');
  }

  private press(event: KeyboardEvent, at: Direction, look: (direction: Direction) => void): void {
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
    if (step !== undefined) {
      const count = kDirections.length;
      const next = kDirections[(kDirections.indexOf(at) + step + count) % count]!;
      this.rove(next);
      this.faces.get(next)!.focus();
    } else if (event.key === 'Enter' || event.key === ' ') look(at);
    else return;
    event.preventDefault();
  }

  /** The cube is one stop of the Tab key. */
  private rove(to: Direction): void {
    for (const [direction, face] of this.faces)
      face.setAttribute('tabindex', direction === to ? '0' : '-1');
  }
}

function faceOf(svg: SVGSVGElement, direction: Direction): SVGGElement {
  const make = (name: string): SVGElement =>
    document.createElementNS(svg.namespaceURI, name) as SVGElement;
  const face = make('g') as SVGGElement;
  face.setAttribute('role', 'button');
  face.setAttribute('aria-label', `View from ${direction}`);
  const side = make('rect');
  for (const name of ['x', 'y']) side.setAttribute(name, String(-kHalf));
  for (const name of ['width', 'height']) side.setAttribute(name, String(2 * kHalf));
  const text = make('text');
  text.textContent = direction.replace('-', '\u2212');
  const title = make('title');
  title.textContent = `View from ${direction}`;
  face.append(title, side, text);
  return face;
}
