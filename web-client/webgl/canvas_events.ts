// The events of a page's canvas, as the worker that draws into it gets them.

import type {CanvasEvent} from './worker_canvas';

/**
 * The canvas's events that a view needs. Moves are forwarded only while a button or a finger is
 * down.
 */
const kCanvasEvents = [
  'pointerdown',
  'pointermove',
  'pointerup',
  'pointercancel',
  'wheel',
  'contextmenu',
] as const;

/**
 * Sends the canvas's events until the signal aborts. Captures the pointer for a drag that began on
 * the canvas, as OrbitControls would.
 */
export function forwardEvents(
  canvas: HTMLCanvasElement,
  send: (event: CanvasEvent) => void,
  signal: AbortSignal,
): void {
  let pressed = 0;
  const pass = (event: PointerEvent | WheelEvent | MouseEvent): void => {
    if (event.type === 'wheel' || event.type === 'contextmenu') event.preventDefault();
    if (event.type === 'pointerdown') {
      ++pressed;
      canvas.setPointerCapture((event as PointerEvent).pointerId);
    }
    if (event.type === 'pointermove' && pressed === 0) return;
    if (event.type === 'pointerup' || event.type === 'pointercancel')
      pressed = Math.max(0, pressed - 1);
    send(farEvent(event, canvas));
  };
  canvas.style.touchAction = 'none';
  for (const type of kCanvasEvents) canvas.addEventListener(type, pass, {passive: false, signal});
  for (const type of ['keydown', 'keyup'] as const)
    document.addEventListener(
      type,
      (event) => {
        if (event.key === 'Control') send(farEvent(event, canvas));
      },
      {signal},
    );
}

function farEvent(
  event: Partial<PointerEvent & WheelEvent & KeyboardEvent> & {type: string},
  canvas: HTMLElement,
): CanvasEvent {
  const {left, top} = canvas.getBoundingClientRect();
  const clientX = (event.clientX ?? 0) - left,
    clientY = (event.clientY ?? 0) - top;
  const {
    type,
    button = 0,
    pointerId = 0,
    pointerType = '',
    deltaY = 0,
    deltaMode = 0,
    ctrlKey = false,
    metaKey = false,
    shiftKey = false,
    key = '',
  } = event;
  return {
    type,
    clientX,
    clientY,
    pageX: clientX,
    pageY: clientY,
    button,
    pointerId,
    pointerType,
    deltaY,
    deltaMode,
    ctrlKey,
    metaKey,
    shiftKey,
    key,
  };
}
