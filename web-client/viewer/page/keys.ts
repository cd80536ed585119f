// The keyboard on the canvas. The help shows kKeyHelp.

export const kKeyHelp: readonly (readonly [string, string])[] = [
  ['← → ↑ ↓', 'turn'],
  ['⇧ ← → ↑ ↓', 'move'],
  ['+ −', 'nearer, farther'],
  ['F', 'centre what was pointed at, or all'],
  ['Home', 'first view'],
  ['1 … 6', 'from ±x ±y ±z'],
  ['O', 'parallel or perspective'],
  ['E', 'cell edges'],
  ['A', 'axes with numbers'],
  ['C', 'clip on or off'],
  ['[ ]', 'move the clip plane'],
  ['Space', 'pause, continue; play a series'],
  [', .', 'instant before, next instant'],
  ['< >', 'first, last instant'],
  ['M', 'mark the least and the largest value'],
  ['I', 'what lies in the middle'],
  ['P', 'save a picture'],
  ['W', 'whole screen'],
  ['?', 'this list'],
  ['Ctrl Z', 'undo (on a Mac: ⌘)'],
  ['Ctrl ⇧ Z', 'redo, also Ctrl Y'],
  ['Esc', 'end a tool'],
];

const kTurn = Math.PI / 24;
const kZoom = 1.12;
/** A share of the picture's height. */
const kPan = 0.08;

export interface KeyActions {
  turn(horizontal: number, vertical: number): void;
  /** By shares of the picture's height, to the right and up. */
  pan(right: number, up: number): void;
  centre(): void;
  zoom(factor: number): void;
  look(direction: number | null): void;
  toggle(what: 'parallel' | 'edges' | 'axes' | 'clip' | 'extremes' | 'pause' | 'fullscreen'): void;
  moveClip(share: number): void;
  stepTime(by: number): void;
  /** The first instant is 0, and the last one -1. */
  goToTime(at: 0 | -1): void;
  inspect(): void;
  picture(): void;
  help(): void;
  escape(): void;
}

export function bindKeys(canvas: HTMLElement, actions: KeyActions): void {
  const kClipStep = 0.02;
  const keys: Record<string, () => void> = {
    ArrowLeft: () => actions.turn(-kTurn, 0),
    ArrowRight: () => actions.turn(kTurn, 0),
    ArrowUp: () => actions.turn(0, -kTurn),
    ArrowDown: () => actions.turn(0, kTurn),
    'shift ArrowLeft': () => actions.pan(-kPan, 0),
    'shift ArrowRight': () => actions.pan(kPan, 0),
    'shift ArrowUp': () => actions.pan(0, kPan),
    'shift ArrowDown': () => actions.pan(0, -kPan),
    '+': () => actions.zoom(1 / kZoom),
    '=': () => actions.zoom(1 / kZoom),
    '-': () => actions.zoom(kZoom),
    Home: () => actions.look(null),
    o: () => actions.toggle('parallel'),
    e: () => actions.toggle('edges'),
    a: () => actions.toggle('axes'),
    c: () => actions.toggle('clip'),
    '[': () => actions.moveClip(-kClipStep),
    ']': () => actions.moveClip(kClipStep),
    ' ': () => actions.toggle('pause'),
    ',': () => actions.stepTime(-1),
    '.': () => actions.stepTime(1),
    '<': () => actions.goToTime(0),
    '>': () => actions.goToTime(-1),
    m: () => actions.toggle('extremes'),
    i: () => actions.inspect(),
    p: () => actions.picture(),
    f: () => actions.centre(),
    w: () => actions.toggle('fullscreen'),
    '?': () => actions.help(),
    Escape: () => actions.escape(),
  };
  for (let i = 0; i < 6; ++i) keys[String(i + 1)] = () => actions.look(i);
  canvas.addEventListener('keydown', (event) => {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const pressed = event.shiftKey && key.startsWith('Arrow') ? `shift ${key}` : key;
    const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[pressed];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
