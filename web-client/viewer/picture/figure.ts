// A picture to publish: the mesh in tiles, and what stands round it. Its sizes are those of a
// picture of kUnitPixels and grow with it.

import type {Axes} from '../../webgl/lens';
import type {Frame, Rendered} from '../../webgl/view';
import {kRulerRoom, kRulerText, rulerOf, type Canvas, type Line} from '../panels/ruler';
import {drawSwatch, gridOf, kIndent, type Grid, type LabelText} from './label_list';
import type {Scale} from '../settings/length_unit';
import {facePlaces, kHalf} from '../panels/orientation_cube';

/** A text of 14 of these pixels is legible on a slide and, with two columns, on paper. */
const kUnitPixels = 960 * 640;
const kGap = 24;
const kTitle = 22;
const kText = 14;
const kSmallText = 12.5;
const kLine = 1.4;
const kBarWidth = 380;
const kBarHeight = 12;
/** Between the bar and the arrow that says that values lie beyond. */
const kArrowGap = 2;
const kAxis = 34;
/** The opacity of lines across the ruler's faces. */
const kFaint = 0.25;
/** Texts leave at least this share of the height to the mesh. */
const kMinFree = 0.4;

/** The sides of 8K. Browsers make no much larger pictures. */
const kMaxSide = 7680;
const kMaxPixels = 7680 * 4320;
/** Smaller ones have no room for a legend. */
const kMinSide = 100;

/** Inks of a light ground. */
const kInk = '#16202c';
const kSoftInk = '#556273';
/** The axes' colours, legible on both grounds. */
const kAxisInks = ['#d0453c', '#2f9150', '#3b78d8'];

export type Ground = 'white' | 'transparent' | 'seen';

export interface Figure {
  width: number;
  height: number;
  ground: Ground;
  hasLegend: boolean;
  hasAxes: boolean;
  /** Empty: none. */
  title: string;
  unit: string;
}

/** The page's legend as texts and places in [0, 1]; null if nothing is coloured. */
export interface LegendTexts {
  name: string;
  factor: string;
  /** A CSS gradient. */
  gradient: string;
  ticks: {at: number; label: string}[];
  /** The colours of values beyond the first, and the last end; empty: there are none. */
  endColors: [string, string];
  marks: number[];
  /** They are listed instead of a bar; none: the bar is drawn. */
  labels: LabelText[];
  notes: string[];
  /** The colour of what has no value; empty: everything has one. */
  missing: string;
}

/** The box with numbers round the mesh. */
export interface RulerScale extends Scale {
  /** In lattice coordinates. */
  bounds: readonly number[];
}

/** The look of the page. */
export interface Looks {
  ink: string;
  softInk: string;
  ground: string;
  /** A CSS gradient over the ground, or another background. */
  back: string;
  font: string;
  axes: Axes;
  /** Null: there is none. */
  ruler: RulerScale | null;
}

/** Reads the legend from the page, so that both say the same. */
export function legendOf(root: ParentNode): LegendTexts | null {
  const legend = root.querySelector<HTMLElement>('.legend')!;
  if (legend.hidden) return null;
  const part = (name: string): HTMLElement => legend.querySelector<HTMLElement>(`.legend-${name}`)!;
  const text = (name: string): string => (part(name).hidden ? '' : part(name).textContent);
  const endColor = (end: string): string => part('bar').style.getPropertyValue(`--${end}`);
  const at = (its: HTMLElement): number => parseFloat(its.style.left) / 100;
  const time = root.querySelector<HTMLElement>('.time')!;
  const notes = [
    part('labels').hidden ? '' : (part('labels').querySelector('.more')?.textContent ?? ''),
    time.hidden ? '' : (time.querySelector('input')?.getAttribute('aria-valuetext') ?? ''),
    text('note'),
    text('warp'),
    text('missing').trim(),
  ];
  return {
    name: text('name'),
    factor: text('factor'),
    gradient: getComputedStyle(part('bar')).backgroundImage,
    ticks: [...part('ticks').children].map((its) => ({
      at: at(its as HTMLElement),
      label: its.textContent,
    })),
    endColors: [endColor('below'), endColor('above')],
    marks: [...part('bar').children].map((its) => at(its as HTMLElement)),
    labels: part('labels').hidden ? [] : [...part('labels').children].flatMap(labelOf),
    notes: notes.filter(Boolean),
    missing: notes.at(-1)
      ? getComputedStyle(part('missing').querySelector('i')!).backgroundColor
      : '',
  };
}

