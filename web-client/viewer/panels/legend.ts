// The colour bar with its numbers.

import {colorGradient, labelGradient} from '../../core/picture/color_maps';
import type {Scalar} from '../../core/picture/field_scale';
import {labelTicks, logTicks, niceTicks, type Ticks} from '../../core/picture/ticks';
import type {FieldInfo} from '../../core/protocol/manifest';
import {formatValue} from '../page/format';
import type {Settings, ShownRange} from '../settings/settings';
import {scalarTitle} from './panel';

const kMaxTicks = 6;
/** Whole numbers are short. */
const kMaxLabelTicks = 20;

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
    const requested = JSON.stringify([scalar, range, map, reversed, scalarTitle(scalar, fields)]);
    if (requested === this.shown) return; // every picture asks, but few change it
    this.shown = requested;
    const {ticks, factor} = ticksOf(range);
    const name = this.part('.legend-name');
    name.textContent = name.title = scalarTitle(scalar, fields);
    this.part('.legend-missing').hidden = !range.hasMissing;
    this.part('.legend-factor').textContent = range.logarithmic ? 'logarithmic' : factor;
    const note = noteOf(range);
    this.part('.legend-note').hidden = note === '';
    this.part('.legend-note').textContent = note;
    this.part('.legend-bar').style.background = range.labels
      ? labelGradient(range.labels, reversed)
      : colorGradient(map, reversed, 33);
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

function ticksOf({labels, logarithmic, low, high}: ShownRange): Ticks {
  if (labels) return labelTicks(low + 0.5, labels, kMaxLabelTicks);
  return (logarithmic ? logTicks : niceTicks)(low, high, kMaxTicks);
}

/** A note on values that the colours do not tell apart. */
function noteOf({hides, isMiddle, low}: ShownRange): string {
  if (isMiddle) return '2nd to 98th percentile; a few values lie outside';
  if (hides === 'all') return 'No values above 0: the scale is linear';
  return hides === 'low' ? `Values below ${formatValue(low)} have the first colour` : '';
}
