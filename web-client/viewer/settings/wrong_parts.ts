// Attributes that say nothing the viewer understands: a sentence for each, with what may stand
// there. A viewer ignores them otherwise, and a link with a slip would show another picture.

import {isColorMapName, kColorMapNames} from '../../core/picture/color_maps';
import {kClipModes, kMaxPlanes} from '../../core/picture/display';
import {parseLimit} from '../../core/protocol/limit';
import {fieldKeys, type Manifest} from '../../core/protocol/manifest';
import {kTransportKinds} from '../../core/transport/auto_transport';
import {
  fieldValuesOf,
  kAutoVolume,
  kMaxOpacities,
  parseClip,
  parseNumbers,
  parseScalar,
  type ViewAttribute,
} from './settings';

type Name = ViewAttribute | 'transport';
type Read = (name: Name) => string | null;
/** Whether the text means something, and what may stand there. */
type Rule = [isRight: (text: string) => boolean, expected: string];

const oneOf = (...words: readonly string[]): Rule => [
  (text) => words.includes(text),
  words.join(', '),
];

function isRange(text: string): boolean {
  const [low, high, more] = parseNumbers(text);
  return low !== undefined && high !== undefined && more === undefined && low < high;
}

function areOpacities(text: string): boolean {
  const numbers = parseNumbers(text);
  const isShort = numbers.length >= 2 && numbers.length <= kMaxOpacities;
  return (
    text === '' ||
    text === kAutoVolume ||
    (isShort && numbers.every((value) => value >= 0 && value <= 1))
  );
}

const kValues = 'a field, "=" and numbers with commas between them';
const kRules: Partial<Record<Name, Rule>> = {
  transport: oneOf('auto', ...kTransportKinds),
  colormap: [
    (text) => {
      const [map = '', reversed = 'reversed', ...more] = text.split(/[\s+]+/);
      return isColorMapName(map) && reversed === 'reversed' && more.length === 0;
    },
    `${kColorMapNames.join(', ')}, and " reversed" behind it`,
  ],
  range: [
    (text) => ['auto', 'full', 'symmetric'].includes(text) || isRange(text),
    'auto, full, symmetric, or two numbers, the smaller first: 0.5,2',
  ],
  scale: oneOf('log', 'linear'),
  edges: oneOf('on', 'off'),
  surface: oneOf('on', 'off'),
  opacity: [(text) => Number(text) > 0 && Number(text) <= 1, 'a number above 0, at most 1'],
  clip: [
    (text) => {
      const words = text.trim().split(/\s+/);
      return words.length <= kMaxPlanes && parseClip(text).length === words.length;
    },
    `at most ${kMaxPlanes} planes with a share of the extent each: "x:0.5 -z:0.3"`,
  ],
  'clip-mode': oneOf(...kClipModes),
  iso: [
    (text) => parseNumbers(text.replace(/^.*=/s, '')).length > 0 && text.includes('='),
    kValues,
  ],
  threshold: [
    (text) => parseNumbers(text.replace(/^.*=/s, '')).length === 2 && text.includes('='),
    'a field, "=" and two numbers: Density=1,2',
  ],
  volume: [areOpacities, `2 to ${kMaxOpacities} opacities from 0 to 1, or ${kAutoVolume}`],
  quality: [
    (text) => parseLimit(text) !== null,
    'full, 1%, error:0.01, cells:20000 or bytes:100000',
  ],
  projection: oneOf('parallel', 'perspective'),
  camera: [(text) => parseNumbers(text).length === 6, 'six numbers'],
};

/** A sentence for each attribute that cannot be understood. */
export function wrongParts(read: Read): string[] {
  return Object.entries(kRules).flatMap(([name, [isRight, expected]]) => {
    const text = read(name as Name);
    return text === null || isRight(text)
      ? []
      : [`${name}="${text}" is not understood. It takes ${expected}.`];
  });
}

/** A sentence for each attribute that does not fit this mesh. */
export function unfittingParts(read: Read, {fields, levels}: Manifest): string[] {
  const sentences: string[] = [];
  const has = `It has ${fieldKeys(fields).join(', ') || 'none'}.`;
  const field = read('field');
  if (field !== null && !parseScalar(field, fields))
    sentences.push(`The mesh has no field "${field}". The first field is shown instead. ${has}`);
  for (const kind of ['iso', 'threshold'] as const) {
    const text = read(kind);
    if (text === null || !kRules[kind]![0](text)) continue;
    const name = text.replace(/=[^=]*$/s, '');
    if (!parseScalar(name, fields))
      sentences.push(`${kind}="${text}" is not shown: the mesh has no field "${name}". ${has}`);
    else if (!fieldValuesOf(kind, text, fields))
      sentences.push(`${kind}="${text}" is not shown: it takes a field of points.`);
  }
  const quality = read('quality');
  if (parseLimit(quality)?.kind === 'error' && !levels.some(({error}) => error))
    sentences.push(
      `quality="${quality}" ends nowhere: this log does not know its errors, because it was made ` +
        'without measuring. All of it is refined.',
    );
  return sentences;
}
