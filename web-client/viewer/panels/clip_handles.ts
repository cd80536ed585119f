// A handle in the picture for each clip plane: a dot in the plane's middle, which is dragged along
// the normal.

import {axisOf, type ClipSetting} from '../../core/layers/clip';
import {extentAlong, planeOf} from '../settings/clip_plane';
import type {PanelsHost} from './panel';

const kArrowPixels = 34;

export class ClipHandles {
  private planes: ClipSetting[] = [];
  private readonly handles: HTMLElement[];

  /** `move` gets the plane's number and its new share. */
  constructor(
    private readonly layer: HTMLElement,
    count: number,
    private readonly host: Pick<PanelsHost, 'mesh' | 'view'>,
    private readonly move: (i: number, share: number) => void,
  ) {
    this.handles = Array.from({length: count}, (_, i) => {
      const handle = document.createElement('div');
      handle.className = 'handle';
      handle.append(document.createElement('i')); // more room for fingers
      handle.title = 'Drag to move the clip plane';
      handle.addEventListener('pointerdown', (event) => this.drag(event, i));
      layer.append(handle);
      return handle;
    });
  }

  update(planes: ClipSetting[]): void {
    this.planes = planes;
    this.place();
  }

  /** Must be called after every frame. */
  place(): void {
    this.handles.forEach((handle, i) => {
      const at = this.positionOf(i);
      handle.hidden = !at;
      if (!at) return;
      const angle = Math.atan2(at.dy, at.dx).toFixed(3);
      const place = `${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px`;
      handle.style.transform = `translate(${place}) rotate(${angle}rad)`;
    });
  }

  /**
   * The plane's middle on the canvas, the direction of its normal there, and pixels per lattice
   * unit.
   */
  private positionOf(
    i: number,
  ): {x: number; y: number; dx: number; dy: number; perUnit: number} | null {
    const plane = this.planes[i];
    const {mesh, view} = this.host;
    const {bounds} = mesh.base;
    if (!plane || !view || !mesh.snapshot || bounds.length === 0) return null;
    const {normal, offset} = planeOf(plane, bounds);
    const middle = [0, 1, 2].map((axis) => (bounds[axis]! + bounds[axis + 3]!) / 2);
    const away = offset - middle.reduce((sum, x, axis) => sum + x * normal[axis]!, 0);
    const centre = middle.map((x, axis) => x + away * normal[axis]!) as [number, number, number];
    const [low, high] = extentAlong(bounds, normal);
    const ahead = centre.map((x, axis) => x + ((high - low) / 100) * normal[axis]!) as [
      number,
      number,
      number,
    ];
    const from = view.project(centre),
      to = view.project(ahead);
    const length = Math.max(Math.hypot(to.x - from.x, to.y - from.y), 0.01);
    return {
      ...from,
      dx: (to.x - from.x) / length,
      dy: (to.y - from.y) / length,
      perUnit: Math.max((100 * length) / (high - low), 1e-9),
    };
  }

  private drag(event: PointerEvent, i: number): void {
    const start = this.positionOf(i);
    const plane = this.planes[i];
    if (!start || !plane) return;
    event.preventDefault();
    const handle = event.currentTarget as HTMLElement;
    handle.setPointerCapture(event.pointerId);
    const [low, high] = extentAlong(this.host.mesh.base.bounds, plane.normal);
    const {axis} = axisOf(plane);
    const sign = axis < 0 || plane.normal[axis]! > 0 ? 1 : -1;
    const onMove = (now: PointerEvent): void => {
      const along =
        (now.clientX - event.clientX) * start.dx + (now.clientY - event.clientY) * start.dy;
      this.move(i, plane.share + (sign * along) / start.perUnit / (high - low));
    };
    const onEnd = (): void => {
      handle.removeEventListener('pointermove', onMove);
      for (const type of ['pointerup', 'pointercancel'] as const)
        handle.removeEventListener(type, onEnd);
    };
    handle.addEventListener('pointermove', onMove);
    for (const type of ['pointerup', 'pointercancel'] as const)
      handle.addEventListener(type, onEnd);
    this.layer.style.setProperty('--arrow', `${kArrowPixels}px`);
  }
}
