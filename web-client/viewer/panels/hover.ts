// The value under a pointer that rests, as a label at the pointer, and the outline of its cell.

import type {Pick} from '../../core/session/inspector';
import {kMagnitude, type Scalar} from '../../core/picture/field_scale';
import type {FieldInfo} from '../../core/protocol/fields';
import type {View} from '../../webgl/view';
import {find} from '../page/find';
import {formatIn} from '../page/format';
import {cellOutline} from './marks';
import {scalarName} from './panel';

/** So long the pointer has to rest. */
const kRestMs = 150;
/** Pixels between the pointer and the label. */
const kAway = 14;

export interface HoverHost {
  readonly view: View | null;
  pick(x: number, y: number): Promise<Pick | null>;
  /** The coloured quantity and all fields; null if nothing is coloured. */
  readonly shown: {scalar: Scalar; fields: readonly FieldInfo[]} | null;
}

/** "Velocity, x 1.25 m/s"; null if the field is not here. */
export function hoverText(pick: Pick, scalar: Scalar, fields: readonly FieldInfo[]): string | null {
  const value = valueText(pick, scalar, fields);
  return value === null ? null : `${scalarName(scalar, fields)} ${value}`;
}

/** NaN: it is missing; null: the field is not here. */
export function valueOf({fields}: Pick, {field, component}: Scalar): number | null {
  const found = fields.find((its) => its.field === field)?.values;
  if (!found) return null;
  if (found.length === 1) return found[0]!;
  return component === kMagnitude ? Math.hypot(...found) : found[component]!;
}

/** "1.25 m/s", or "no value"; null if the field is not here. */
export function valueText(pick: Pick, scalar: Scalar, fields: readonly FieldInfo[]): string | null {
  const value = valueOf(pick, scalar);
  return value === null ? null : textOfValue(value, fields[scalar.field]!);
}

export function textOfValue(value: number, info: FieldInfo): string {
  const unit = info.unit === undefined ? '' : `\u00a0${info.unit}`;
  return Number.isNaN(value) ? 'no value' : formatIn(info, value) + unit;
}

export class Hover {
  private readonly label: HTMLElement;
  /** The cell at the pointer. */
  private readonly marks: SVGSVGElement;
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** Where the pointer rests; null: it does not, or the picture moves. */
  private at: [number, number] | null = null;
  /** Counts the rests: a late answer belongs to none. */
  private rest = 0;

  constructor(
    root: ShadowRoot,
    private readonly host: HoverHost,
  ) {
    this.label = find(root, '.hover');
    this.marks = find<SVGSVGElement>(root, '.marks').cloneNode() as SVGSVGElement;
    this.marks.setAttribute('part', 'marks');
    find(root, '.layer').append(this.marks);
    root.addEventListener('pointermove', (event) => this.move(event as PointerEvent));
    for (const type of ['pointerdown', 'wheel', 'keydown', 'pointerout'])
      root.addEventListener(type, () => this.hide(), {passive: true});
  }

  /** The mesh has another value or shape at the pointer: it says them once that rests, too. */
  showPicture(): void {
    const {at} = this;
    this.hide();
    if (at) this.restAt(at);
  }

  /** Must also be called when the picture moves. */
  hide(): void {
    clearTimeout(this.timer);
    this.at = null;
    ++this.rest;
    this.label.hidden = true;
    this.marks.replaceChildren();
  }

  private move(event: PointerEvent): void {
    this.hide();
    const onPicture = (event.target as Element).matches('.scene');
    if (!onPicture || event.pointerType === 'touch' || event.buttons !== 0) return;
    this.restAt([event.offsetX, event.offsetY]);
  }

  private restAt(at: [number, number]): void {
    this.at = at;
    this.timer = setTimeout(() => void this.show(...at), kRestMs);
  }

  private async show(x: number, y: number): Promise<void> {
    const {rest} = this;
    const {shown, view} = this.host;
    if (!shown || !view) return;
    const pick = await this.host.pick(x, y);
    const text = pick && hoverText(pick, shown.scalar, shown.fields);
    if (!text || rest !== this.rest) return;
    this.marks.replaceChildren(cellOutline(pick.places, view));
    const {label} = this;
    label.textContent = text;
    label.hidden = false;
    const {clientWidth, clientHeight} = view.canvas;
    const {offsetWidth, offsetHeight} = label;
    const left = x + kAway + offsetWidth < clientWidth ? x + kAway : x - kAway - offsetWidth;
    const top = y + kAway + offsetHeight < clientHeight ? y + kAway : y - kAway - offsetHeight;
    label.style.left = `${Math.max(0, left)}px`;
    label.style.top = `${Math.max(0, top)}px`;
  }
}
