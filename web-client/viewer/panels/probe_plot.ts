// A field along a line or over time, drawn by uPlot, and the values as a table. It is loaded at the
// first request.

import uPlot from 'uplot';
import plotStyles from 'uplot/dist/uPlot.min.css?inline';
import type {Probe} from '../../core/session/inspector';
import {formatTo} from '../page/format';
import {adopt} from '../page/trusted';

export {tableOf, timeTableOf, timeTitle} from './line_table';
export {fileNameOf, originOf} from './origin';

const kHeight = 190;
const kTextSize = 12;
/** A title that stands beside the plot has room for so many letters. */
const kMaxLetters = 24;
/** The readout shows this share of the ranges. */
const kShare = 1e-4;

interface Curve {
  at: readonly number[];
  values: readonly number[];
  title: string;
  /** The title of `at`. */
  atTitle: string;
  /** A value's text; absent: its number. */
  format?: ((value: number) => string) | undefined;
}

export interface TimeCurve extends Curve {
  /** A line across the plot marks it. */
  time: number;
  /** Where the values come from. */
  status: string;
}

export interface TimePlot {
  show(curve: TimeCurve): void;
  destroy(): void;
}

/**
 * Two values at one distance are a jump. The distances ascend, as uPlot requires. Missing values
 * leave a gap.
 */
export function drawProbe(
  root: ShadowRoot,
  place: HTMLElement,
  probe: Probe,
  title: string,
  format?: (value: number) => string,
): {destroy(): void} {
  const curve = {...probe, title, atTitle: 'distance', format};
  const plot = draw(root, place, curve, {
    titles: () => ['distance', title],
    points: {show: false},
    say: (i) => (i == null ? title : readout(curve, i)),
  });
  place.setAttribute('aria-label', `${title} along the line`);
  return {destroy: () => plot.destroy()};
}

/** `choose` is called with the instant that was clicked. */
export function drawOverTime(
  root: ShadowRoot,
  place: HTMLElement,
  choose: (i: number) => void,
): TimePlot {
  let curve: TimeCurve = {at: [], values: [], title: '', atTitle: '', time: NaN, status: ''};
  const say = (i: number | null | undefined): string =>
    i == null ? curve.title : readout(curve, i);
  const plot = draw(root, place, curve, {
    titles: () => [curve.atTitle, curve.title],
    points: {show: true, size: 4},
    say,
    mark: () => curve.time,
  });
  // the card is placed with room for the lines
  for (const line of [readoutOf(place), statusOf(place)]) line.textContent = '\u00a0';
  plot.over.addEventListener('click', ({offsetX}) => choose(plot.posToIdx(offsetX)));
  return {
    show: (next) => {
      curve = next;
      place.setAttribute('aria-label', `${curve.title} over time`);
      plot.setData(dataOf(curve));
      readoutOf(place).textContent = say(plot.cursor.idx);
      statusOf(place).textContent = curve.status;
    },
    destroy: () => plot.destroy(),
  };
}

interface Looks {
  /** The titles of the axes. */
  titles(): readonly [at: string, value: string];
  points: uPlot.Series.Points;
  /** The text for the value that is pointed at. */
  say(i: number | null | undefined): string;
  /** A line across the plot stands there. */
  mark?(): number;
}

function draw(root: ShadowRoot, place: HTMLElement, curve: Curve, looks: Looks): uPlot {
  adopt(root, plotStyles);
  const style = getComputedStyle(root.host);
  const ink = style.getPropertyValue('--ink-soft').trim();
  const axis: uPlot.Axis = {
    stroke: ink,
    grid: {stroke: style.getPropertyValue('--line').trim(), width: 1},
    ticks: {show: false},
    font: `${kTextSize}px system-ui`,
    labelFont: `${kTextSize}px system-ui`,
    labelSize: kTextSize + 4,
    values: (_self, ticks, _axis, _space, step) => ticks.map((tick) => formatTo(tick, step)),
  };
  place.setAttribute('role', 'img');
  return new uPlot(
    {
      width: place.clientWidth,
      height: kHeight,
      legend: {show: false},
      cursor: {points: {size: 7}, drag: {x: false, y: false}},
      scales: {x: {time: false}},
      axes: [
        {...axis, size: 24, label: () => looks.titles()[0]},
        {...axis, size: 56, label: () => shortened(looks.titles()[1])},
      ],
      series: [
        {},
        {
          label: curve.title,
          stroke: style.getPropertyValue('--accent').trim(),
          width: 2,
          points: looks.points,
        },
      ],
      hooks: {
        setCursor: [(self) => void (readoutOf(place).textContent = looks.say(self.cursor.idx))],
        draw: [(self) => drawMark(self, looks.mark?.() ?? NaN, ink)],
      },
    },
    dataOf(curve),
    place,
  );
}

const shortened = (title: string): string =>
  title.length <= kMaxLetters ? title : `${title.slice(0, kMaxLetters - 1)}…`;

const dataOf = ({at, values}: Curve): uPlot.AlignedData => [
  [...at],
  values.map((value) => (Number.isNaN(value) ? null : value)),
];

const readoutOf = (place: HTMLElement): Element => place.parentElement!.querySelector('.readout')!;
const statusOf = (place: HTMLElement): Element => place.parentElement!.querySelector('.status')!;

function readout({at, values, title, atTitle, format}: Curve, i: number): string {
  const known = values.filter((value) => !Number.isNaN(value));
  const value = format?.(values[i]!) ?? formatTo(values[i]!, resolutionIn(known));
  return `${title} ${value} at ${atTitle} ${formatTo(at[i]!, resolutionIn(at))}`;
}

const resolutionIn = (values: readonly number[]): number =>
  values.length > 0 ? kShare * (Math.max(...values) - Math.min(...values)) || kShare : kShare;

function drawMark(plot: uPlot, at: number, ink: string): void {
  const {ctx, bbox} = plot;
  const x = plot.valToPos(at, 'x', true);
  if (!(x >= bbox.left && x <= bbox.left + bbox.width)) return;
  ctx.save();
  ctx.strokeStyle = ink;
  ctx.lineWidth = devicePixelRatio;
  ctx.beginPath();
  ctx.moveTo(x, bbox.top);
  ctx.lineTo(x, bbox.top + bbox.height);
  ctx.stroke();
  ctx.restore();
}
