// Parts as the attributes `parts`, `hidden-parts`, `part-opacity` and `part-colors` have them: by
// their names, or by numbers where those are missing.

import {hexOf, parseHex} from '../picture/color_map_text';
import {kMagnitude} from '../picture/field_scale';
import type {FieldInfo} from '../protocol/fields';
import {fieldOfKey} from './field_values';
import type {PartsRequest} from '../picture/parts_request';

export type PartsAttribute = 'parts' | 'hidden-parts' | 'part-opacity' | 'part-colors';
export type ReadParts = (name: PartsAttribute) => string | null;

/** The parts of a mesh that are shown in another way than the others. */
export interface PartsState {
  hidden: ReadonlySet<number>;
  /** The parts in `hidden` are the only ones that are not hidden. */
  isInverse: boolean;
  opacities: ReadonlyMap<number, number>;
  /** From 0 to 255. */
  colors: ReadonlyMap<number, readonly number[]>;
}

const kInverse = 'all but ';

/** The fields whose values are parts: labels of cells. A series has its shown instant. */
export function partFields(fields: readonly FieldInfo[]): number[] {
  return [...fields.keys()].filter((field) => {
    const {association, components, instant, labels} = fields[field]!;
    return labels && association === 'cell' && components === 1 && instant?.isShown !== false;
  });
}

/** The named field, or else the first one with parts; -1 if the mesh has none. */
export function partField(text: string | null, fields: readonly FieldInfo[]): number {
  const all = partFields(fields);
  const named = text === null ? -1 : fieldOfKey(text, fields);
  return all.includes(named) ? named : (all[0] ?? -1);
}

export function readState(read: ReadParts, {labels}: FieldInfo): PartsState {
  const labelOf = labelsByText(labels ?? new Map());
  const text = read('hidden-parts') ?? '';
  const isInverse = text.startsWith(kInverse);
  const words = (list: string | null): string[] => (list ?? '').split(',').filter((x) => x !== '');
  const pairs = (name: PartsAttribute): [number, string][] =>
    words(read(name)).flatMap((word) => {
      const [part = '', value = ''] = word.split('=');
      const label = labelOf(part);
      return label === null ? [] : [[label, value]];
    });
  return {
    isInverse,
    hidden: new Set(
      words(isInverse ? text.slice(kInverse.length) : text).flatMap((word) => labelOf(word) ?? []),
    ),
    opacities: new Map(
      pairs('part-opacity')
        .map(([label, value]) => [label, Number(value)] as const)
        .filter(([, opacity]) => opacity > 0 && opacity < 1),
    ),
    colors: new Map(
      pairs('part-colors').flatMap(([label, value]) => {
        const color = parseHex(value);
        return color ? [[label, color] as const] : [];
      }),
    ),
  };
}

/** Words of an attribute that name no part. */
export function unknownParts(text: string, {labels}: FieldInfo): string[] {
  const labelOf = labelsByText(labels ?? new Map());
  return text
    .replace(kInverse, '')
    .split(',')
    .map((word) => word.split('=')[0]!)
    .filter((word) => word !== '' && labelOf(word) === null);
}

/** The worker draws by it; null: all parts are shown alike. */
export function readParts(
  read: ReadParts,
  fields: readonly FieldInfo[],
  selected: number | null,
): PartsRequest | null {
  const field = partField(read('parts'), fields);
  if (field < 0) return null;
  const {hidden, isInverse, opacities, colors} = readState(read, fields[field]!);
  const isPlain = hidden.size + opacities.size + colors.size === 0 && !isInverse;
  if (isPlain && selected === null) return null;
  return {
    scalar: {field, component: kMagnitude},
    range: fields[field]!.range,
    hidden: [...hidden],
    isInverse,
    opacities: [...opacities],
    colors: [...colors],
    selected,
  };
}

/** The attributes' texts; null for those that say nothing. */
export function partsTexts(
  {hidden, isInverse, opacities, colors}: PartsState,
  {labels}: FieldInfo,
): Record<Exclude<PartsAttribute, 'parts'>, string | null> {
  const textOf = partTexts(labels ?? new Map());
  const list = (words: string[]): string | null => (words.length > 0 ? words.join() : null);
  const names = [...hidden].sort((a, b) => a - b).map(textOf);
  return {
    'hidden-parts': isInverse ? kInverse + names.join() : list(names),
    'part-opacity': list([...opacities].map(([label, opacity]) => `${textOf(label)}=${opacity}`)),
    'part-colors': list([...colors].map(([label, color]) => `${textOf(label)}=${hexOf(color)}`)),
  };
}

export const isHidden = ({hidden, isInverse}: PartsState, label: number): boolean =>
  hidden.has(label) !== isInverse;

/** The name that stands in attributes: the number where a name is missing, or means another. */
function partTexts(names: ReadonlyMap<number, string>): (label: number) => string {
  const labelOf = labelsByText(names);
  return (label) => {
    const name = names.get(label) ?? '';
    const isPlain = name !== '' && !/[,=]/.test(name) && !name.startsWith(kInverse);
    return isPlain && name.trim() === name && labelOf(name) === label ? name : String(label);
  };
}

/** Numbers mean themselves, whatever is called so. */
function labelsByText(names: ReadonlyMap<number, string>): (text: string) => number | null {
  const byName = new Map<string, number>();
  for (const [label, name] of names) if (!byName.has(name)) byName.set(name, label);
  return (text) => {
    const word = text.trim();
    return /^-?\d+$/.test(word) ? Number(word) : (byName.get(word) ?? null);
  };
}
