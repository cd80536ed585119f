// Makes a program for blocks of values from the tree of an expression. The program knows the range
// of its result, and how the known errors of the fields bound the result's.

import {componentNames, fieldOfKey} from '../layers/field_values';
import {flowQuantitiesOf, type FlowQuantity} from './flow';
import {kMagnitude} from '../picture/field_scale';
import type {FieldInfo} from '../protocol/fields';
import type {Spread} from '../protocol/manifest';
import {kAll, kOperations, type Block, type Interval, type Operation} from './operations';
import {ExpressionError, type Tree} from './parse';
import {kTensorQuantities, type Quantity} from './tensors';

/** One number of a field: a component, kMagnitude, or a quantity of a tensor. */
export interface Leaf {
  /** The field's name in the expression. That of a series means the shown instant. */
  key: string;
  component: number;
  quantity?: Quantity;
}

/** The gradient of what the steps leave. */
export interface Slope {
  steps: readonly Step[];
}

export type Step = {load: Leaf} | {value: number} | {run: Operation} | {slope: Slope; axis: number};

/** The known error of a result by those of the fields, none as a share of a range. */
export type ErrorRule = (of: (key: string) => Spread) => Spread;

interface Component {
  steps: Step[];
  range: Interval;
}

/** A number has one component. */
export interface Value {
  components: Component[];
  association: FieldInfo['association'] | null;
  /** That of the whole vector; null: no rule bounds it. */
  errors: ErrorRule | null;
  /** It is this field as it is. */
  field?: {key: string; info: FieldInfo};
}

/** Vectors copy the steps that they take: so that these cannot double again and again. */
const kMaxSteps = 1000;
/** Each takes some 50 ms for a million cells, and 32 bytes a vertex while a field is computed. */
export const kMaxSlopes = 12;
/** A message lists so many fields. */
const kListed = 9;

const kExact: Spread = {mean: 0, max: 0};

const kOne: Block = new Float64Array(1);

/**
 * `earlier`: the definitions before this one. `slopes`: those of all of them, so that equal ones
 * are one. The result has one component. Throws ExpressionError.
 */
export function compile(
  tree: Tree,
  fields: readonly FieldInfo[],
  earlier: ReadonlyMap<string, Value> = new Map(),
  slopes: Slope[] = [],
): Value {
  return new Compiler(fields, earlier, slopes).number(tree);
}

/** The names of the fields that the value is made of. */
export function inputsOf({components}: Value): string[] {
  const all = components.flatMap(({steps}) => steps);
  const ofSlopes = [...slopesIn(all)].flatMap((its) => its.steps);
  const keys = [...all, ...ofSlopes].flatMap((step) => ('load' in step ? [step.load.key] : []));
  return [...new Set(keys)];
}

/** Also those that the fields of others are made of. */
function slopesIn(steps: readonly Step[], found = new Set<Slope>()): Set<Slope> {
  for (const step of steps) {
    if (!('slope' in step) || found.has(step.slope)) continue;
    found.add(step.slope);
    slopesIn(step.slope.steps, found);
  }
  return found;
}

class Compiler {
  constructor(
    private readonly fields: readonly FieldInfo[],
    private readonly earlier: ReadonlyMap<string, Value>,
    private readonly slopes: Slope[],
  ) {}

  number(tree: Tree): Value {
    const value = this.value(tree);
    const {length} = value.components;
    if (slopesIn(value.components.flatMap(({steps}) => steps)).size > kMaxSlopes)
      throw fault(tree, `this takes more than ${kMaxSlopes} gradients; leave some of them out`);
    if (length === 1) return value;
    throw fault(tree, `a vector of ${length} components stands here; take mag(...) or .x of it`);
  }

  private value(tree: Tree): Value {
    switch (tree.kind) {
      case 'number':
        return constant(tree.value);
      case 'name':
        return this.named(tree, tree.name);
      case 'part':
        return this.part(tree, this.value(tree.of), tree.part);
      case 'call':
        return this.call(tree);
    }
  }

