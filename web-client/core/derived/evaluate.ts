// Computes a program's values, block by block, so that all that a block needs stays in the
// processor's cache.

import type {RestMesh} from '../picture/derived_field';
import {kMissing} from '../picture/field_scale';
import type {FieldInfo} from '../protocol/fields';
import type {Block} from './operations';
import type {Leaf, Slope, Step} from './program';
import {kSlopeWidth, slopesOf} from './slopes';

/** With a few blocks of 8 kB each a program stays in the first cache of 32 kB. */
const kBlock = 1024;

/** A field's integers, as the codec has them. */
export interface Input {
  info: FieldInfo;
  values: Int32Array;
}

/**
 * A value for each of `count` vertices or cells; NaN where one is missing or is not finite.
 * REQUIRES: the steps leave one value, and `inputs` has all of their fields. Gradients are those in
 * `mesh`.
 */
export function evaluate(
  steps: readonly Step[],
  inputs: ReadonlyMap<string, Input>,
  count: number,
  mesh: RestMesh,
): Float64Array {
  return run(steps, inputs, count, slopesFor(steps, inputs, count, mesh, new Map()));
}

/** All that the steps need, added to `known`. Those of one depth take one pass of the mesh. */
function slopesFor(
  steps: readonly Step[],
  inputs: ReadonlyMap<string, Input>,
  count: number,
  mesh: RestMesh,
  known: Map<Slope, Float64Array>,
): Map<Slope, Float64Array> {
  const wanted = steps.flatMap((step) => ('slope' in step ? [step.slope] : []));
  const missing = (): Slope[] => [...new Set(wanted)].filter((its) => !known.has(its));
  for (const slope of missing()) slopesFor(slope.steps, inputs, count, mesh, known);
  const all = missing();
  const fields = all.map((slope) => run(slope.steps, inputs, count, known));
  slopesOf(mesh, fields).forEach((its, i) => known.set(all[i]!, its));
  return known;
}

function run(
  steps: readonly Step[],
  inputs: ReadonlyMap<string, Input>,
  count: number,
  slopes: ReadonlyMap<Slope, Float64Array>,
): Float64Array {
  const values = new Float64Array(count);
  /** By name: what is loaded once for a block, however often it is used. */
  const loads = new Map<string, {leaf: Leaf; into: Block}>();
  const blockOf = (leaf: Leaf): Block => {
    const name = JSON.stringify([leaf.key, leaf.component, leaf.quantity?.name]);
    const its = loads.get(name) ?? {leaf, into: newBlock()};
    loads.set(name, its);
    return its.into;
  };
  const given = steps.map((step) =>
    'load' in step
      ? blockOf(step.load)
      : 'value' in step
        ? newBlock().fill(step.value)
        : 'slope' in step
          ? newBlock()
          : null,
  );
  const rises = steps.flatMap((step, i) =>
    'slope' in step ? [{all: slopes.get(step.slope)!, axis: step.axis, into: given[i]!}] : [],
  );
  const results: Block[] = [];
  const stack: Block[] = [];
  for (let from = 0; from < count; from += kBlock) {
    const length = Math.min(kBlock, count - from);
    for (const {leaf, into} of loads.values())
      load(leaf, inputs.get(leaf.key)!, from, length, into);
    for (const {all, axis, into} of rises)
      for (let i = 0, at = kSlopeWidth * from + axis; i < length; ++i, at += kSlopeWidth)
        into[i] = all[at]!;
    let top = 0;
    for (let i = 0; i < steps.length; ++i) {
      const step = steps[i]!;
      if ('run' in step) {
        top -= step.run.arity;
        const out = (results[top] ??= newBlock());
        step.run.run(length, out, stack[top]!, stack[top + 1]!, stack[top + 2]!);
        stack[top++] = out;
      } else {
        stack[top++] = given[i]!;
      }
    }
    const [result] = stack as [Block];
    for (let i = 0; i < length; ++i)
      values[from + i] = Number.isFinite(result[i]) ? result[i]! : NaN;
  }
  return values;
}

const newBlock = (): Block => new Float64Array(kBlock);

function load(
  {component, quantity}: Leaf,
  {info, values}: Input,
  from: number,
  length: number,
  into: Block,
): void {
  const {components, minimum, step} = info;
  if (component >= 0) {
    const low = minimum[component]!;
    for (let i = 0, at = from * components + component; i < length; ++i, at += components) {
      const integer = values[at]!;
      into[i] = integer === kMissing ? NaN : low + step * integer;
    }
    return;
  }
  const tuple = new Float64Array(components);
  for (let i = 0, at = from * components; i < length; ++i) {
    let squares = 0;
    for (let c = 0; c < components; ++c, ++at) {
      const integer = values[at]!;
      const value = integer === kMissing ? NaN : minimum[c]! + step * integer;
      tuple[c] = value;
      squares += value * value;
    }
    into[i] = quantity ? quantity.of(tuple) : Math.sqrt(squares);
  }
}
