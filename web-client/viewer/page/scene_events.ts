// Pointers on the picture. The root listens, because another canvas may replace this one.

interface Listening {
  root: EventTarget;
  signal?: AbortSignal;
}

export function onScene(
  {root, signal}: Listening,
  type: string,
  act: (event: PointerEvent) => void,
): void {
  root.addEventListener(
    type,
    (event) => {
      if ((event.target as Element).matches('.scene')) act(event as PointerEvent);
    },
    signal && {signal},
  );
}

/** A press that moves no farther than `pixels`, in CSS pixels, is a click. */
export function onSceneClick(
  its: Listening,
  pixels: number,
  act: (event: PointerEvent) => void,
): void {
  let pressed = {x: NaN, y: NaN};
  onScene(its, 'pointerdown', ({clientX: x, clientY: y}) => (pressed = {x, y}));
  onScene(its, 'pointerup', (event) => {
    const moved = Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y);
    pressed = {x: NaN, y: NaN};
    if (moved <= pixels) act(event);
  });
}
