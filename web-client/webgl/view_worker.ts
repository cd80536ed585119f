// Draws for a page, as a MeshView in a worker. So the page never waits for the graphics, which may
// take seconds to start and to compile. If workers cannot draw, the page loads this script itself
// and gets its MeshView (worker_view.ts).

import {errorText} from '../core/protocol/errors';
import type {CoarseCells} from '../core/picture/volume';
import {WorkerCanvas} from './worker_canvas';
import {MeshView} from './mesh_view';
import type {FromView, ToView} from './view_messages';

declare global {
  /** On a page, the class for worker_view.ts. */
  var qtetMeshView: typeof MeshView | undefined;
  /** For debugging and tests. */
  var qtetView: MeshView | undefined;
}

let canvas: WorkerCanvas | null = null;
let view: MeshView | null = null;
let nextId = 0;
const asked = new Map<number, {resolve(cells: CoarseCells): void; reject(why: Error): void}>();

function post(message: FromView, transfer: Transferable[] = []): void {
  self.postMessage(message, {transfer});
}

/** Answers with a picture. */
async function answer(
  id: number,
  taking: Promise<Extract<FromView, {type: 'pictured'}>['picture']>,
): Promise<void> {
  try {
    const picture = await taking;
    const bitmaps = 'tiles' in picture ? picture.tiles.map(({bitmap}) => bitmap) : [];
    post({type: 'pictured', id, picture}, bitmaps);
  } catch (thrown) {
    post({type: 'failed', id, message: errorText(thrown)});
  }
}

/** Asked of the page. */
function coarse(have: number): Promise<CoarseCells> {
  const id = nextId++;
  post({type: 'coarse', id, have});
  return new Promise((resolve, reject) => asked.set(id, {resolve, reject}));
}

function begin({canvas: surface, size, answers}: Extract<ToView, {type: 'begin'}>): void {
  canvas = new WorkerCanvas(surface);
  canvas.resize(size);
  try {
    view = globalThis.qtetView = new MeshView(canvas, {
      drawn: (pose) => view && post({type: 'drawn', pose}), // `begun` comes first
      lost: (lost) => post({type: 'lost', lost}),
      works: (working) => post({type: 'works', working}),
      ...(answers ? {coarse} : {}),
    });
    post({type: 'begun', pose: view.pose, renderer: view.renderer});
  } catch (thrown) {
    return post({type: 'failed', message: errorText(thrown)});
  }
  view.warmUp();
}

function obey(message: Exclude<ToView, {type: 'begin' | 'ping'}>, its: MeshView): void {
  switch (message.type) {
    case 'command':
      return (its[message.name] as (...words: unknown[]) => void)(...message.words);
    case 'camera':
      return void (its.cameraState = message.state);
    case 'size':
      return canvas?.resize(message.size);
    case 'event':
      return canvas?.receive(message.event);
    case 'show':
      return its.show(
        message.snapshot,
        (drawingMs) => post({type: 'shown', id: message.id, drawingMs}),
        message.change,
      );
    case 'picture':
      return void answer(message.id, its.picture(message.background));
    case 'render':
      return void answer(message.id, its.render(message.frame));
    case 'coarse': {
      const waiting = asked.get(message.id);
      asked.delete(message.id);
      if (message.answer) waiting?.resolve(message.answer);
      else waiting?.reject(new Error('there are no coarse cells'));
    }
  }
}

if (typeof document !== 'undefined') {
  globalThis.qtetMeshView = MeshView;
} else {
  self.onmessage = (event: MessageEvent<ToView>) => {
    if (event.data.type === 'ping') post({type: 'pong'});
    else if (event.data.type === 'begin') begin(event.data);
    else if (view) obey(event.data, view);
  };
  const draws =
    typeof OffscreenCanvas !== 'undefined' &&
    typeof WebGL2RenderingContext !== 'undefined' &&
    typeof requestAnimationFrame !== 'undefined';
  post({type: 'hello', url: self.location.href, draws});
}
