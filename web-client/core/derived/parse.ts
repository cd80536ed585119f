// From the text of an expression to its tree. The text is a stranger's: an address may hold it.

/** Nobody reads a longer formula, and links with several of them stay below 8 kB. */
export const kMaxText = 1000;
/** Parentheses, signs and choices in each other: the parser's stack stays small. */
export const kMaxDepth = 50;
/** Each takes some 2 ms for a million values, so that a picture waits at most half a second. */
export const kMaxOperators = 200;

/** `at` is where it stands in the text, from 0 on. */
export type Tree = {at: number} & (
  | {kind: 'number'; value: number}
  | {kind: 'name'; name: string}
  /** A component or another quantity: "x" of `U.x`, "0" of `U[0]`. */
  | {kind: 'part'; of: Tree; part: string}
  /** An operator or a function, by its name in kOperations. */
  | {kind: 'call'; name: string; args: Tree[]}
);

/** Something is wrong at a place in the text. */
export class ExpressionError extends Error {
  constructor(
    readonly at: number,
    message: string,
  ) {
    super(message);
  }
}

/** A name may have points and a time: alpha.water, T@0.5. */
const kToken = new RegExp(
  [
    String.raw`(?<number>(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)`,
    String.raw`(?<name>[\p{L}_][\p{L}\p{N}_]*(?:\.[\p{L}_][\p{L}\p{N}_]*)*` +
      String.raw`(?:@-?(?:\d+(?:\.\d+)?|\.\d+)(?:e[+-]?\d+)?)?)`,
    '(?<quoted>`[^`]*`|"[^"]*"|\'[^\']*\')',
    String.raw`(?<sign>[<>=!]=|[-+*\/^<>?:(),.[\]\u2212])`,
  ].join('|'),
  'iuy',
);

interface Token {
  kind: 'number' | 'name' | 'quoted' | 'sign' | 'end';
  text: string;
  at: number;
}

/** From those that bind least to those that bind most. */
const kLevels = [
  ['<', '<=', '>', '>=', '==', '!='],
  ['+', '-'],
  ['*', '/'],
];

/** Throws ExpressionError. */
export function parseExpression(text: string): Tree {
  if (text.length > kMaxText)
    throw new ExpressionError(
      kMaxText,
      `the text is longer than ${kMaxText} characters; define parts of it as fields of their own`,
    );
  return new Parser(tokensOf(text)).whole();
}

function tokensOf(text: string): Token[] {
  const tokens: Token[] = [];
  for (let at = 0; ;) {
    while (/\s/.test(text[at] ?? '')) ++at;
    if (at === text.length) return [...tokens, {kind: 'end', text: '', at}];
    kToken.lastIndex = at;
    const found = kToken.exec(text);
    if (!found) throw unreadable(text, at);
    const groups: Record<string, string | undefined> = found.groups!;
    const kind = Object.keys(groups).find((its) => groups[its] !== undefined);
    tokens.push({kind: kind as Token['kind'], text: found[0].replace('\u2212', '-'), at});
    at += found[0].length;
  }
}

function unreadable(text: string, at: number): ExpressionError {
  const letter = String.fromCodePoint(text.codePointAt(at)!);
  if (/[`"']/.test(letter))
    return new ExpressionError(at, `the name that begins with ${letter} has no end; close it`);
  const advice = letter === '=' ? 'equality is ==' : 'names with such letters stand in `...`';
  return new ExpressionError(at, `"${letter}" means nothing here; ${advice}`);
}

class Parser {
  private next = 0;
  private depth = 0;
  private operators = 0;

  constructor(private readonly tokens: Token[]) {}

  whole(): Tree {
    const tree = this.choice();
    const {kind} = this.now;
    if (kind !== 'end') throw this.unexpected('an operator');
    return tree;
  }

  /** `c ? a : b` */
  private choice(): Tree {
    return this.deeper(() => {
      const condition = this.level(0);
      const {at} = this.now;
      if (!this.takes('?')) return condition;
      const yes = this.choice();
      this.expect(':');
      return this.call(at, '?:', [condition, yes, this.choice()]);
    });
  }

  private level(i: number): Tree {
    const signs = kLevels[i];
    if (!signs) return this.signed();
    let tree = this.level(i + 1);
    for (let {now} = this; now.kind === 'sign' && signs.includes(now.text); now = this.now) {
      ++this.next;
      tree = this.call(now.at, now.text, [tree, this.level(i + 1)]);
    }
    return tree;
  }

  /** -a^b is -(a^b). */
  private signed(): Tree {
    const {at} = this.now;
    if (this.takes('+')) return this.deeper(() => this.signed());
    if (this.takes('-')) return this.deeper(() => this.call(at, 'minus', [this.signed()]));
    return this.power();
  }

  /** a^b^c is a^(b^c). */
  private power(): Tree {
    const base = this.parts();
    const {at} = this.now;
    if (!this.takes('^')) return base;
    return this.deeper(() => this.call(at, '^', [base, this.signed()]));
  }

  private parts(): Tree {
    let of = this.primary();
    for (let {at} = this.now; ; at = this.now.at) {
      if (this.takes('.')) of = this.call(at, 'part', [of], this.word('name', 'x, y or z'));
      else if (this.takes('[')) {
        of = this.call(at, 'part', [of], this.word('number', 'the number of a component'));
        this.expect(']');
      } else return of;
    }
  }

  private primary(): Tree {
    const {kind, text, at} = this.now;
    if (kind === 'number') {
      ++this.next;
      return {kind, at, value: Number(text)};
    }
    if (kind === 'quoted') {
      ++this.next;
      return {kind: 'name', at, name: text.slice(1, -1)};
    }
    if (kind === 'name') {
      ++this.next;
      return this.takes('(') ? this.call(at, text, this.list()) : {kind, at, name: text};
    }
    if (!this.takes('(')) throw this.unexpected('a field, a number or "("');
    const tree = this.choice();
    this.expect(')');
    return tree;
  }

  /** Behind "(". */
  private list(): Tree[] {
    const args = [this.choice()];
    while (this.takes(',')) args.push(this.choice());
    this.expect(')');
    return args;
  }

  private call(at: number, name: string, args: Tree[], part?: string): Tree {
    if (++this.operators > kMaxOperators)
      throw new ExpressionError(
        at,
        `there are more than ${kMaxOperators} operators; leave some out`,
      );
    return part === undefined
      ? {kind: 'call', at, name, args}
      : {kind: 'part', at, of: args[0]!, part};
  }

  private word(kind: 'name' | 'number', expected: string): string {
    if (this.now.kind !== kind) throw this.unexpected(expected);
    return this.tokens[this.next++]!.text;
  }

  private deeper(read: () => Tree): Tree {
    if (++this.depth > kMaxDepth)
      throw new ExpressionError(
        this.now.at,
        `more than ${kMaxDepth} parts stand in each other; define some as fields of their own`,
      );
    const tree = read();
    --this.depth;
    return tree;
  }

  private get now(): Token {
    return this.tokens[this.next]!;
  }

  private takes(sign: string): boolean {
    const {kind, text} = this.now;
    const isHere = kind === 'sign' && text === sign;
    if (isHere) ++this.next;
    return isHere;
  }

  private expect(sign: string): void {
    if (!this.takes(sign)) throw this.unexpected(`"${sign}"`);
  }

  private unexpected(expected: string): ExpressionError {
    const {kind, text, at} = this.now;
    const found = kind === 'end' ? 'the text ends' : `"${text}" stands`;
    return new ExpressionError(at, `${found} where ${expected} is expected`);
  }
}
