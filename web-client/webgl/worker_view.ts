// The page's side of a view that a worker draws: commands out, poses in.

import type {LatticeChange, Vector} from '../core/protocol/geometry';
import type {Ray} from '../core/picture/cell_ray';
import {retry} from '../core/transport/retry';
import {buffersOf} from '../core/session/snapshot_buffers';
import {buffersOfVolume} from '../core/picture/volume';
import type {Snapshot} from '../core/session/worker_messages';
import type {CameraState} from './camera';
import {watchDensity} from './density';
import {checkedDirection, type Direction} from './directions';
import type {CanvasEvent, CanvasSize} from './worker_canvas';
import {checkedCamera, project, rayAt, type Pose} from './pose';
import type {Boxed, Frame, Insets, Look, Rendered, View, ViewListeners} from './view';
import type {Command, FromView, ToView, Wanted} from './view_messages';

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

/** The worker that draws is asked this often whether it responds, while the page is visible. */
const kPingMs = 5000;
/**
 * So many unanswered questions are allowed: software graphics may block a worker for seconds, and a
 * page that slept has asked only once.
 */
const kMaxUnanswered = 6;

/**
 * A view of `canvas`, drawn by a worker if workers can draw, else on this thread. Throws if the
 * browser has no WebGL 2 or the network fails.
 */
export async function openView(canvas: HTMLCanvasElement, listeners: ViewListeners): Promise<View> {
  const {worker, url, draws} = await retry(startWorker);
  if (draws && 'transferControlToOffscreen' in canvas)
    return WorkerView.begin(worker, canvas, listeners);
  worker.terminate();
  // the same script again, so that nobody downloads it in two builds
  await import(/* @vite-ignore */ url);
  return new globalThis.qtetMeshView!(canvas, listeners);
}

async function startWorker(): Promise<{worker: Worker; url: string; draws: boolean}> {
  const worker = new Worker(new URL('./view_worker.ts', import.meta.url), {
    type: 'module',
    name: 'qtet-view',
  });
  const hello = await answerOf(worker);
  if (hello.type !== 'hello') throw new Error('the worker that draws does not greet');
  return {worker, ...hello};
}

/** The worker's next message. The worker ends if there is none. */
function answerOf(worker: Worker): Promise<FromView> {
  return new Promise((resolve, reject) => {
    worker.onmessage = (event: MessageEvent<FromView>) => resolve(event.data);
    worker.onerror = (event) => {
      worker.terminate();
      reject(new Error(event.message || 'the part that draws does not come'));
    };
  });
}

class WorkerView implements View {
  private readonly shown = new Map<number, (ms: number) => void>();
  private readonly pictures = new Map<
    number,
    {resolve(picture: unknown): void; reject(why: Error): void}
  >();
  private readonly ended = new AbortController();
  private readonly resizes: ResizeObserver;
  private readonly timer: ReturnType<typeof setInterval>;
  private unanswered = 0;
  private nextId = 0;
  private pressed = 0;

  static async begin(
    worker: Worker,
    canvas: HTMLCanvasElement,
    listeners: ViewListeners,
  ): Promise<WorkerView> {
    const surface = canvas.transferControlToOffscreen();
    const begin: ToView = {
      type: 'begin',
      canvas: surface,
      size: sizeOf(canvas),
      answers: listeners.coarse !== undefined,
    };
    worker.postMessage(begin, [surface]);
    const first = await answerOf(worker);
    if (first.type !== 'begun') {
      worker.terminate();
      throw new Error(
        first.type === 'failed' ? first.message : 'the worker that draws does not answer',
      );
    }
    return new WorkerView(worker, canvas, listeners, first.pose, first.renderer);
  }

  private constructor(
    private readonly worker: Worker,
    readonly canvas: HTMLCanvasElement,
    private readonly listeners: ViewListeners,
    public pose: Pose,
    readonly renderer: string,
  ) {
    worker.onmessage = (event: MessageEvent<FromView>) => {
      this.noteUnanswered(0);
      this.receive(event.data);
    };
    worker.onerror = (event) => listeners.failed?.(event.message);
    worker.onmessageerror = () => listeners.failed?.('a message cannot be read');
    this.timer = setInterval(() => this.ping(), kPingMs);
    canvas.style.touchAction = 'none';
    for (const type of kCanvasEvents)
      canvas.addEventListener(type, (event) => this.pass(event), {
        passive: false,
        signal: this.ended.signal,
      });
    for (const type of ['keydown', 'keyup'] as const) {
      document.addEventListener(
        type,
        (event) =>
          event.key === 'Control' && this.send({type: 'event', event: farEvent(event, canvas)}),
        {signal: this.ended.signal},
      );
    }
    const resized = (): void => this.send({type: 'size', size: sizeOf(canvas)});
    this.resizes = new ResizeObserver(resized);
    this.resizes.observe(canvas);
    this.ended.signal.addEventListener('abort', watchDensity(resized));
  }

  get cameraState(): CameraState {
    return this.pose.camera;
  }
  set cameraState(state: CameraState) {
    this.pose = {...this.pose, camera: checkedCamera(state), fitted: false};
    this.send({type: 'camera', state});
  }

