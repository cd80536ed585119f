// The words of attributes that name fields: "Velocity" (its magnitude), "Velocity.x" or
// "Velocity[0]" (a component), "Density=0.5,0.7" (values of it).

import {kMagnitude, scalarRange, type Scalar} from '../picture/field_scale';
import {fieldKeys, type FieldInfo} from '../protocol/fields';
import {fieldOfSeries} from '../protocol/series';

/** Reads "1, 2.5 3e-4" as numbers. The result is empty if anything in it is no number. */
export function parseNumbers(text: string): number[] {
  const numbers = text
    .replaceAll('\u2212', '-')
    .split(/[\s,;]+/)
    .filter((word) => word !== '')
    .map(Number);
  return numbers.every(Number.isFinite) ? numbers : [];
}

/** In their order; none if the components have numbers alone. */
export function componentNames(components: number): readonly string[] {
  // those of symmetric tensors are in VTK's order
  const names = components === 6 ? 'xx yy zz xy yz xz' : components <= 3 ? 'x y z' : '';
  return (names.match(/\w+/g) ?? []).slice(0, components);
}

const kComponent = /^(.*)(?:\[(\d+)\]|\.([xyz]{1,2}))$/s;

/** The field that the key means: of a series the instant that is shown; -1 for none. */
export function fieldOfKey(key: string, fields: readonly FieldInfo[]): number {
  const called = (name: string): number => {
    const ofSeries = fieldOfSeries(fields, name);
    return ofSeries >= 0 ? ofSeries : fieldKeys(fields).indexOf(name);
  };
  const own = called(key);
  const [, association, name] = /^(point|cell):(.*)$/s.exec(key) ?? [];
  if (own >= 0 || name === undefined) return own;
  const other = called(name);
  return fields[other]?.association === association ? other : -1;
}

export function parseScalar(text: string | null, fields: readonly FieldInfo[]): Scalar | null {
  if (text === null) return null;
  const whole = fieldOfKey(text, fields);
  if (whole >= 0) return {field: whole, component: kMagnitude};
  const named = namedComponent(text, fields);
  if (!named) return null;
  return hasComponent(named, fields) ? named : {...named, component: kMagnitude};
}

/** The field and the number behind it, whether or not the field has such a component. */
export function namedComponent(text: string, fields: readonly FieldInfo[]): Scalar | null {
  const [, key, number, name] = kComponent.exec(text) ?? [];
  const field = key === undefined ? -1 : fieldOfKey(key, fields);
  const names = field < 0 ? [] : componentNames(fields[field]!.components);
  const component = name === undefined ? Number(number) : names.indexOf(name);
  return field < 0 || component < 0 ? null : {field, component};
}

/** The only value of a field without components is called by the field's name alone. */
export const hasComponent = ({field, component}: Scalar, fields: readonly FieldInfo[]): boolean =>
  fields[field]!.components > 1 && component < fields[field]!.components;

/** The field's key without a component, to ask a server before its fields are known. */
export function scalarKey(text: string): string {
  return kComponent.exec(text)?.[1] ?? text;
}

export function scalarText(scalar: Scalar, fields: readonly FieldInfo[]): string {
  const key = fields[scalar.field]?.instant?.series ?? fieldKeys(fields)[scalar.field] ?? '';
  const {component} = scalar;
  if (component === kMagnitude) return key;
  const name = componentNames(fields[scalar.field]!.components)[component];
  return name ? `${key}.${name}` : `${key}[${component}]`;
}

export interface FieldValues {
  scalar: Scalar;
  values: number[];
}

export function parseFieldValues(
  text: string | null,
  fields: readonly FieldInfo[],
): FieldValues | null {
  const at = text?.lastIndexOf('=') ?? -1;
  if (at < 0) return null;
  const scalar = parseScalar(text!.slice(0, at), fields);
  const values = parseNumbers(text!.slice(at + 1));
  return scalar && values.length > 0 ? {scalar, values} : null;
}

/** Small differences of large values stay: 101325.03. */
const kLinkDigits = 9;

export function fieldValuesText(
  {scalar, values}: FieldValues,
  fields: readonly FieldInfo[],
): string {
  const numbers = values.map((value) => Number(value.toPrecision(kLinkDigits)));
  return `${scalarText(scalar, fields)}=${numbers.join(',')}`;
}

/** The values as shares of the field's scalarRange. */
export function sharesOf({scalar, values}: FieldValues, fields: readonly FieldInfo[]): number[] {
  const [low, high] = scalarRange(fields[scalar.field]!, scalar.component);
  return values.map((value) => (high > low ? (value - low) / (high - low) : 0));
}
