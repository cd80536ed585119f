// Fields that are computed from others: those that a text defines, "Cp = (p - 101325) / 540; ...",
// and the quantities of the tensors and the vectors that a mesh has.

import type {DerivedField, DerivedFields} from '../picture/derived_field';
import {fieldKeys, widthOfValues, type FieldInfo} from '../protocol/fields';
import type {Manifest, Spread} from '../protocol/manifest';
import {fieldOfKey} from '../layers/field_values';
import {instantsOf} from '../protocol/series';
import {definitionsIn} from './definitions';
import {ExpressionError, parseExpression, type Tree} from './parse';
import {beginText, keep} from './derived_values';
import {flowQuantitiesOf} from './flow';
import {compile, inputsOf, type Slope, type Value} from './program';
import {kTensorQuantities} from './tensors';

/** More make menus long and addresses unreadable. */
export const kMaxDefinitions = 20;
/** Names stand in menus and legends. */
const kMaxName = 40;
const kName = /^[\p{L}_][\p{L}\p{N}_ ]*$/u;

/** The fields of all definitions that are right, and a sentence for each that is not. */
export function deriveFields(text: string, manifest: Manifest): DerivedFields {
  const {fields} = manifest;
  const all: DerivedField[] = [];
  const errors: string[] = [];
  const earlier = new Map<string, Value>();
  const slopes: Slope[] = [];
  beginText();
  for (const [i, definition] of definitionsIn(text).entries()) {
    try {
      if (i >= kMaxDefinitions)
        throw new ExpressionError(
          0,
          `there are more than ${kMaxDefinitions} fields; leave some out`,
        );
      const {name, at} = nameIn(definition, fields, earlier);
      const value = compiled(definition.slice(at), at, (tree) =>
        compile(tree, fields, earlier, slopes),
      );
      earlier.set(name, value);
      // a constant is for later definitions alone
      if (value.association !== null) all.push(derivedField(name, value, manifest));
    } catch (thrown) {
      if (!(thrown instanceof ExpressionError)) throw thrown;
      errors.push(`"${definition}", column ${thrown.at + 1}: ${thrown.message}.`);
      if (i >= kMaxDefinitions) break; // an address may hold thousands
    }
  }
  return {fields: [...all, ...offeredFields(manifest)], errors};
}

/** The name of a definition, and where its expression begins. */
function nameIn(
  definition: string,
  fields: readonly FieldInfo[],
  earlier: ReadonlyMap<string, Value>,
): {name: string; at: number} {
  const at = definition.indexOf('=');
  const name = definition.slice(0, Math.max(0, at)).trim();
  if (at < 0 || !kName.test(name) || name.length > kMaxName)
    throw new ExpressionError(
      0,
      `a name of letters, digits and spaces, at most ${kMaxName}, stands before "=": ` +
        'Cp = (p - 101325) / 540',
    );
  if (fieldOfKey(name, fields) >= 0 || earlier.has(name))
    throw new ExpressionError(0, `a field is called "${name}" already; choose another name`);
  return {name, at: at + 1};
}

/** Places in errors are those in the definition. */
function compiled(expression: string, at: number, make: (tree: Tree) => Value): Value {
  try {
    return make(parseExpression(expression));
  } catch (thrown) {
    if (!(thrown instanceof ExpressionError)) throw thrown;
    throw new ExpressionError(thrown.at + at, thrown.message);
  }
}

/** Where no bound is known, values are shown as shares of 1. */
const kUnbounded: [number, number] = [0, 1];

function derivedField(name: string, value: Value, manifest: Manifest): DerivedField {
  const [low, high] = value.components[0]!.range;
  const isBounded = Number.isFinite(high - low);
  const info: FieldInfo = {
    name,
    components: 1,
    association: value.association!,
    step: 0,
    minimum: [0],
    range: isBounded ? [low, high] : kUnbounded,
    derived: isBounded ? 'bounded' : 'unbounded',
  };
  const errors = errorsOf(value, info, manifest);
  return {id: keep(value), info, inputs: inputsOf(value), errors};
}

/** By level, where the log knows its errors: how far the field is from the last level's. */
function errorsOf(
  {errors: rule}: Value,
  {range: [low, high], derived}: FieldInfo,
  {fields, levels}: Manifest,
): (Spread | null)[] {
  const width = high - low;
  if (!rule || derived !== 'bounded' || !(width > 0)) return levels.map(() => null);
  return levels.map(({error}) => {
    if (!error) return null;
    const {mean, max} = rule((key) => {
      const its = sameSeries(fields, key);
      const most = (kind: keyof Spread): number =>
        Math.max(
          ...its.map(
            (field) => (error.fields[field]?.[kind] ?? NaN) * widthOfValues(fields[field]!),
          ),
        );
      return {mean: most('mean'), max: most('max')};
    });
    return {mean: mean / width, max: max / width};
  });
}

/** The field; all instants of a series that is named without a time. */
function sameSeries(fields: readonly FieldInfo[], key: string): readonly number[] {
  const instants = instantsOf(fields, key);
  return instants.length > 0 ? instants : [fieldOfKey(key, fields)];
}

function offeredFields(manifest: Manifest): DerivedField[] {
  const {fields} = manifest;
  const keys = fieldKeys(fields);
  return fields.flatMap((info, field) => {
    if (info.instant?.isShown === false) return [];
    const key = info.instant?.series ?? keys[field]!;
    const ofTensor = info.components === 6 ? kTensorQuantities : [];
    return [...ofTensor, ...flowQuantitiesOf(info)].map(({name, title}) => {
      const whole: Tree = {kind: 'name', at: 0, name: key};
      const value = compile({kind: 'part', at: 0, of: whole, part: name}, fields);
      const its = derivedField(`${key}.${name}`, value, manifest);
      const unit = ofTensor.length > 0 ? info.unit : undefined;
      return {
        ...its,
        info: {...its.info, title: `${key}, ${title}`, of: key, ...(unit !== undefined && {unit})},
      };
    });
  });
}

export {kDerivation} from './derived_values';
