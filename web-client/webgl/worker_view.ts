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
import {forwardEvents} from './canvas_events';
import type {CanvasSize} from './worker_canvas';
import {checkedCamera, project, rayAt, type Pose} from './pose';
import type {Boxed, Frame, Insets, Look, Rendered, View, ViewListeners} from './view';
import type {Command, FromView, ToView, Wanted} from './view_messages';
import {watchWorker} from './worker_watch';

interface ViewPort {
  postMessage(message: ToView, transfer?: Transferable[]): void;
}

/**
 * A view of `canvas`, drawn by a worker if workers can draw, else on this thread. Throws if the
 * browser has no WebGL 2 or the network fails.
 */
export async function openView(canvas: HTMLCanvasElement, listeners: ViewListeners): Promise<View> {
  const {worker, url, draws} = await retry(startWorker);
  if (draws && 'transferControlToOffscreen' in canvas) return begin(worker, canvas, listeners);
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

async function begin(
  worker: Worker,
  canvas: HTMLCanvasElement,
  listeners: ViewListeners,
): Promise<WorkerView> {
  const surface = canvas.transferControlToOffscreen();
  const message: ToView = {
    type: 'begin',
    canvas: surface,
    size: sizeOf(canvas),
    answers: listeners.coarse !== undefined,
  };
  worker.postMessage(message, [surface]);
  const first = await answerOf(worker);
  if (first.type !== 'begun') {
    worker.terminate();
    throw new Error(
      first.type === 'failed' ? first.message : 'the worker that draws does not answer',
    );
  }
  return new WorkerView(worker, canvas, listeners, first.pose, first.renderer);
}

class WorkerView implements View {
  private readonly shown = new Map<number, (ms: number) => void>();
  private readonly pictures = new Map<
    number,
    {resolve(picture: unknown): void; reject(why: Error): void}
  >();
  private readonly ended = new AbortController();
  private nextId = 0;

  constructor(
    private readonly worker: Omit<Worker, 'postMessage'> & ViewPort,
    readonly canvas: HTMLCanvasElement,
    private readonly listeners: ViewListeners,
    public pose: Pose,
    readonly renderer: string,
  ) {
    const {signal} = this.ended;
    const answered = watchWorker(
      () => worker.postMessage({type: 'ping'}),
      (silent) => listeners.silent?.(silent),
      signal,
    );
    worker.onmessage = (event: MessageEvent<FromView>) => {
      answered();
      this.receive(event.data);
    };
    worker.onerror = (event) => listeners.failed?.(event.message);
    worker.onmessageerror = () => listeners.failed?.('a message cannot be read');
    forwardEvents(canvas, (event) => worker.postMessage({type: 'event', event}), signal);
    const resized = (): void => worker.postMessage({type: 'size', size: sizeOf(canvas)});
    const resizes = new ResizeObserver(resized);
    resizes.observe(canvas);
    signal.addEventListener('abort', () => resizes.disconnect());
    signal.addEventListener('abort', watchDensity(resized));
  }

  get cameraState(): CameraState {
    return this.pose.camera;
  }
  set cameraState(state: CameraState) {
    this.pose = {...this.pose, camera: checkedCamera(state), fitted: false};
    this.worker.postMessage({type: 'camera', state});
  }

  show(snapshot: Snapshot, drawn: (ms: number) => void, change: LatticeChange | null = null): void {
    const id = this.nextId++;
    this.shown.set(id, drawn);
    this.worker.postMessage({type: 'show', id, snapshot, change}, buffersOf(snapshot));
  }
  clear(): void {
    this.command('clear');
  }
  setLook(look: Look): void {
    const {map, reversed, edges, creases, opacity, volume = null, onDark = false} = look;
    const {beyond = [null, null], lines = '', moves = false} = look;
    const its = {map, reversed, edges, creases, opacity, beyond, volume, onDark, lines, moves};
    this.command('setLook', its);
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
    this.ended.abort();
    this.worker.terminate();
    for (const picture of this.pictures.values())
      picture.reject(new Error('the graphics have ended'));
    this.pictures.clear();
  }

  private take<Picture>(wanted: Wanted): Promise<Picture> {
    const id = this.nextId++;
    this.worker.postMessage({...wanted, id});
    return new Promise<unknown>((resolve, reject) =>
      this.pictures.set(id, {resolve, reject}),
    ) as Promise<Picture>;
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
        return void this.listeners.coarse!(message.have)
          .catch(() => null)
          .then((answer) =>
            this.worker.postMessage(
              {type: 'coarse', id: message.id, answer},
              answer?.cells ? buffersOfVolume(answer.cells) : [],
            ),
          );
      case 'hello':
      case 'begun':
      case 'pong':
        return;
    }
  }

  private command<Name extends Command>(name: Name, ...words: Parameters<View[Name]>): void {
    this.worker.postMessage({type: 'command', name, words} as ToView);
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
