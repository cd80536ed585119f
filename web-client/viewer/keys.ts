// The keyboard on the canvas: arrows turn, plus and minus zoom, Home resets.

import type {MeshView} from '../three/mesh_view';

const kTurn = Math.PI / 24;
const kZoom = 1.12;

export function bindKeys(view: MeshView): void {
  const actions: Record<string, () => void> = {
    ArrowLeft: () => view.orbit(-kTurn, 0),
    ArrowRight: () => view.orbit(kTurn, 0),
    ArrowUp: () => view.orbit(0, -kTurn),
    ArrowDown: () => view.orbit(0, kTurn),
    '+': () => view.zoom(1 / kZoom),
    '=': () => view.zoom(1 / kZoom),
    '-': () => view.zoom(kZoom),
    Home: () => view.resetCamera(),
  };
  view.canvas.addEventListener('keydown', (event) => {
    const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