  /** A field, an earlier definition, or a part of one: U, alpha.water, U.x. */
  private named(tree: Tree, name: string): Value {
    const info = this.fields[fieldOfKey(name, this.fields)];
    const known = info ? valueOf(name, info) : this.earlier.get(name);
    if (known) return known;
    const at = name.lastIndexOf('.');
    const whole = name.slice(0, at);
    if (at > 0 && (fieldOfKey(whole, this.fields) >= 0 || this.earlier.has(whole)))
      return this.part(tree, this.named(tree, whole), name.slice(at + 1));
    const names = new Set(this.fields.map((its) => its.instant?.series ?? its.name));
    const listed = [...names].slice(0, kListed).join(', ');
    throw fault(tree, `there is no field "${name}"; there are ${listed || 'none'}`);
  }

  private part(tree: Tree, value: Value, part: string): Value {
    const flow = flowQuantities(value).find(({name}) => name === part);
    if (!flow) return partOf(tree, value, part);
    return flow.functions.reduce((its, name) => this.ofVectors(tree, name, [its]), value);
  }

  private ofVectors(tree: Tree, name: string, values: Value[]): Value {
    return kOfVectors[name]!.make(tree, values, (its) => this.slopeOf(its));
  }

  private slopeOf({steps}: Component): Slope {
    const known = this.slopes.find((its) => areSame(its.steps, steps));
    if (known) return known;
    this.slopes.push({steps});
    return this.slopes.at(-1)!;
  }

  private call(tree: Extract<Tree, {kind: 'call'}>): Value {
    const {name, args} = tree;
    const special = kOfVectors[name];
    const operation = Object.hasOwn(kOperations, name) ? kOperations[name] : undefined;
    const arity = special?.arity ?? operation?.arity;
    if (arity === undefined)
      throw fault(tree, `there is no function "${name}"; there are ${kFunctions.join(', ')}`);
    if (args.length !== arity) throw fault(tree, `${name} takes ${arity}, not ${args.length}`);
    const values = args.map((its) => this.value(its));
    return special ? this.ofVectors(tree, name, values) : applied(tree, operation!, values);
  }
}

type SlopeOf = (field: Component) => Slope;

/** Functions of vectors, and those of gradients. Another one is a line here. */
const kOfVectors: Record<
  string,
  {arity: number; make(tree: Tree, values: Value[], slopeOf: SlopeOf): Value}
> = {
  __proto__: null as never,
  grad: {
    arity: 1,
    make(tree, [field], slopeOf) {
      const [row] = gradients(tree, 'grad', field!, 1, slopeOf);
      return ofGradients(row!);
    },
  },
  div: {
    arity: 1,
    make(tree, [vector], slopeOf) {
      const rows = gradients(tree, 'div', vector!, 3, slopeOf);
      return ofGradients([
        sumOf(
          tree,
          [0, 1, 2].map((i) => rows[i]![i]!),
        ),
      ]);
    },
  },
  curl: {
    arity: 1,
    make(tree, [vector], slopeOf) {
      const rows = gradients(tree, 'curl', vector!, 3, slopeOf);
      return ofGradients(
        kTurns.map(([j, k]) => operate(tree, kOperations['-']!, [rows[k]![j]!, rows[j]![k]!])),
      );
    },
  },
  /** Half of |rotation|^2 - |strain rate|^2, which is -tr(J J) / 2 (Hunt et al., 1988). */
  Q: {
    arity: 1,
    make(tree, [vector], slopeOf) {
      const rows = gradients(tree, 'Q', vector!, 3, slopeOf);
      const times = (a: Component, b: Component): Component =>
        operate(tree, kOperations['*']!, [a, b]);
      const half = constant(0.5).components[0]!;
      const squares = [0, 1, 2].map((i) => times(half, times(rows[i]![i]!, rows[i]![i]!)));
      const products = kTurns.map(([j, k]) => times(rows[j]![k]!, rows[k]![j]!));
      const sum = sumOf(tree, [...squares, ...products]);
      return ofGradients([operate(tree, kOperations['minus']!, [sum])]);
    },
  },
  mag: {
    arity: 1,
    make(tree, [vector]) {
      const {components, errors, field} = vector!;
      if (components.length === 1) return applied(tree, kOperations['abs']!, [vector!]);
      if (field) return bent(leafOf(vector!, kMagnitude, field.info.range, 1));
      const squares = components.map((its) => operate(tree, kOperations['square']!, [its]));
      const root = operate(tree, kOperations['sqrt']!, [sumOf(tree, squares)]);
      return bent({...vector!, components: [root], errors});
    },
  },
  dot: {
    arity: 2,
    make(tree, values) {
      const [a, b] = values.map(({components}) => components);
      if (a!.length !== b!.length) throw unequal(tree, values);
      const products = a!.map((its, i) => operate(tree, kOperations['*']!, [its, b![i]!]));
      const association = together(tree, values);
      return bent({components: [sumOf(tree, products)], association, errors: ofProduct(values)});
    },
  },
};