/** None of the row that says how many more there are. */
function labelOf(row: Element): LabelText[] {
  const swatch = row.querySelector('i');
  return swatch ? [{text: row.textContent, color: swatch.style.background}] : [];
}

/** [share, colour] of a CSS gradient's stops. Without shares they are evenly spaced. */
export function stopsOf(gradient: string): [number, string][] {
  const stops = [...gradient.matchAll(/(rgba?\([^)]*\)|#\w+)((?: [\d.]+%)*)/g)];
  return stops.flatMap(([, color, shares], i): [number, string][] => {
    const given = shares!.match(/[\d.]+/g)?.map((share) => Number(share) / 100);
    return (given ?? [i / Math.max(1, stops.length - 1)]).map((share) => [share, color!]);
  });
}

/** A sentence if there is no picture of this size; empty: there is one. */
export function refusalOf({width, height}: Pick<Figure, 'width' | 'height'>): string {
  const isSide = (pixels: number): boolean =>
    Number.isInteger(pixels) && pixels >= kMinSide && pixels <= kMaxSide;
  if (!isSide(width) || !isSide(height))
    return `Width and height are whole numbers from ${kMinSide} to ${kMaxSide}.`;
  return width * height > kMaxPixels ? 'A picture has at most 7680 × 4320 pixels.' : '';
}

/** Pixels of the picture in a unit. */
export const unitOf = ({width, height}: Pick<Figure, 'width' | 'height'>): number =>
  Math.sqrt((width * height) / kUnitPixels);

/** Between the axes and as much on the other side. */
const freeWidth = (figure: Pick<Figure, 'width' | 'height'>): number =>
  figure.width / unitOf(figure) - 2 * (kGap + 2 * kAxis + kText);

function legendHeight({labels, notes}: LegendTexts, most: number): number {
  const isList = labels.length > 0;
  const rows = notes.length + (isList ? gridOf(labels, most).rows : 1);
  return kText * kLine + 8 + (isList ? 0 : kBarHeight + 6) + kSmallText * kLine * rows;
}

/** The frame of the figure's mesh. `canvas` is the page's, in CSS pixels. */
export function frameOf(
  figure: Figure,
  legend: LegendTexts | null,
  canvas: {clientWidth: number; clientHeight: number},
  hasRuler = false,
): Frame {
  const {width, height, title, hasLegend} = figure;
  const above = title ? kTitle * kLine : 0;
  const below = hasLegend && legend ? legendHeight(legend, freeWidth(figure)) : 0;
  const [top, bottom] = [above, below].map((its) =>
    its > 0 ? ((its + kGap) * unitOf(figure)) / height : 0,
  );
  const share = Math.min(1, (1 - kMinFree) / Math.max(top! + bottom!, Number.MIN_VALUE));
  return {
    width,
    height,
    insets: {left: 0, right: 0, top: share * top!, bottom: share * bottom!},
    boxed: hasRuler
      ? [(kRulerRoom[0] * unitOf(figure)) / width, (kRulerRoom[1] * unitOf(figure)) / height]
      : null,
    pixelRatio: Math.sqrt((width * height) / (canvas.clientWidth * canvas.clientHeight)),
  };
}

export function draw(
  figure: Figure,
  {tiles, toCanvas}: Rendered,
  legend: LegendTexts | null,
  looks: Looks,
): OffscreenCanvas {
  const canvas = new OffscreenCanvas(figure.width, figure.height);
  const context = canvas.getContext('2d')!;
  const {title, hasLegend, hasAxes} = figure;
  fillGround(context, figure, looks);
  const its = figure.ground === 'seen' ? looks : {...looks, ink: kInk, softInk: kSoftInk};
  const scale = unitOf(figure);
  const width = figure.width / scale;
  const height = figure.height / scale;
  const pen = new Pen(context, its);
  context.scale(scale, scale);
  if (looks.ruler) drawRuler(pen, looks.ruler, {toCanvas, width, height});
  for (const {x, y, bitmap} of tiles)
    context.drawImage(bitmap, x / scale, y / scale, bitmap.width / scale, bitmap.height / scale);
  if (title) pen.write(title, kTitle, width / 2, kGap + kTitle, {align: 'center', bold: true});
  if (hasLegend && legend) drawLegend(pen, legend, figure, height);
  if (hasAxes) drawAxes(pen, kGap + kAxis + kText / 2, height - kGap - kAxis - kText / 2);
  return canvas;
}

interface Writing {
  align?: CanvasTextAlign;
  bold?: boolean;
  soft?: boolean;
  maxWidth?: number;
}

class Pen {
  constructor(
    readonly context: OffscreenCanvasRenderingContext2D,
    readonly looks: Looks,
  ) {}

  write(text: string, size: number, x: number, y: number, how: Writing = {}): void {
    const {context, looks} = this;
    const {align = 'left', bold = false, soft = false, maxWidth} = how;
    context.font = `${bold ? 600 : 400} ${size}px ${looks.font}`;
    context.textAlign = align;
    context.fillStyle = soft ? looks.softInk : looks.ink;
    context.fillText(text, x, y, maxWidth);
  }
}

function fillGround(
  context: OffscreenCanvasRenderingContext2D,
  {ground, width, height}: Figure,
  looks: Looks,
): void {
  if (ground === 'transparent') return;
  context.fillStyle = ground === 'white' ? '#fff' : looks.ground;
  context.fillRect(0, 0, width, height);
  const oval = /radial-gradient\(([\d.]+)% ([\d.]+)% at ([\d.]+)% ([\d.]+)%/.exec(looks.back);
  if (ground === 'white' || !oval) return;
  const [across, down, x, y] = oval.slice(1).map((share) => Number(share) / 100);
  const gradient = context.createRadialGradient(0, 0, 0, 0, 0, 1);
  for (const stop of stopsOf(looks.back)) gradient.addColorStop(...stop);
  context.save();
  context.transform(across! * width, 0, 0, down! * height, x! * width, y! * height);
  context.fillStyle = gradient;
  context.fillRect(-9, -9, 18, 18);
  context.restore();
}

/** Behind the mesh. */
function drawRuler(pen: Pen, {bounds, ...scale}: RulerScale, canvas: Canvas): void {
  const {context, looks} = pen;
  const {box, grid, ticks, numbers, names} = rulerOf(bounds, scale, canvas);
  const stroke = (lines: readonly Line[], alpha: number): void => {
    context.globalAlpha = alpha;
    context.beginPath();
    for (const [x1, y1, x2, y2] of lines) {
      context.moveTo(x1, y1);
      context.lineTo(x2, y2);
    }
    context.stroke();
  };
  context.strokeStyle = looks.softInk;
  context.lineWidth = 1;
  stroke(grid, kFaint);
  stroke([...box, ...ticks], 1);
  for (const {text, x, y} of [...numbers, ...names])
    pen.write(text, kRulerText, x, y + 0.35 * kRulerText, {align: 'center', soft: true});
}

/** In the middle below the mesh, beside the axes. */
function drawLegend(pen: Pen, legend: LegendTexts, figure: Figure, height: number): void {
  const {context} = pen;
  const {unit} = figure;
  const most = freeWidth(figure);
  const grid = legend.labels.length > 0 ? gridOf(legend.labels, most) : null;
  const bar = Math.min(most, grid ? grid.columns * grid.each : kBarWidth);
  const left = most / 2 + kGap + 2 * kAxis + kText - bar / 2;
  let y = height - kGap - legendHeight(legend, most) + kText;
  const factor = {align: 'right', soft: true} as const;
  pen.write(legend.factor, kText, left + bar, y, factor);
  const free = bar - (legend.factor ? context.measureText(legend.factor).width + kText : 0);
  // The log may know another unit, "T [K]".
  const name = unit ? `${legend.name.replace(/ \[[^\]]*\]$/, '')} [${unit}]` : legend.name;
  pen.write(name, kText, left, y, {bold: true, maxWidth: free});
  y += kText * (kLine - 1) + 8;
  const place = {left, top: y, width: bar};
  y = grid ? drawLabels(pen, legend, grid, place) : drawBar(pen, legend, place);
  legend.notes.forEach((note, i) => {
    y += kSmallText * kLine;
    const isMissing = legend.missing !== '' && i === legend.notes.length - 1;
    if (isMissing) drawSwatch(context, legend.missing, left, y);
    const indent = isMissing ? kIndent : 0;
    pen.write(note, kSmallText, left + indent, y, {soft: true, maxWidth: bar - indent});
  });
}

interface Place {
  left: number;
  top: number;
  width: number;
}

/** Returns the foot of the last row. */
function drawLabels(pen: Pen, {labels}: LegendTexts, grid: Grid, {left, top}: Place): number {
  const {columns, rows, each} = grid;
  const footOf = (row: number): number => top + kSmallText + row * kSmallText * kLine;
  labels.forEach(({text, color}, i) => {
    const x = left + (i % columns) * each;
    const y = footOf(Math.floor(i / columns));
    drawSwatch(pen.context, color, x, y);
    pen.write(text, kSmallText, x + kIndent, y, {soft: true, maxWidth: each - kIndent});
  });
  return footOf(rows - 1);
}

/** Returns the foot of its numbers. */
function drawBar(pen: Pen, legend: LegendTexts, {left, top, width}: Place): number {
  const {context} = pen;
  const gradient = context.createLinearGradient(left, 0, left + width, 0);
  for (const stop of stopsOf(legend.gradient)) gradient.addColorStop(...stop);
  context.fillStyle = gradient;
  context.beginPath();
  const [below, above] = legend.endColors.map((color) => (color ? 0 : kBarHeight / 2));
  context.roundRect(left, top, width, kBarHeight, [below!, above!, above!, below!]);
  context.fill();
  const [belowColor, aboveColor] = legend.endColors;
  if (belowColor) drawArrow(context, belowColor, [left - kArrowGap, top], -kBarHeight);
  if (aboveColor) drawArrow(context, aboveColor, [left + width + kArrowGap, top], kBarHeight);
  for (const at of legend.marks) drawMark(context, left + at * width, top);
  const y = top + kBarHeight;
  for (const {at, label} of legend.ticks) {
    const x = left + at * width;
    context.fillStyle = pen.looks.softInk;
    context.fillRect(x - 0.5, y, 1, 4);
    pen.write(label, kSmallText, x, y + 6 + kSmallText, {align: 'center', soft: true});
  }
  return y + 6 + kSmallText;
}

/** Values lie beyond this end. */
function drawArrow(
  context: OffscreenCanvasRenderingContext2D,
  color: string,
  [x, top]: readonly [number, number],
  long: number,
): void {
  context.fillStyle = color;
  context.beginPath();
  context.moveTo(x, top);
  context.lineTo(x + long, top + kBarHeight / 2);
  context.lineTo(x, top + kBarHeight);
  context.fill();
}

/** The value of an isosurface or the end of a threshold. */
function drawMark(context: OffscreenCanvasRenderingContext2D, x: number, y: number): void {
  for (const [ink, side] of [
    ['#fff', 2],
    ['#1b1f27', 1],
  ] as const) {
    context.fillStyle = ink;
    context.fillRect(x - side, y - 1 - side, 2 * side, kBarHeight + 2 + 2 * side);
  }
}

/** The farthest axis comes first, so that the others lie over it. */
function drawAxes(pen: Pen, x: number, y: number): void {
  const {context, looks} = pen;
  const axes = facePlaces(looks.axes)
    .filter(({direction}) => direction[0] === '+')
    .sort((a, b) => a.near - b.near);
  const long = kAxis / kHalf;
  context.lineWidth = 2;
  context.lineCap = 'round';
  for (const {direction, matrix} of axes) {
    const letter = direction[1]!;
    const [dx, dy] = [long * matrix[4], long * matrix[5]];
    context.strokeStyle = kAxisInks['xyz'.indexOf(letter)]!;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + dx, y + dy);
    context.stroke();
    const share = 1 + kText / 2 / kAxis + 0.05;
    pen.write(letter, kText, x + share * dx, y + share * dy + 0.35 * kText, {
      align: 'center',
      bold: true,
    });
  }
}