  show(snapshot: Snapshot, drawn: (ms: number) => void, change: LatticeChange | null = null): void {
    const id = this.nextId++;
    this.shown.set(id, drawn);
    this.send({type: 'show', id, snapshot, change}, buffersOf(snapshot));
  }
  clear(): void {
    this.command('clear');
  }
  setLook(look: Look): void {
    const {map, reversed, edges, creases, opacity, volume = null, onDark = false} = look;
    const {beyond = [null, null]} = look;
    this.command('setLook', {map, reversed, edges, creases, opacity, beyond, volume, onDark});
  }
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): void {
    this.command('setRange', low, high, scaleRange, logarithmic);
  }
  setInsets(insets: Insets): void {
    this.command('setInsets', insets);
  }
  setCovered(insets: Insets | null): void {
    this.command('setCovered', insets);
  }
  setBoxed(boxed: Boxed | null): void {
    this.command('setBoxed', boxed);
  }
  setFocus(focus: number[] | null): void {
    this.command('setFocus', focus);
  }
  look(direction: Direction | null): void {
    this.command('look', checkedDirection(direction));
  }
  setParallel(parallel: boolean): void {
    this.command('setParallel', parallel);
  }
  setPlaying(everyMs: number): void {
    this.command('setPlaying', everyMs);
  }
  turn(horizontal: number, vertical: number): void {
    this.command('turn', horizontal, vertical);
  }
  pan(right: number, up: number): void {
    this.command('pan', right, up);
  }
  centre(point: Vector): void {
    this.command('centre', point);
  }
  zoom(factor: number): void {
    this.command('zoom', factor);
  }

  rayAt(x: number, y: number): Ray {
    return rayAt(this.pose, this.canvas, x, y);
  }
  project(point: Vector): {x: number; y: number} {
    return project(this.pose, this.canvas, point);
  }

  picture(background: string): Promise<Blob> {
    return this.take({type: 'picture', background});
  }
  render(frame: Frame): Promise<Rendered> {
    return this.take({type: 'render', frame});
  }

  dispose(): void {
    clearInterval(this.timer);
    this.ended.abort();
    this.resizes.disconnect();
    this.worker.terminate();
    for (const picture of this.pictures.values())
      picture.reject(new Error('the graphics have ended'));
    this.pictures.clear();
  }

  private take<Picture>(wanted: Wanted): Promise<Picture> {
    const id = this.nextId++;
    this.send({...wanted, id});
    return new Promise<unknown>((resolve, reject) =>
      this.pictures.set(id, {resolve, reject}),
    ) as Promise<Picture>;
  }

  private ping(): void {
    if (document.hidden) return;
    this.noteUnanswered(this.unanswered + 1);
    this.send({type: 'ping'});
  }

  private noteUnanswered(unanswered: number): void {
    const was = this.unanswered > kMaxUnanswered,
      is = unanswered > kMaxUnanswered;
    this.unanswered = unanswered;
    if (was !== is) this.listeners.silent?.(is);
  }

  private receive(message: FromView): void {
    switch (message.type) {
      case 'drawn':
        this.pose = message.pose;
        return this.listeners.drawn?.(message.pose);
      case 'shown':
        return taken(this.shown, message.id)?.(message.drawingMs);
      case 'pictured':
        return taken(this.pictures, message.id)?.resolve(message.picture);
      case 'failed':
        return taken(this.pictures, message.id)?.reject(new Error(message.message));
      case 'lost':
        return this.listeners.lost?.(message.lost);
      case 'works':
        return this.listeners.works?.(message.working);
      case 'coarse':
        return void this.coarse(message.id, message.have);
      case 'hello':
      case 'begun':
      case 'pong':
        return;
    }
  }

  private async coarse(id: number, have: number): Promise<void> {
    const answer = await this.listeners.coarse!(have).catch(() => null);
    this.send({type: 'coarse', id, answer}, answer?.cells ? buffersOfVolume(answer.cells) : []);
  }

  /** Captures the pointer for a drag that began on the canvas, as OrbitControls would. */
  private pass(event: PointerEvent | WheelEvent | MouseEvent): void {
    if (event.type === 'wheel' || event.type === 'contextmenu') event.preventDefault();
    if (event.type === 'pointerdown') {
      ++this.pressed;
      this.canvas.setPointerCapture((event as PointerEvent).pointerId);
    }
    if (event.type === 'pointermove' && this.pressed === 0) return;
    if (event.type === 'pointerup' || event.type === 'pointercancel')
      this.pressed = Math.max(0, this.pressed - 1);
    this.send({type: 'event', event: farEvent(event, this.canvas)});
  }

  private command<Name extends Command>(name: Name, ...words: Parameters<View[Name]>): void {
    this.send({type: 'command', name, words} as ToView);
  }

  private send(message: ToView, transfer: Transferable[] = []): void {
    this.worker.postMessage(message, transfer);
  }
}

/** Removes and returns what waits under `id`. */
function taken<Waiting>(asked: Map<number, Waiting>, id = -1): Waiting | undefined {
  const waiting = asked.get(id);
  asked.delete(id);
  return waiting;
}

function sizeOf({clientWidth, clientHeight}: HTMLCanvasElement): CanvasSize {
  return {
    width: Math.max(1, clientWidth),
    height: Math.max(1, clientHeight),
    pixelRatio: window.devicePixelRatio,
  };
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
