// Attributes that say nothing the viewer understands: a sentence for each, with what may stand
// there. A viewer ignores them otherwise, and a link with a slip would show another picture.

import {
  fieldOfKey,
  hasComponent,
  namedComponent,
  parseNumbers,
  parseScalar,
  scalarKey,
  scalarText,
} from '../../core/layers/field_values';
import {kArrowComponents} from '../../core/layers/arrows_text';
import {kLayerRules} from '../../core/layers/layer_rules';
import {fieldLayers} from '../../core/layers/layers';
import {partField, partFields, unknownParts} from '../../core/layers/parts_text';
import {vectorField} from '../../core/layers/streamlines_text';
import {kMagnitude} from '../../core/picture/field_scale';
import {parseBeyond} from '../../core/picture/color_map_text';
import {isColorMapName, kColorMapNames} from '../../core/picture/color_maps';
import {parseLimit} from '../../core/protocol/limit';
import {fieldKeys} from '../../core/protocol/fields';
import type {Manifest} from '../../core/protocol/manifest';
import type {FieldInfo} from '../../core/protocol/fields';
import {kTransportKinds} from '../../core/transport/auto_transport';
import {isGround, kGrounds} from './ground';
import {hint} from './nearest';
import {kMaxLines, kMaxName, kMaxPoints, parseKept} from './points';
import {kViewAttributes, type ViewAttribute} from './settings';
import {kNoWarp, warpField} from './warp';

type Name = ViewAttribute | 'transport';
type Read = (name: Name) => string | null;
/** Whether the text means something, what may stand there, and the words among that. */
type Rule = [isRight: (text: string) => boolean, expected: string, words?: readonly string[]];

/** Parameters that other sites append to links. */
const kOfOthers = /^utm_|clid$/;

const kRanges = ['auto', 'full', 'symmetric', 'instant'];

const oneOf = (...words: readonly string[]): Rule => [
  (text) => words.includes(text),
  words.join(', '),
  words,
];

function isRange(text: string): boolean {
  const [low, high, more] = parseNumbers(text);
  return low !== undefined && high !== undefined && more === undefined && low < high;
}

const kRules: Partial<Record<Name, Rule>> = {
  transport: oneOf('auto', ...kTransportKinds),
  colormap: [
    (text) => {
      const [map = '', reversed = 'reversed', ...more] = text.split(/[\s+]+/);
      return isColorMapName(map) && reversed === 'reversed' && more.length === 0;
    },
    `${kColorMapNames.join(', ')}, or custom:0=0000ff,1=ff0000; "/8" for eight steps, and ` +
      '" reversed" behind it',
    kColorMapNames.flatMap((name) => [name, `${name} reversed`]),
  ],
  beyond: [
    (text) => parseBeyond(text) !== null,
    'two colours, below and above: 1f3fbf,ff00ff; one of them may be missing',
  ],
  range: [
    (text) => kRanges.includes(text) || isRange(text),
    'auto, full, symmetric, instant, or two numbers, the smaller first: 0.5,2',
    kRanges,
  ],
  time: [(text) => parseNumbers(text).length === 1, 'a number, a time of the series'],
  'time-range': [isRange, 'two times, the smaller first: 0.5,2'],
  'time-loop': oneOf('on', 'off'),
  scale: oneOf('log', 'linear'),
  edges: oneOf('on', 'off'),
  creases: oneOf('on', 'off'),
  surface: oneOf('on', 'off'),
  'warp-scale': [(text) => parseNumbers(text).length === 1, 'a number; 1 is the true size'],
  'rest-edges': oneOf('on', 'off'),
  axes: oneOf('on', 'off'),
  extremes: oneOf('on', 'off'),
  ground: [isGround, `${kGrounds.join(', ')}, or a colour, 3c3c3c`, kGrounds],
  opacity: [(text) => Number(text) > 0 && Number(text) <= 1, 'a number above 0, at most 1'],
  ...kLayerRules,
  points: [
    (text) => parseKept('points', text) !== null,
    `up to ${kMaxPoints} places of three coordinates, 1,2,0.5 3,2,0, with names of at most ` +
      `${kMaxName} letters if you like: Tip: 1,2,0.5; 3,2,0`,
  ],
  lines: [
    (text) => parseKept('lines', text) !== null,
    `up to ${kMaxLines} pairs of places: Wake: 1,2,0.5 3,2,0; 1,0,0 1,0,2`,
  ],
  quality: [
    (text) => parseLimit(text) !== null,
    'full, 1%, error:0.01, cells:20000 or bytes:100000',
  ],
  projection: oneOf('parallel', 'perspective'),
  camera: [(text) => parseNumbers(text).length === 6, 'six numbers'],
};

/** A sentence for each attribute that cannot be understood. */
export function wrongParts(read: Read): string[] {
  return Object.entries(kRules).flatMap(([name, [isRight, expected, words = []]]) => {
    const text = read(name as Name);
    return text === null || isRight(text)
      ? []
      : [`${name}="${text}" is not understood.${hint(text, words)} It takes ${expected}.`];
  });
}

