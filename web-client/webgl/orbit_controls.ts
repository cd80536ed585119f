// Turns, moves and zooms a camera by pointers. The left button or one finger turns, the right
// button or two fingers move, the wheel, the middle button or two fingers zoom.

import type {OrbitCamera} from './camera';
import type {ViewCanvas} from './worker_canvas';

/** The wheel's unit, and the factor of one. */
const kWheelUnit = 100;
const kZoomStep = 0.95;
/** Pixels of a line and of a page, for wheels that count in them. */
const kWheelPixels = [1, 16, 100];
/** Touchpads report two fingers as a wheel with Control, in small steps. */
const kPinchSpeed = 10;

type Action = 'turn' | 'move' | 'zoom' | 'fingers';

interface Place {
  x: number;
  y: number;
}

export class OrbitControls {
  private action: Action | null = null;
  /** Where the pointers were last, by their numbers. */
  private readonly pointers = new Map<number, Place>();
  /** Where a zoom by the middle button began. */
  private middle: Place = {x: 0, y: 0};
  private isControlDown = false;
  private readonly ended = new AbortController();

  /** `changed` is called after each change of the camera. */
  constructor(
    private readonly camera: OrbitCamera,
    private readonly canvas: ViewCanvas,
    private readonly changed: () => void,
  ) {
    const {signal} = this.ended;
    const listen = <Its extends Event>(
      type: string,
      listener: (event: Its) => void,
      target: EventTarget = canvas,
    ): void =>
      target.addEventListener(type, listener as (event: Event) => void, {signal, passive: false});
    canvas.style.touchAction = 'none';
    listen<PointerEvent>('pointerdown', (event) => this.press(event));
    listen<PointerEvent>('pointermove', (event) => this.drag(event));
    listen<PointerEvent>('pointerup', (event) => this.release(event));
    listen<PointerEvent>('pointercancel', (event) => this.release(event));
    listen<WheelEvent>('wheel', (event) => this.roll(event));
    listen('contextmenu', (event) => event.preventDefault());
    for (const type of ['keydown', 'keyup'])
      listen<KeyboardEvent>(
        type,
        ({key}) => {
          if (key === 'Control') this.isControlDown = type === 'keydown';
        },
        canvas.ownerDocument,
      );
  }

  dispose(): void {
    this.ended.abort();
  }

  private press(event: PointerEvent): void {
    if (this.pointers.has(event.pointerId)) return;
    if (this.pointers.size === 0) this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, placeOf(event));
    if (event.pointerType === 'touch') return this.countFingers();
    const other = event.ctrlKey || event.metaKey || event.shiftKey;
    const turnsOrMoves = (turns: boolean): Action => (turns !== other ? 'turn' : 'move');
    const actions = [turnsOrMoves(true), 'zoom', turnsOrMoves(false)] as const;
    this.action = actions[event.button] ?? null;
    this.middle = placeOf(event);
  }

  private drag(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (!before || !this.action) return;
    const middle = this.middleOf(event.pointerId);
    const now = placeOf(event);
    const x = now.x - before.x,
      y = now.y - before.y;
    this.pointers.set(event.pointerId, now);
    if (x === 0 && y === 0) return;
    if (this.action === 'turn') this.turn(x, y);
    else if (this.action === 'move') this.move(x, y);
    else if (this.action === 'zoom') this.zoom(wheelFactor(y), this.middle);
    else if (middle) {
      const spread = ({x: ax, y: ay}: Place): number => Math.hypot(ax - middle.x, ay - middle.y);
      const centre = {x: (now.x + middle.x) / 2, y: (now.y + middle.y) / 2};
      this.move(x / 2, y / 2);
      if (spread(now) > 0) this.zoom(spread(before) / spread(now), centre);
    }
    this.changed();
  }

  private release({pointerId}: PointerEvent): void {
    if (!this.pointers.delete(pointerId)) return;
    this.countFingers();
  }

  private roll(event: WheelEvent): void {
    if (this.action) return;
    event.preventDefault();
    const pinch = event.ctrlKey && !this.isControlDown ? kPinchSpeed : 1;
    const pixels = event.deltaY * kWheelPixels[event.deltaMode]! * pinch;
    if (pixels === 0) return;
    this.zoom(wheelFactor(pixels), placeOf(event));
    this.changed();
  }

  /** One finger turns, two zoom and move, more do nothing. */
  private countFingers(): void {
    const {size} = this.pointers;
    this.action = ([null, 'turn', 'fingers'] as const)[size] ?? null;
  }

  /** The place of the other finger. */
  private middleOf(pointerId: number): Place | undefined {
    return [...this.pointers].find(([id]) => id !== pointerId)?.[1];
  }

  private turn(x: number, y: number): void {
    const angle = (2 * Math.PI) / this.canvas.clientHeight; // a whole turn for its height
    this.camera.orbit(-angle * x, -angle * y);
  }
  private move(x: number, y: number): void {
    const {clientHeight} = this.canvas;
    this.camera.pan(x / clientHeight, -y / clientHeight);
  }
  private zoom(factor: number, {x, y}: Place): void {
    const {left, top, width, height} = this.canvas.getBoundingClientRect();
    this.camera.zoomAt(factor, [(2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height]);
  }
}

/** Down, or towards the user, zooms out. */
function wheelFactor(pixels: number): number {
  return kZoomStep ** (-pixels / kWheelUnit);
}

function placeOf({clientX, clientY}: MouseEvent): Place {
  return {x: clientX, y: clientY};
}
