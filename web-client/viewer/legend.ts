// The colour bar with its numbers.

import {colorGradient} from '../core/color_maps';
import type {Scalar} from '../core/field_scale';
import type {FieldInfo} from '../core/manifest';
import {logTicks, niceTicks} from '../core/ticks';
import {formatValue} from './format';
import {scalarTitle} from './panel';
import type {Settings} from './settings';

const kMaxTicks = 6;

export interface ShownRange {
  low: number;
  high: number;
  logarithmic: boolean;
  /** What a logarithmic scale hides: nothing, the values below `low`, or all of them. */
  hides: 'none' | 'low' | 'all';
  /** Some values are missing: the legend explains their colour. */
  hasMissing: boolean;
}

export class Legend {
  private readonly figure: HTMLElement;
  private shown = '';

  constructor(root: ParentNode) {
    this.figure = root.querySelector('.legend')!;
  }

  hide(): void {
    this.figure.hidden = true;
  }

  show(
    scalar: Scalar,
    fields: readonly FieldInfo[],
    range: ShownRange,
    {map, reversed}: Settings,
  ): void {
    this.figure.hidden = false;
    const wanted = JSON.stringify([scalar, range, map, reversed, scalarTitle(scalar, fields)]);
    if (wanted === this.shown) return; // every picture asks, but few change it
    this.shown = wanted;
    const {ticks, factor} = range.logarithmic
      ? logTicks(range.low, range.high, kMaxTicks)
      : niceTicks(range.low, range.high, kMaxTicks);
    const name = this.part('.legend-name');
    name.textContent = name.title = scalarTitle(scalar, fields);
    this.part('.legend-missing').hidden = !range.hasMissing;
    this.part('.legend-factor').textContent = range.logarithmic ? 'logarithmic' : factor;
    const note = noteOf(range);
    this.part('.legend-note').hidden = note === '';
    this.part('.legend-note').textContent = note;
    this.part('.legend-bar').style.background = colorGradient(map, reversed, 33);
    this.part('.legend-ticks').replaceChildren(
      ...ticks.map(({at, label}) => {
        const tick = document.createElement('span');
        tick.style.left = `${100 * at}%`;
        tick.textContent = label;
        return tick;
      }),
    );
  }

  private part(selector: string): HTMLElement {
    return this.figure.querySelector<HTMLElement>(selector)!;
  }
}

/** What the colours do not tell apart. */
function noteOf({hides, low}: ShownRange): string {
  if (hides === 'all') return 'No values above 0: the scale is linear';
  return hides === 'low' ? `Values below ${formatValue(low)} have the first colour` : '';
}