/** The two axes behind each axis. */
const kTurns = [
  [1, 2],
  [2, 0],
  [0, 1],
] as const;

/** One a component: its slopes along x, y and z. */
function gradients(
  tree: Tree,
  name: string,
  {components, association, field}: Value,
  length: 1 | 3,
  slopeOf: SlopeOf,
): Component[][] {
  if (association === 'cell') {
    const its = field ? `"${field.key}"` : 'this';
    throw fault(tree, `${its} is of cells, and constant in each; ${name} takes a field of points`);
  }
  if (association === null) throw fault(tree, `${name} takes a field of points, not a number`);
  if (components.length !== length)
    throw fault(
      tree,
      length === 1
        ? `${name} takes a number, not a vector; take mag(...) or .x of it`
        : `${name} takes a vector of 3 components, not of ${components.length}`,
    );
  return components.map((its) => {
    const slope = slopeOf(its);
    return [0, 1, 2].map((axis) => ({steps: [{slope, axis}], range: kAll}));
  });
}

/** Small errors of a field may have steep slopes: no rule bounds the error. */
const ofGradients = (components: Component[]): Value => ({
  components,
  association: 'point',
  errors: null,
});

function areSame(a: readonly Step[], b: readonly Step[]): boolean {
  const partsOf = (step: Step): unknown[] =>
    'load' in step
      ? [step.load.key, step.load.component, step.load.quantity]
      : 'slope' in step
        ? [step.slope, step.axis]
        : 'run' in step
          ? [step.run]
          : [step.value];
  const isSame = (parts: unknown[], others: unknown[]): boolean =>
    parts.length === others.length && parts.every((its, i) => its === others[i]);
  return (
    a === b || (a.length === b.length && a.every((its, i) => isSame(partsOf(its), partsOf(b[i]!))))
  );
}

/** Those that a field of vectors at points has. */
const flowQuantities = ({field}: Value): readonly FlowQuantity[] =>
  field ? flowQuantitiesOf(field.info) : [];

const kFunctions = [
  ...Object.keys(kOfVectors),
  ...Object.keys(kOperations).filter((name) => /^\w/.test(name)),
].filter((name) => !['minus', 'square'].includes(name));

