// The page's canvas, as the worker that draws into it sees it: its surface, its size, and the
// pointer events that the page forwards.

import {watchDensity} from './density';

/** More than two pixels a point cost more than they show. */
const kMaxPixelRatio = 2;

/** The forwarded part of a pointer, wheel or key event. Places count from the canvas's corner. */
export interface CanvasEvent {
  type: string;
  clientX: number;
  clientY: number;
  pageX: number;
  pageY: number;
  button: number;
  pointerId: number;
  pointerType: string;
  deltaY: number;
  deltaMode: number;
  ctrlKey: boolean;
  metaKey: boolean;
  shiftKey: boolean;
  key: string;
}

export interface CanvasSize {
  width: number;
  height: number;
  pixelRatio: number;
}

/** The part of an element that OrbitControls needs (orbit_controls.ts). */
export class WorkerCanvas extends EventTarget {
  clientWidth = 1;
  clientHeight = 1;
  pixelRatio = 1;
  readonly style: Record<string, string> = {};
  /** Moves and keys arrive here, too: the page forwards only the canvas's events. */
  readonly ownerDocument = this;
  onresize: () => void = () => undefined;

  constructor(readonly surface: OffscreenCanvas) {
    super();
  }

  resize({width, height, pixelRatio}: CanvasSize): void {
    Object.assign(this, {clientWidth: width, clientHeight: height, pixelRatio});
    this.onresize();
  }

  receive(event: CanvasEvent): void {
    const {type, ...rest} = event;
    this.dispatchEvent(Object.assign(new Event(type, {cancelable: true}), rest));
  }

  getBoundingClientRect(): {left: number; top: number; width: number; height: number} {
    return {left: 0, top: 0, width: this.clientWidth, height: this.clientHeight};
  }
  /** The page has captured the pointer already. */
  setPointerCapture(): void {
    return;
  }
}

export type ViewCanvas = HTMLCanvasElement | WorkerCanvas;

export const surfaceOf = (canvas: ViewCanvas): HTMLCanvasElement | OffscreenCanvas =>
  canvas instanceof WorkerCanvas ? canvas.surface : canvas;

/** Gives the surface this share of the canvas's pixels, each way. Returns its pixels a point. */
export function usePixels(canvas: ViewCanvas, share: number): number {
  const surface = surfaceOf(canvas);
  const density = canvas instanceof WorkerCanvas ? canvas.pixelRatio : window.devicePixelRatio;
  const ratio = Math.min(density, kMaxPixelRatio) * share;
  const width = Math.floor(Math.max(canvas.clientWidth, 1) * ratio) || 1;
  const height = Math.floor(Math.max(canvas.clientHeight, 1) * ratio) || 1;
  // Setting a size clears the canvas, even if it is the same.
  if (surface.width !== width || surface.height !== height) Object.assign(surface, {width, height});
  return ratio;
}

/** Calls `resized` whenever the canvas's size changes. Returns a function that ends this. */
export function watchSize(canvas: ViewCanvas, resized: () => void): () => void {
  if (canvas instanceof WorkerCanvas) {
    canvas.onresize = resized;
    return () => void (canvas.onresize = () => undefined);
  }
  const observer = new ResizeObserver(resized);
  observer.observe(canvas);
  const endDensity = watchDensity(resized);
  return () => {
    observer.disconnect();
    endDensity();
  };
}
