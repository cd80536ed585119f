// Notes that the graphics are too slow for what plays: the page spares them what it can.

import {kMovingMs} from '../../webgl/frame_budget';

export class Hurry {
  isOn = false;
  private wasSlow = false;

  constructor(private readonly element: HTMLElement) {}

  /** A picture of a series that plays is drawn. One slow one may be chance, as in a grown mesh. */
  note(drawingMs: number, playsEveryMs: number): void {
    const isSlow = drawingMs > Math.min(kMovingMs, playsEveryMs);
    if (isSlow && this.wasSlow) this.set(true);
    this.wasSlow = isSlow;
  }

  /** Nothing plays. */
  end(): void {
    this.wasSlow = false;
    this.set(false);
  }

  private set(isOn: boolean): void {
    if (isOn === this.isOn) return;
    this.isOn = isOn;
    this.element.classList.toggle('hurried', isOn);
  }
}