/** Sums, differences and signs are of vectors, too, and products and quotients with a number. */
function applied(
  tree: Extract<Tree, {kind: 'call'}> | Tree,
  operation: Operation,
  values: Value[],
): Value {
  const association = together(tree, values);
  const {'*': times, '/': over, '+': plus, '-': less, minus} = kOperations;
  const lengths = values.map(({components}) => components.length);
  const most = Math.max(...lengths);
  const isScaled = operation === times || (operation === over && lengths[1] === 1);
  const isAdded = [plus, less, minus].includes(operation);
  if (most > 1 && !isScaled && !isAdded)
    throw fault(tree, 'a number is taken here, not a vector; take mag(...) or .x of it');
  if (most > 1 && (isAdded ? lengths.some((its) => its < most) : lengths.every((its) => its > 1)))
    throw isAdded
      ? unequal(tree, values)
      : fault(tree, 'two vectors have no product; take dot(a, b)');
  const components = Array.from({length: most}, (_, c) =>
    operate(
      tree,
      operation === kOperations['^'] && isTwo(values[1]!) ? kOperations['square']! : operation,
      values.map((its) => its.components[its.components.length > 1 ? c : 0]!),
    ),
  );
  const out = {components, association, errors: errorsOf(operation, values)};
  const isConstant = ({components: all}: Value): boolean =>
    all.every((its) => constantOf(its) !== null);
  const isLinear =
    isAdded || (operation === times && values.some(isConstant)) || operation === over;
  return isLinear ? out : bent(out);
}

/**
 * The result of what is not linear. It is computed at points and interpolated between them. So the
 * error of a field of points, which holds everywhere, bounds it there alone: it is not known.
 */
const bent = (value: Value): Value =>
  value.association === 'point' ? {...value, errors: null} : value;

const isTwo = ({components: [its]}: Value): boolean => constantOf(its!) === 2;

/** The rules by which known errors follow; null: there is none. */
function errorsOf(operation: Operation, values: Value[]): ErrorRule | null {
  const [a, b] = values;
  const {'*': times, '/': over, square} = kOperations;
  if (operation.isSteady) return added(values.map(({errors}) => errors));
  if (operation === times) return ofProduct(values);
  if (operation === kOperations['^'] && isTwo(b!)) return ofProduct([a!, a!]);
  if (operation === square) return ofProduct([a!, a!]);
  const divisor = operation === over ? constantOf(b!.components[0]!) : null;
  return divisor === null ? null : scaled(a!.errors, 1 / divisor);
}

function added(all: (ErrorRule | null)[]): ErrorRule | null {
  const rules = all.filter((its) => its !== null);
  if (rules.length < all.length) return null;
  return (of) => {
    const errors = rules.map((rule) => rule(of));
    return {
      mean: errors.reduce((sum, {mean}) => sum + mean, 0),
      max: errors.reduce((sum, {max}) => sum + max, 0),
    };
  };
}

function scaled(rule: ErrorRule | null, by: number): ErrorRule | null {
  return (
    rule &&
    ((of) => {
      const {mean, max} = rule(of);
      return {mean: mean * Math.abs(by), max: max * Math.abs(by)};
    })
  );
}

/** |d(ab)| <= |a| |db| + |b| |da| + |da| |db|, also of vectors, by their lengths. */
function ofProduct([a, b]: Value[]): ErrorRule | null {
  const [ofA, ofB] = [a!.errors, b!.errors];
  const [mostA, mostB] = [largest(a!), largest(b!)];
  if (!ofA || !ofB || !Number.isFinite(mostA * mostB)) return null;
  return (of) => {
    const [da, db] = [ofA(of), ofB(of)];
    return {
      mean: mostA * db.mean + mostB * da.mean + da.max * db.mean,
      max: mostA * db.max + mostB * da.max + da.max * db.max,
    };
  };
}

/** No value is larger, and no vector longer. */
function largest({components, field}: Value): number {
  const ends = (field ? [field.info] : components).map(({range: [low, high]}) =>
    Math.max(Math.abs(low), Math.abs(high)),
  );
  return Math.hypot(...ends);
}

const constantOf = ({steps}: Component): number | null =>
  steps.length === 1 && 'value' in steps[0]! ? steps[0].value : null;

