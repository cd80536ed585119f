// The points and lines that are kept, as attributes say them: places of the mesh at rest, in its
// own coordinates. A name may stand before them: "Tip: 1,2,0.5; 3,2,0".

import {parseNumbers} from '../../core/layers/field_values';
import type {Vector} from '../../core/protocol/geometry';

/** Each has a colour of its own. */
export const kMaxPoints = 8;
/** Each picture asks for all cells along each line. */
export const kMaxLines = 4;
/** In UTF-16 units: a longer name leaves no room on a card. */
export const kMaxName = 40;
/** A georeferenced mesh has millions of metres. */
const kDigits = 10;

export type KeptName = 'points' | 'lines';

export interface Kept {
  /** Empty: it has none. */
  name: string;
  /** One of a point, two of a line. */
  places: Vector[];
}

const kSizes = {points: 1, lines: 2};
const kMost = {points: kMaxPoints, lines: kMaxLines};

/** A name as the attribute can hold it: one line, no semicolons. It may be too long. */
export const plainName = (text: string): string => text.replace(/[\p{C}\s;]+/gu, ' ').trim();

/**
 * Reads an attribute: "1,2,0.5 3,2,0", "Tip: 1,2,0.5; 3,2,0", or lines of two places each. Null if
 * it is something else, or more.
 */
export function parseKept(attribute: KeptName, text: string): Kept[] | null {
  const size = kSizes[attribute];
  const all: Kept[] = [];
  for (const part of text.split(';')) {
    const colon = part.lastIndexOf(':');
    const name = plainName(part.slice(0, Math.max(0, colon)));
    const words = part
      .slice(colon + 1)
      .split(/\s+/)
      .filter(Boolean);
    const places = words.map((word) => parseNumbers(word));
    const isRight =
      name.length <= kMaxName &&
      places.every((place) => place.length === 3) &&
      places.length % size === 0 &&
      (colon < 0 || places.length === size);
    if (!isRight) return null;
    for (let i = 0; i < places.length; i += size)
      all.push({name, places: places.slice(i, i + size) as Vector[]});
  }
  return all.length <= kMost[attribute] ? all : null;
}

/** Null: there is none. Without names the text is that of before there were any. */
export function keptText(all: readonly Kept[]): string | null {
  const texts = all.map(({name, places}) => `${name && `${name}: `}${placesText(places)}`);
  return texts.join(all.some(({name}) => name !== '') ? '; ' : ' ') || null;
}

const placesText = (places: readonly Vector[]): string =>
  places.map((place) => place.map((x) => String(Number(x.toPrecision(kDigits)))).join()).join(' ');

/** Another one with these places may be kept: it is not yet, and there is room. */
export const mayKeep = (attribute: KeptName, all: readonly Kept[], places: Vector[]): boolean =>
  all.length < kMost[attribute] &&
  !all.some((its) => placesText(its.places) === placesText(places));
