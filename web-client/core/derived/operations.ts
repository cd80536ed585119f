// The operators and functions of numbers. They work on blocks of values, and know the range of
// their results. Another one is a line in kOperations. NaN is a missing value, and stays one.

export type Block = Float64Array;
/** The least and the largest value. */
export type Interval = readonly [number, number];

export interface Operation {
  arity: 1 | 2 | 3;
  /** `out` may be `a`, `b` or `c`. */
  run: (count: number, out: Block, a: Block, b: Block, c: Block) => void;
  range(a: Interval, b: Interval, c: Interval): Interval;
  /** A change of the arguments changes the result by no more than the sum of theirs. */
  isSteady?: true;
}

/** No bound is known. */
export const kAll: Interval = [-Infinity, Infinity];
const kSigns: Interval = [-1, 1];

export const kOperations: Record<string, Operation> = {
  // The first ones have loops of their own: a call for each value takes three times as long.
  '+': {
    arity: 2,
    run: (count, out, a, b) => {
      for (let i = 0; i < count; ++i) out[i] = a[i]! + b[i]!;
    },
    range: (a, b) => [a[0] + b[0], a[1] + b[1]],
    isSteady: true,
  },
  '-': {
    arity: 2,
    run: (count, out, a, b) => {
      for (let i = 0; i < count; ++i) out[i] = a[i]! - b[i]!;
    },
    range: (a, b) => [a[0] - b[1], a[1] - b[0]],
    isSteady: true,
  },
  '*': {
    arity: 2,
    run: (count, out, a, b) => {
      for (let i = 0; i < count; ++i) out[i] = a[i]! * b[i]!;
    },
    range: (a, b) => atCorners(a, b, (x, y) => x * y || 0), // 0 * Infinity bounds nothing away
  },
  '/': {
    arity: 2,
    run: (count, out, a, b) => {
      for (let i = 0; i < count; ++i) out[i] = a[i]! / b[i]!;
    },
    range: (a, b) => (b[0] <= 0 && b[1] >= 0 ? kAll : atCorners(a, b, (x, y) => x / y)),
  },
  minus: {
    arity: 1,
    run: (count, out, a) => {
      for (let i = 0; i < count; ++i) out[i] = -a[i]!;
    },
    range: (a) => [-a[1], -a[0]],
    isSteady: true,
  },
  square: {
    arity: 1,
    run: (count, out, a) => {
      for (let i = 0; i < count; ++i) out[i] = a[i]! * a[i]!;
    },
    range: (a) => {
      const [low, high] = absolute(a);
      return [low * low, high * high];
    },
  },
  sqrt: {
    arity: 1,
    run: (count, out, a) => {
      for (let i = 0; i < count; ++i) out[i] = Math.sqrt(a[i]!);
    },
    range: (a) => rising(a, (x) => Math.sqrt(Math.max(0, x))),
  },
  '^': {
    arity: 2,
    run: each2((a, b) => (Number.isNaN(a) ? a : a ** b)),
    range: (a, b) => (a[0] > 0 ? atCorners(a, b, (x, y) => x ** y) : kAll),
  },
  abs: {arity: 1, run: each1(Math.abs), range: absolute, isSteady: true},
  exp: {arity: 1, run: each1(Math.exp), range: (a) => rising(a, Math.exp)},
  log: {
    arity: 1,
    run: each1(Math.log),
    range: (a) => rising(a, (x) => Math.log(Math.max(0, x))),
  },
  sin: {arity: 1, run: each1(Math.sin), range: () => kSigns, isSteady: true},
  cos: {arity: 1, run: each1(Math.cos), range: () => kSigns, isSteady: true},
  min: {
    arity: 2,
    run: each2((a, b) => Math.min(a, b)),
    range: (a, b) => [Math.min(a[0], b[0]), Math.min(a[1], b[1])],
    isSteady: true,
  },
  max: {
    arity: 2,
    run: each2((a, b) => Math.max(a, b)),
    range: (a, b) => [Math.max(a[0], b[0]), Math.max(a[1], b[1])],
    isSteady: true,
  },
  '<': comparison((a, b) => a < b),
  '<=': comparison((a, b) => a <= b),
  '>': comparison((a, b) => a > b),
  '>=': comparison((a, b) => a >= b),
  '==': comparison((a, b) => a === b),
  '!=': comparison((a, b) => a !== b),
  '?:': {
    arity: 3,
    run: (count, out, a, b, c) => {
      for (let i = 0; i < count; ++i)
        out[i] = Number.isNaN(a[i]) ? NaN : a[i] !== 0 ? b[i]! : c[i]!;
    },
    range: (_, b, c) => [Math.min(b[0], c[0]), Math.max(b[1], c[1])],
  },
};

function each1(f: (a: number) => number): Operation['run'] {
  return (count, out, a) => {
    for (let i = 0; i < count; ++i) out[i] = f(a[i]!);
  };
}

function each2(f: (a: number, b: number) => number): Operation['run'] {
  return (count, out, a, b) => {
    for (let i = 0; i < count; ++i) out[i] = f(a[i]!, b[i]!);
  };
}

/** 1 for yes, 0 for no. */
function comparison(holds: (a: number, b: number) => boolean): Operation {
  const run = each2((a, b) => (Number.isNaN(a + b) ? NaN : holds(a, b) ? 1 : 0));
  return {arity: 2, run, range: () => [0, 1]};
}

function atCorners(a: Interval, b: Interval, f: (x: number, y: number) => number): Interval {
  const corners = a.flatMap((x) => b.map((y) => f(x, y)));
  return [Math.min(...corners), Math.max(...corners)];
}

function rising(a: Interval, f: (x: number) => number): Interval {
  return [f(a[0]), f(a[1])];
}

function absolute([low, high]: Interval): Interval {
  const most = Math.max(-low, high);
  return low <= 0 && high >= 0 ? [0, most] : [Math.min(Math.abs(low), Math.abs(high)), most];
}