/** A sentence for each of a page's parameters that the viewer does not know. */
export function unknownNames(names: readonly string[]): string[] {
  const known = ['src', 'transport', ...kViewAttributes];
  return names
    .filter((name) => !known.includes(name) && !kOfOthers.test(name))
    .map((name) => `The address has "${name}", which means nothing here.${hint(name, known)}`);
}

/** The field of which parseScalar reads the magnitude, because it has no such component. */
function fieldWithoutComponent(text: string, fields: readonly FieldInfo[]): FieldInfo | null {
  const named = fieldOfKey(text, fields) < 0 ? namedComponent(text, fields) : null;
  return named && !hasComponent(named, fields) ? fields[named.field]! : null;
}

/** Sentences about a component that the named field does not have. */
function wrongComponents(
  [name, text]: readonly [name: string, text: string],
  scalar: string,
  fields: Manifest['fields'],
): string[] {
  const info = fieldWithoutComponent(scalar, fields);
  if (!info) return [];
  const key = scalarKey(scalar);
  const start = `${name}="${text}" names a component that ${key} does not have.`;
  return info.components === 1
    ? [`${start} Its only value is called "${key}", which is shown.`]
    : [`${start} It has ${key}[0] to ${key}[${info.components - 1}]. Its magnitude is shown.`];
}

/** Sentences about attributes of parts that the mesh does not have. */
function unfittingNames(read: Read, fields: readonly FieldInfo[]): string[] {
  const names = ['hidden-parts', 'part-opacity', 'part-colors'] as const;
  const label = read('parts');
  const field = partField(label, fields);
  const isUsed = label !== null || names.some((name) => read(name) !== null);
  if (!isUsed) return [];
  if (field < 0) return ['The mesh has no parts: none of its fields is a label of cells.'];
  const keys = partFields(fields).map((its) =>
    scalarText({field: its, component: kMagnitude}, fields),
  );
  if (label !== null && !partFields(fields).includes(fieldOfKey(label, fields)))
    return [
      `parts="${label}" is not followed: the mesh has no such label.${hint(label, keys)} ` +
        `It has ${keys.join(', ')}.`,
    ];
  const known = [...(fields[field]?.labels?.values() ?? [])];
  return names.flatMap((name) =>
    unknownParts(read(name) ?? '', fields[field]!).map(
      (word) => `${name}: the mesh has no part "${word}".${hint(word, known)}`,
    ),
  );
}

/** A sentence for each attribute that does not fit this mesh. */
export function unfittingParts(read: Read, {fields, levels}: Manifest): string[] {
  const sentences: string[] = [];
  const keys = [
    ...new Set(fieldKeys(fields).map((key, field) => fields[field]!.instant?.series ?? key)),
  ];
  const has = `It has ${keys.join(', ') || 'none'}.`;
  const field = read('field');
  if (field !== null && !parseScalar(field, fields))
    sentences.push(
      `The mesh has no field "${field}".${hint(field, keys)} The first field is shown instead. ` +
        has,
    );
  if (field !== null) sentences.push(...wrongComponents(['field', field], field, fields));
  const warp = read('warp');
  if (warp !== null && warp !== kNoWarp && warpField(warp, fields) < 0)
    sentences.push(
      parseScalar(warp, fields)
        ? `warp="${warp}" moves nothing: it takes a field of points with three components.`
        : `warp="${warp}" moves nothing: the mesh has no such field.${hint(warp, keys)} ${has}`,
    );
  const kTakes: [name: Name, of: string, takes: readonly number[]][] = [
    ['flux', '', [3]],
    ['streamlines', ' of points', [3]],
    ['arrows', ' of points', kArrowComponents],
  ];
  for (const [name, of, takes] of kTakes) {
    const text = read(name);
    const info = fields[parseScalar(text, fields)?.field ?? -1];
    const isFit = name === 'flux' ? info?.components === 3 : vectorField(text, fields, takes) >= 0;
    if (text === null || isFit) continue;
    const counts = takes.length > 1 ? 'three or six' : 'three';
    sentences.push(
      info
        ? `${name}="${text}" is not shown: it takes a field${of} with ${counts} components.`
        : `${name}="${text}" is not shown: the mesh has no such field.${hint(text, keys)} ${has}`,
    );
  }
  for (const layer of fieldLayers()) {
    const text = read(layer.name);
    if (text === null || !kLayerRules[layer.name][0](text)) continue;
    const name = layer.fieldOf(text);
    const what = `${layer.name}="${text}" is not shown`;
    if (!parseScalar(name, fields))
      sentences.push(`${what}: the mesh has no field "${name}".${hint(name, keys)} ${has}`);
    else if (!layer.read(text, fields)) sentences.push(`${what}: it takes a field of points.`);
    else sentences.push(...wrongComponents([layer.name, text], name, fields));
  }
  sentences.push(...unfittingNames(read, fields));
  const quality = read('quality');
  if (parseLimit(quality)?.kind === 'error' && !levels.some(({error}) => error))
    sentences.push(
      `quality="${quality}" ends nowhere: this log does not know its errors, because it was made ` +
        'without measuring. All of it is refined.',
    );
  return sentences;
}
