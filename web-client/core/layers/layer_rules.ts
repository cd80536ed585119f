// The texts that the attributes of layers take. They are needed where an attribute is wrong: a
// page fetches them behind the first picture.

import {
  arrowDensity,
  arrowSize,
  isArrowColor,
  isArrowLength,
  isArrowPlaces,
  kArrowColors,
  kDensities,
  kSizes,
} from './arrows_text';
import {kArrowLengths, kArrowPlaces} from '../picture/arrows';
import {kClipModes, kMaxPlanes} from '../picture/display';
import {kNoClip, parseClip} from './clip';
import {parseNumbers} from './field_values';
import type {LayerAttribute} from './layers';
import {
  isLineKind,
  isLook,
  kFirstSeeds,
  kLineKinds,
  kLooks,
  kMostAlongPlane,
  kMostLines,
  parseLimits,
  parseSeeds,
} from './streamlines_text';
import {kAutoVolume, isVolume, kMaxOpacities} from './volume';

/** Whether the text means something, whatever the mesh is, and the texts that it takes. */
export type LayerRule = [isRight: (text: string) => boolean, expected: string];

/** So many values behind the name of a field; absent: any. */
export const isFieldValues =
  (count?: number) =>
  (text: string): boolean => {
    const {length} = parseNumbers(text.replace(/^.*=/s, ''));
    return text.includes('=') && (count === undefined ? length > 0 : length === count);
  };

/** Entries with commas between them, each a part, "=" and a value. */
const arePairs =
  (value: string) =>
  (text: string): boolean =>
    new RegExp(`^([^,=]+=${value}(,(?!$)|$))+$`, 'i').test(text);

export const kLayerRules: Readonly<Record<LayerAttribute, LayerRule>> = {
  clip: [
    (text) => {
      if (text === kNoClip) return true;
      const words = text.trim().split(/\s+/);
      return words.length <= kMaxPlanes && parseClip(text).length === words.length;
    },
    `at most ${kMaxPlanes} planes with a share of the extent each: "x:0.5 -z:0.3", ` +
      `or ${kNoClip}`,
  ],
  'clip-mode': [(text) => (kClipModes as readonly string[]).includes(text), kClipModes.join(', ')],
  iso: [isFieldValues(), 'a field, "=" and numbers with commas between them'],
  threshold: [isFieldValues(2), 'a field, "=" and two numbers: Density=1,2'],
  parts: [(text) => text !== '', 'the name of a label'],
  'hidden-parts': [
    (text) => text !== '',
    'names or numbers of parts, "Steel,3", or "all but Steel"',
  ],
  'part-opacity': [
    arePairs('(0?\\.0*[1-9]\\d*|1)'),
    'parts with an opacity above 0, at most 1: "Steel=0.3,3=0.5"',
  ],
  'part-colors': [arePairs('[\\da-f]{6}'), 'parts with a colour: "Steel=ff8800,3=00ff00"'],
  streamlines: [(text) => text !== '', 'a field of vectors at points'],
  seeds: [
    (text) => parseSeeds(text) !== null,
    `${kFirstSeeds}, line 0,0,0 1,0,0 20, plane x:0.5 8, or sphere 0,0,0 0.1 50, with ";" ` +
      `between several; at most ${kMostLines} of a kind, and ${kMostAlongPlane} along a plane`,
  ],
  'streamline-kind': [isLineKind, kLineKinds.join(', ')],
  'streamline-look': [isLook, kLooks.join(', ')],
  'streamline-limits': [
    (text) => parseLimits(text) !== null,
    'steps, length over the diagonal, and time, each or none: steps=500 length=2 time=0.1',
  ],
  arrows: [(text) => text !== '', 'a field of vectors at points'],
  'arrow-places': [isArrowPlaces, kArrowPlaces.join(', ')],
  'arrow-density': [
    (text) => arrowDensity(text) !== null,
    `arrows along the longest side, ${kDensities.join(' to ')}`,
  ],
  'arrow-length': [isArrowLength, kArrowLengths.join(', ')],
  'arrow-color': [isArrowColor, kArrowColors.join(', ')],
  'arrow-size': [
    (text) => arrowSize(text) !== null,
    `the longest arrow over the distance between two, ${kSizes.join(' to ')}`,
  ],
  volume: [isVolume, `2 to ${kMaxOpacities} opacities from 0 to 1, or ${kAutoVolume}`],
};
