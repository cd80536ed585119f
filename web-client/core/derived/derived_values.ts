// The values of derived fields, for the mesh as it is now.

import type {derivation, DerivedColor, Drawn} from '../picture/derivation';
import {derivedIn, type RestMesh, type ShownDerived, type ValuesOf} from '../picture/derived_field';
import type {Display, MeshArrays} from '../picture/display';
import {FieldScale} from '../picture/field_scale';
import type {FieldInfo} from '../protocol/fields';
import type {Manifest} from '../protocol/manifest';
import {evaluate} from './evaluate';
import {inputsOf, type Value} from './program';

/** A display of an older text is drawn until the page has the answer about a newer one. */
const kKeptTexts = 8;
/** By id: what the last texts derived. */
const known = new Map<number, Value>();
let nextId = 0;
/** The first ids of these texts. */
const firstIds: number[] = [];

/** Another text is derived: the oldest one ends. */
export function beginText(): void {
  firstIds.push(nextId);
  if (firstIds.length > kKeptTexts) firstIds.shift();
  for (const ended of [known, extents, kept])
    for (const id of ended.keys()) if (id < firstIds[0]!) ended.delete(id);
}

/** Returns its id. */
export function keep(value: Value): number {
  known.set(nextId, value);
  return nextId++;
}

class DerivedScale extends FieldScale {
  constructor(
    private readonly derived: Float64Array,
    info: FieldInfo,
  ) {
    super(new Int32Array(0), info);
  }

  override get size(): number {
    return this.derived.length;
  }

  override at(index: number): number {
    return (this.derived[index]! - this.low) * this.inverseSpan;
  }
}

type Shown = ShownDerived['fields'][number];

/** Colours, isosurfaces, a threshold and the lines of a card have each another derived field. */
const kKept = 8;
/** The last values by id, and what they were made of. */
const kept = new Map<number, {of: unknown[]; scale: FieldScale}>();

/** A derived field's values for the mesh as it is now; null while a field of it has none. */
function derivedScale(
  {id, info, inputs}: Shown,
  valuesOf: ValuesOf,
  mesh: RestMesh,
): FieldScale | null {
  const value = known.get(id);
  const all = inputs.map(valuesOf).filter((its) => its !== null);
  if (!value || all.length === 0 || all.length < inputs.length) return null;
  const of = all.flatMap((its) => [its.info, its.state]);
  const last = kept.get(id);
  if (last?.of.length === of.length && of.every((its, i) => its === last.of[i])) return last.scale;
  const named = new Map(inputsOf(value).map((key, i) => [key, all[i]!]));
  const count = Math.min(...all.map((its) => its.values.length / its.info.components));
  const scale = new DerivedScale(evaluate(value.components[0]!.steps, named, count, mesh), info);
  kept.delete(id);
  kept.set(id, {of, scale});
  for (const oldest of [...kept.keys()].slice(0, -kKept)) kept.delete(oldest);
  return scale;
}

/** By id of a colour of a series: its range grows as it plays. */
const extents = new Map<number, [number, number]>();

function derivedColor(
  {tetrahedra}: MeshArrays,
  display: Display,
  scale: FieldScale,
  {fields}: Manifest,
): DerivedColor | undefined {
  const derived = display.color && derivedIn(display, display.color.field);
  if (!derived) return undefined;
  const {id, inputs} = derived;
  const made = {derivedId: id, inputs};
  const now = scale.extent(tetrahedra);
  if (!inputs.some((field) => fields[field]?.instant))
    return {extent: now, ofSeries: undefined, made};
  const [low, high] = extents.get(id) ?? now;
  const extent: [number, number] = [Math.min(low, now[0]), Math.max(high, now[1])];
  extents.set(id, extent);
  return {extent, ofSeries: extent, made};
}

function inputsOfBoth(wanted: Display, {color, inputs = []}: Drawn): [number, number][] {
  const derived = wanted.color && derivedIn(wanted, wanted.color.field);
  const isSame = derived?.inputs.length === inputs.length && color?.field === wanted.color?.field;
  return isSame ? derived.inputs.map((field, i) => [field, inputs[i]!]) : [];
}

function held(wanted: Display, drawn: Drawn): Display {
  const before = inputsOfBoth(wanted, drawn).map(([, its]) => its);
  if (before.length === 0) return wanted;
  const {first, fields} = wanted.derived!;
  const at = wanted.color!.field - first;
  const all = fields.map((its, i) => (i === at ? {...its, inputs: before} : its));
  return {...wanted, derived: {first, fields: all}};
}

export const kDerivation: typeof derivation = {
  scale: derivedScale,
  color: derivedColor,
  inputs: inputsOfBoth,
  held,
};
