// The colour bar with its numbers.

import {colorGradient, type ColorMapName} from '../core/color_maps';
import type {FieldInfo} from '../core/manifest';
import {niceTicks} from '../core/ticks';

const kMostTicks = 6;

export class Legend {
  private readonly figure: HTMLElement;

  constructor(root: ParentNode) {
    this.figure = root.querySelector('.legend')!;
  }

  /** Null hides the legend. */
  show(field: FieldInfo | null, map: ColorMapName): void {
    this.figure.hidden = field === null;
    if (!field) return;
    const [low, high] = field.range;
    const {ticks, factor} = niceTicks(low, high, kMostTicks);
    this.part('.legend-name').textContent = fieldTitle(field);
    this.part('.legend-factor').textContent = factor;
    this.part('.legend-bar').style.background = colorGradient(map, 33);
    this.part('.legend-ticks').replaceChildren(...ticks.map(({at, label}) => {
      const tick = document.createElement('span');
      tick.style.left = `${100 * at}%`;
      tick.textContent = label;
      return tick;
    }));
  }

  private part(selector: string): HTMLElement {
    return this.figure.querySelector<HTMLElement>(selector)!;
  }
}

/** The field's name; vectors are shown by magnitude, and say so. */
export function fieldTitle(field: FieldInfo): string {
  return field.components > 1 ? `${field.name} (magnitude)` : field.name;
}
