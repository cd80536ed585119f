// A dot on the mesh with a small card beside it: what it says, and a button that removes it.

import type {Kept, KeptName} from '../settings/points';

/** They differ from each other on both grounds, also for most who see few colours. */
const kColors = [
  '#e8590c',
  '#1c7ed6',
  '#2f9e44',
  '#d6336c',
  '#7048e8',
  '#0c8599',
  '#a6761d',
  '#5c6773',
];
const kExtremeColor = '#495057';

export type PinKind = KeptName | 'extremes';

/** Lines take the colours from the end, so that few points and lines differ. */
export function pinColor(kind: PinKind, i: number): string {
  if (kind === 'extremes') return kExtremeColor;
  return kColors[kind === 'points' ? i : kColors.length - 1 - i]!;
}

/** A folded dot has it: "1", "A", or an arrow. */
export function pinSign(kind: PinKind, i: number): string {
  if (kind === 'points') return `${i + 1}`;
  return kind === 'lines' ? 'ABCD'[i]! : '\u2193\u2191'[i]!;
}

/** "point 1", or the name. */
export const nounOf = (kind: KeptName, {name}: Kept, i: number): string =>
  name || `${kind.slice(0, -1)} ${pinSign(kind, i)}`;

/** "Point 1", or the name. */
export const titleOf = (kind: KeptName, kept: Kept, i: number): string =>
  kept.name || nounOf(kind, kept, i).replace(/^./, (letter) => letter.toUpperCase());

export class Pin {
  readonly root = document.createElement('div');
  readonly card = document.createElement('div');
  /** The button that opens it. */
  readonly value: HTMLButtonElement;
  /** The card's. */
  size = {width: 0, height: 0};
  /** As LabelledDot.last. */
  last = 0;

  /** `title` is part of the sentence "Remove point 1". */
  constructor(
    readonly kind: PinKind,
    /** Its place among those of its kind. */
    readonly at: number,
    title: string,
    actions: {open: () => void; remove: () => void},
  ) {
    const dot = document.createElement('i'); // the keyboard has the value
    dot.ariaHidden = 'true';
    dot.textContent = pinSign(kind, at);
    dot.addEventListener('click', actions.open);
    this.value = buttonOf(actions.open);
    this.root.className = `pin of-${kind}`;
    this.root.hidden = true;
    this.root.style.setProperty('--pin', this.color);
    const close = buttonOf(actions.remove);
    close.textContent = '\u00d7';
    close.ariaLabel = `Remove ${title}`;
    this.card.append(this.value, close);
    this.root.append(dot, this.card);
  }

  get color(): string {
    return pinColor(this.kind, this.at);
  }
}

function buttonOf(press: () => void): HTMLButtonElement {
  const button = document.createElement('button');
  button.type = 'button';
  button.addEventListener('click', press);
  return button;
}
