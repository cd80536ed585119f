// Arrows as the attribute `arrows`, and those that begin with `arrow-`, have them.

import {kArrowLengths, kArrowPlaces, type ArrowsRequest} from '../picture/arrows';
import type {FieldInfo} from '../protocol/fields';
import {vectorField} from './streamlines_text';

type Name =
  'arrows' | 'arrow-places' | 'arrow-density' | 'arrow-length' | 'arrow-size' | 'arrow-color';
export type ReadArrows = (name: Name) => string | null;

/** Those of vectors, and of symmetric tensors. */
export const kArrowComponents = [3, 6];

export const kFirstDensity = 30;
/** Fewer are no picture of a field, and more do not fit kMostArrows of core/lines. */
export const kDensities = [4, 100] as const;
export const kFirstSize = 1.5;
export const kSizes = [0.1, 20] as const;

const within = (text: string | null, [least, most]: readonly [number, number]): number | null => {
  const number = Number(text ?? NaN);
  return text !== '' && number >= least && number <= most ? number : null;
};

export const kArrowColors = ['plain', 'field'] as const;
type ArrowColor = (typeof kArrowColors)[number];

/** On a surface of the same colours they would hardly be seen. */
export const firstColor = (places: ArrowsRequest['places']): ArrowColor =>
  places === 'shown' ? 'plain' : 'field';

export const isArrowColor = (text: string | null): text is ArrowColor =>
  (kArrowColors as readonly (string | null)[]).includes(text);
export const isArrowPlaces = (text: string | null): text is ArrowsRequest['places'] =>
  (kArrowPlaces as readonly (string | null)[]).includes(text);
export const isArrowLength = (text: string | null): text is ArrowsRequest['length'] =>
  (kArrowLengths as readonly (string | null)[]).includes(text);
export const arrowDensity = (text: string | null): number | null => within(text, kDensities);
export const arrowSize = (text: string | null): number | null => within(text, kSizes);

/** Null: no arrows are asked for, or they do not fit the mesh. */
export function readArrows(read: ReadArrows, fields: readonly FieldInfo[]): ArrowsRequest | null {
  const field = vectorField(read('arrows'), fields, kArrowComponents);
  if (field < 0) return null;
  const [text, length, color] = [read('arrow-places'), read('arrow-length'), read('arrow-color')];
  const places = isArrowPlaces(text) ? text : kArrowPlaces[0];
  return {
    field,
    places,
    isColored: (isArrowColor(color) ? color : firstColor(places)) === 'field',
    density: arrowDensity(read('arrow-density')) ?? kFirstDensity,
    length: isArrowLength(length) ? length : kArrowLengths[0],
    size: arrowSize(read('arrow-size')) ?? kFirstSize,
  };
}
