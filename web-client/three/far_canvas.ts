// A canvas of the page as the worker that draws into it sees it: its surface, its size, and the
// pointer's events, which the page passes on.

import {watchDensity} from './density';

/**
 * What of a pointer's, a wheel's or a key's event is passed on; places are from the canvas's
 * corner.
 */
export interface FarEvent {
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

export interface FarSize {
  width: number;
  height: number;
  pixelRatio: number;
}

/** As much of an element as OrbitControls asks for. */
export class FarCanvas extends EventTarget {
  clientWidth = 1;
  clientHeight = 1;
  pixelRatio = 1;
  readonly style: Record<string, string> = {};
  /** It hears of moves and keys here, too: the page sends what belongs to the canvas alone. */
  readonly ownerDocument = this;
  onresize: () => void = () => undefined;

  constructor(readonly surface: OffscreenCanvas) {
    super();
  }

  resize({width, height, pixelRatio}: FarSize): void {
    Object.assign(this, {clientWidth: width, clientHeight: height, pixelRatio});
    this.onresize();
  }

  receive(event: FarEvent): void {
    const {type, ...rest} = event;
    this.dispatchEvent(Object.assign(new Event(type, {cancelable: true}), rest));
  }

  getBoundingClientRect(): {left: number; top: number; width: number; height: number} {
    return {left: 0, top: 0, width: this.clientWidth, height: this.clientHeight};
  }
  getRootNode(): this {
    return this;
  }
  /** The page has captured it already. */
  setPointerCapture(): void {
    return;
  }
  releasePointerCapture(): void {
    return;
  }
}

export type ViewCanvas = HTMLCanvasElement | FarCanvas;

export const surfaceOf = (canvas: ViewCanvas): HTMLCanvasElement | OffscreenCanvas =>
  canvas instanceof FarCanvas ? canvas.surface : canvas;
export const pixelRatioOf = (canvas: ViewCanvas): number =>
  canvas instanceof FarCanvas ? canvas.pixelRatio : window.devicePixelRatio;

/** Calls `resized` whenever the canvas has another size; gives what ends that. */
export function watchSize(canvas: ViewCanvas, resized: () => void): () => void {
  if (canvas instanceof FarCanvas) {
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
