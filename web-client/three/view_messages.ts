// What passes between a page and the worker that draws for it. A snapshot's arrays travel by
// transfer.

import type {CoarseCells} from '../core/volume';
import type {Snapshot} from '../core/worker_messages';
import type {CameraState} from './camera';
import type {FarEvent, FarSize} from './far_canvas';
import type {Pose} from './pose';
import type {View} from './view';

/** Methods of View that answer nothing. */
export type Command =
  'clear' | 'setLook' | 'setRange' | 'setInsets' | 'look' | 'setParallel' | 'turn' | 'zoom';

export type ToView =
  /** First of all. */
  | {type: 'begin'; canvas: OffscreenCanvas; size: FarSize; answers: boolean}
  | {[Name in Command]: {type: 'command'; name: Name; words: Parameters<View[Name]>}}[Command]
  | {type: 'camera'; state: CameraState}
  | {type: 'size'; size: FarSize}
  | {type: 'event'; event: FarEvent}
  | {type: 'show'; id: number; snapshot: Snapshot}
  | {type: 'picture'; id: number; background: string}
  /** Is anybody there? */
  | {type: 'ping'}
  /** Answers `coarse`; null: there are none. */
  | {type: 'coarse'; id: number; answer: CoarseCells | null};

export type FromView =
  /** The worker runs: its own address, and whether it can draw with WebGL 2. */
  | {type: 'hello'; url: string; draws: boolean}
  | {type: 'drawn'; pose: Pose}
  | {type: 'shown'; id: number; drawingMs: number}
  | {type: 'pong'}
  | {type: 'lost'; lost: boolean}
  | {type: 'coarse'; id: number; have: number}
  | {type: 'pictured'; id: number; blob: Blob}
  /** `id`: of the picture that cannot be taken; without one the view cannot start. */
  | {type: 'failed'; message: string; id?: number};
