// A label's values in a picture to publish: swatches with texts, in columns.

/** A letter of a text of 12.5 pixels; the swatch, and the space behind it and behind the text. */
const kLetter = 7;
const kSwatch = 18;
const kBehind = 8;
const kApart = 14;
/** More are hard to read in order. */
const kMaxColumns = 6;

export interface LabelText {
  text: string;
  /** As CSS. */
  color: string;
}

export interface Grid {
  columns: number;
  rows: number;
  /** That of a column. */
  each: number;
}

/** As many columns as the longest text leaves room for in a width of `most`, and fill it evenly. */
export function gridOf(labels: readonly LabelText[], most: number): Grid {
  const longest = Math.max(...labels.map(({text}) => text.length));
  const wanted = kSwatch + kBehind + kLetter * longest + kApart;
  const fitting = Math.max(1, Math.min(kMaxColumns, Math.floor(most / wanted)));
  const rows = Math.ceil(labels.length / fitting);
  return {columns: Math.ceil(labels.length / rows), rows, each: Math.min(most, wanted)};
}

/** The swatch beside a text whose foot is at y. */
export function drawSwatch(
  context: OffscreenCanvasRenderingContext2D,
  color: string,
  x: number,
  y: number,
): void {
  context.fillStyle = color;
  context.fillRect(x, y - 9, kSwatch, 10);
}

/** Where a text stands beside its swatch. */
export const kIndent = kSwatch + kBehind;
