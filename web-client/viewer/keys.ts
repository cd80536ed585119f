// The keyboard on the canvas. The help shows kKeyHelp.

export const kKeyHelp: readonly (readonly [string, string])[] = [
  ['← → ↑ ↓', 'turn'],
  ['+ −', 'nearer, farther'],
  ['Home', 'first view'],
  ['1 … 6', 'from ±x ±y ±z'],
  ['O', 'parallel or perspective'],
  ['E', 'cell edges'],
  ['C', 'clip on or off'],
  ['[ ]', 'move the clip plane'],
  ['Space', 'pause, continue'],
  ['I', 'what lies in the middle'],
  ['P', 'save the picture'],
  ['F', 'full screen'],
  ['?', 'this list'],
  ['Esc', 'end a tool'],
];

const kTurn = Math.PI / 24;
const kZoom = 1.12;

export interface KeyActions {
  turn(horizontal: number, vertical: number): void;
  zoom(factor: number): void;
  look(direction: number | null): void;
  toggle(what: 'parallel' | 'edges' | 'clip' | 'pause' | 'fullscreen'): void;
  moveClip(share: number): void;
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
    '+': () => actions.zoom(1 / kZoom),
    '=': () => actions.zoom(1 / kZoom),
    '-': () => actions.zoom(kZoom),
    Home: () => actions.look(null),
    o: () => actions.toggle('parallel'),
    e: () => actions.toggle('edges'),
    c: () => actions.toggle('clip'),
    '[': () => actions.moveClip(-kClipStep),
    ']': () => actions.moveClip(kClipStep),
    ' ': () => actions.toggle('pause'),
    i: () => actions.inspect(),
    p: () => actions.picture(),
    f: () => actions.toggle('fullscreen'),
    '?': () => actions.help(),
    Escape: () => actions.escape(),
  };
  for (let i = 0; i < 6; ++i) keys[String(i + 1)] = () => actions.look(i);
  canvas.addEventListener('keydown', (event) => {
    const action =
      event.ctrlKey || event.metaKey || event.altKey
        ? undefined
        : keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
