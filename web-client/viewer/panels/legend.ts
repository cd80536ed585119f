// The colour bar with its numbers, and marks where layers draw or hide. A label has a list of its
// values instead.

import {
  colorGradient,
  colorTable,
  kColorMapEntries,
  labelColors,
  labelGradient,
} from '../../core/picture/color_maps';
import type {Scalar} from '../../core/picture/field_scale';
import {labelColorOf, type ShownLabels} from '../../core/picture/labels';
import {linearPart, placeOn} from '../../core/picture/log_scale';
import {labelTicks, logTicks, niceTicks, type Ticks} from '../../core/picture/ticks';
import {isEqual} from '../../core/protocol/equal';
import type {FieldInfo} from '../../core/protocol/fields';
import {setAttribute, setText} from '../page/find';
import {formatCount, formatFactor, formatIn, formatValue} from '../page/format';
import type {Settings, ShownRange} from '../settings/settings';
import {scalarTitle} from './panel';

const kMaxTicks = 6;
/** Whole numbers are short. */
const kMaxLabelTicks = 20;
/** Labels with more letters stand in one column. */
const kLongLetters = 18;

export class Legend {
  private readonly figure: HTMLElement;
  private shown: unknown = null;

  constructor(root: ParentNode) {
    this.figure = root.querySelector('.legend')!;
  }

  hide(): void {
    this.figure.hidden = true;
  }

  show(
    {color: scalar, labels}: {color: Scalar; labels?: ShownLabels},
    fields: readonly FieldInfo[],
    range: ShownRange,
    settings: Settings,
    marked: readonly number[],
  ): void {
    this.figure.hidden = false;
    const title = settings.title ?? scalarTitle(scalar, fields);
    const name = this.part('.legend-name');
    setText(name, title);
    setAttribute(name, 'title', title);
    const {map, reversed, beyond} = settings;
    const requested = [title, range, map, reversed, beyond, marked, labels];
    if (isEqual(requested, this.shown)) return; // every picture asks, but few change it
    this.shown = requested;
    const {ticks, factor} = ticksOf(range);
    this.part('.legend-missing').hidden = !range.hasMissing;
    this.part('.legend-factor').textContent = range.logarithmic ? 'logarithmic' : factor;
    const note = noteOf(range);
    this.part('.legend-note').hidden = note === '';
    this.part('.legend-note').textContent = note;
    const info = fields[scalar.field]!;
    for (const its of ['bar', 'ticks']) this.part(`.legend-${its}`).hidden = labels !== undefined;
    this.part('.legend-labels').hidden = labels === undefined;
    this.figure.classList.remove('long');
    if (labels) return this.list(labels, info, colorsOf(range, settings));
    this.part('.legend-bar').style.background = range.labels
      ? labelGradient(range.labels, reversed)
      : colorGradient(map, reversed, 33);
    this.openEnds(range, settings);
    this.part('.legend-bar').replaceChildren(
      ...marked
        .map((value) => placeOn(range, value))
        .filter((at) => at >= 0 && at <= 1)
        .map((at) => placed('i', at)),
    );
    this.part('.legend-ticks').replaceChildren(
      ...ticks.map(({at, label}) => placed('span', at, label)),
    );
  }

  /** An arrow beyond each end that is open or has a colour, in that of the values there. */
  private openEnds(range: ShownRange, settings: Settings): void {
    const bar = this.part('.legend-bar');
    const colorOf = colorsOf(range, settings);
    [range.low, range.high].forEach((end, i) => {
      const own = settings.beyond[i];
      const open = range.openEnds?.[i] ? colorOf(end) : '';
      const color = own && !range.labels ? `rgb(${own.join(' ')})` : open;
      bar.style.setProperty(i === 0 ? '--below' : '--above', color);
      bar.classList.toggle(i === 0 ? 'open-below' : 'open-above', color !== '');
    });
  }

  private list(
    {values, count}: ShownLabels,
    info: FieldInfo,
    colorOf: (label: number) => string,
  ): void {
    const rows = values.map((label) => {
      const row = document.createElement('li');
      const swatch = document.createElement('i');
      swatch.style.background = colorOf(label);
      const name = document.createElement('span');
      name.textContent = row.title = formatIn(info, label);
      row.append(swatch, name);
      return row;
    });
    const more = document.createElement('li');
    more.className = 'more';
    more.textContent = `and ${formatCount(count - values.length)} more`;
    const longest = Math.max(...rows.map((row) => row.textContent.length));
    const list = this.part('.legend-labels');
    list.style.setProperty('--longest', String(longest));
    list.replaceChildren(...rows, ...(count > values.length ? [more] : []));
    this.figure.classList.toggle('long', longest > kLongLetters);
  }

  /** The factor by which the vectors move the mesh; 0: it rests. */
  showWarp(scale: number): void {
    const note = this.part('.legend-warp');
    note.hidden = scale === 0;
    setText(note, scale === 0 ? '' : `Deformed shape ${formatFactor(scale)}`);
  }

  private part(selector: string): HTMLElement {
    return this.figure.querySelector<HTMLElement>(selector)!;
  }
}

/** An element at a share of the bar. */
function placed(tag: 'i' | 'span', at: number, text = ''): HTMLElement {
  const element = document.createElement(tag);
  element.style.left = `${100 * at}%`;
  element.textContent = text;
  return element;
}

/** The colour of a label, as CSS. */
function colorsOf(range: ShownRange, {map, reversed}: Settings): (label: number) => string {
  if (range.labels) {
    const colors = labelColors(reversed);
    return (label) => `rgb(${colors[labelColorOf(label)]!.join(' ')})`;
  }
  const table = colorTable(map, reversed);
  return (label) => {
    const share = range.low < range.high ? Math.min(1, Math.max(0, placeOn(range, label))) : 0;
    const at = 4 * Math.round((kColorMapEntries - 1) * (share || 0));
    return `rgb(${table.slice(at, at + 3).join(' ')})`;
  };
}

function ticksOf({labels, logarithmic, low, high}: ShownRange): Ticks {
  if (labels) return labelTicks(low + 0.5, labels, kMaxLabelTicks);
  return (logarithmic ? logTicks : niceTicks)(low, high, kMaxTicks);
}

/** A note on values that the colours do not tell apart. */
function noteOf(range: ShownRange): string {
  const {hides, openEnds, low} = range;
  const linear = linearPart(range);
  if (openEnds) return 'Middle 96\u202f% by volume; arrows: values beyond';
  if (hides === 'all') return 'No values above 0: the scale is linear';
  if (linear > 0) return `Linear from ${formatValue(-linear)} to ${formatValue(linear)}`;
  return hides === 'low' ? `Values below ${formatValue(low)} have the first colour` : '';
}
