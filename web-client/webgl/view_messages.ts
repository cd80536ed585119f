// Messages between a page and the worker that draws for it. A snapshot's arrays are transferred.

import type {CoarseCells} from '../core/picture/volume';
import type {LatticeChange} from '../core/protocol/geometry';
import type {Snapshot} from '../core/session/worker_messages';
import type {CameraState} from './camera';
import type {CanvasEvent, CanvasSize} from './worker_canvas';
import type {Pose} from './pose';
import type {Frame, Rendered, View} from './view';

/** Methods of View without a result. */
export type Command =
  | 'clear'
  | 'setLook'
  | 'setRange'
  | 'setInsets'
  | 'setCovered'
  | 'setBoxed'
  | 'setFocus'
  | 'pan'
  | 'centre'
  | 'look'
  | 'setParallel'
  | 'setPlaying'
  | 'turn'
  | 'zoom';

export type ToView =
  /** The first message. */
  | {type: 'begin'; canvas: OffscreenCanvas; size: CanvasSize; answers: boolean}
  | {[Name in Command]: {type: 'command'; name: Name; words: Parameters<View[Name]>}}[Command]
  | {type: 'camera'; state: CameraState}
  | {type: 'size'; size: CanvasSize}
  | {type: 'event'; event: CanvasEvent}
  | {type: 'show'; id: number; snapshot: Snapshot; change: LatticeChange | null}
  | ({id: number} & Wanted)
  /** Asks whether the worker responds. */
  | {type: 'ping'}
  /** Answers `coarse`; null if there are no cells. */
  | {type: 'coarse'; id: number; answer: CoarseCells | null};

/** The worker answers each by `pictured` or `failed` with the same id. */
export type Wanted = {type: 'picture'; background: string} | {type: 'render'; frame: Frame};

export type FromView =
  /** The worker is running. It tells its own address, and whether it can draw with WebGL 2. */
  | {type: 'hello'; url: string; draws: boolean}
  /** Answers `begin`. */
  | {type: 'begun'; pose: Pose; renderer: string}
  | {type: 'drawn'; pose: Pose}
  | {type: 'shown'; id: number; drawingMs: number}
  | {type: 'pong'}
  | {type: 'works'; working: boolean}
  | {type: 'lost'; lost: boolean}
  | {type: 'coarse'; id: number; have: number}
  | {type: 'pictured'; id: number; picture: Blob | Rendered}
  /** With `id` this picture cannot be taken; without it the view cannot start. */
  | {type: 'failed'; message: string; id?: number};