function constant(value: number): Value {
  return {
    components: [{steps: [{value}], range: [value, value]}],
    association: null,
    errors: () => kExact,
  };
}

function valueOf(key: string, info: FieldInfo): Value {
  const {association, components, instant} = info;
  const most = Math.max(Math.abs(info.range[0]), Math.abs(info.range[1]));
  const field = {key, info};
  const all = info.minimum.map((low, component): Component => {
    const ofStep: Interval = [low, low + info.step * (2 ** (info.bits ?? 0) - 1)];
    const [from, to] = instant?.ranges[component] ?? ofStep;
    const range =
      components === 1 ? info.range : ([Math.max(from, -most), Math.min(to, most)] as const);
    return {steps: [{load: {key, component}}], range};
  });
  return {components: all, association, errors: (of) => of(key), field};
}

/** A number of the field that `vector` is. */
function leafOf(
  {association, field}: Value,
  component: number,
  range: Interval,
  factor: number,
  quantity?: Quantity,
): Value {
  const {key} = field!;
  const load = {key, component, ...(quantity && {quantity})};
  return {
    components: [{steps: [{load}], range}],
    association,
    errors: scaled((of) => of(key), factor),
  };
}

function partOf(tree: Tree, value: Value, part: string): Value {
  const {components, field} = value;
  const names = componentNames(components.length);
  const i = /^\d+$/.test(part) ? Number(part) : names.indexOf(part);
  const component = components.length > 1 ? components[i] : undefined;
  if (component)
    return {components: [component], association: value.association, errors: value.errors};
  const quantities = field && components.length === 6 ? kTensorQuantities : [];
  const quantity = quantities.find(({name}) => name === part);
  if (quantity) {
    const most = quantity.factor * field!.info.range[1];
    const range: Interval = [quantity.isSigned ? -most : 0, most];
    const made = leafOf(value, kMagnitude, range, quantity.factor, quantity);
    return quantity.isLinear ? made : bent(made);
  }
  const all = [...names, ...[...quantities, ...flowQuantities(value)].map(({name}) => name)];
  const has =
    components.length === 1
      ? 'a number has no parts'
      : `it has ${all.join(', ') || `[0] to [${components.length - 1}]`}`;
  throw fault(tree, `there is no "${part}" here; ${has}`);
}

function sumOf(tree: Tree, all: Component[]): Component {
  return all.reduce((sum, its) => operate(tree, kOperations['+']!, [sum, its]));
}

/** Numbers alone are computed at once. */
function operate(tree: Tree, operation: Operation, args: Component[]): Component {
  const used = args.slice(0, operation.arity);
  const numbers = used.map(constantOf);
  if (numbers.every((its) => its !== null)) {
    const [a = kOne, b = kOne, c = kOne] = numbers.map((its) => Float64Array.of(its));
    operation.run(1, a, a, b, c);
    return constant(a[0]!).components[0]!;
  }
  const steps = [...used.flatMap((its) => its.steps), {run: operation}];
  if (steps.length > kMaxSteps)
    throw fault(tree, `this takes more than ${kMaxSteps} steps; leave some of them out`);
  const [a, b = a, c = a] = used.map(({range}) => range);
  return {steps, range: operation.range(a!, b!, c!)};
}

/** Fields of points and those of cells have no values at the same places. */
function together(tree: Tree, values: Value[]): Value['association'] {
  const all = new Set(values.flatMap(({association}) => association ?? []));
  if (all.size > 1)
    throw fault(tree, 'one field is of points, the other of cells; take fields of one kind');
  return [...all][0] ?? null;
}

function unequal(tree: Tree, values: Value[]): ExpressionError {
  const [a, b] = values.map(({components}) => components.length);
  return fault(tree, `one side has ${a} components, the other ${b}; take as many of both`);
}

function fault({at}: Tree, message: string): ExpressionError {
  return new ExpressionError(at, message);
}
