// What passes between the page and the worker that decodes. Typed arrays travel by transfer, never
// by copy.

import type {TransportKind} from './auto_transport';
import type {Ray, Vector} from './cell_ray';
import type {Display} from './display';
import type {Scalar} from './field_scale';
import type {LevelBytes} from './goal';
import type {Pick, Probe} from './inspector';
import type {Limit} from './limit';
import type {Manifest} from './manifest';
import type {Plane} from './slice';
import type {Statistics} from './statistics';
import type {TriangleSoup} from './triangle_soup';
import type {CoarseCells, VolumeCells} from './volume';
import type {ViewRequest} from './view_request';

/** Where the stream stands. `paused`: by the user; `held`: the level that was asked for is here. */
export type StreamState =
  'connecting' | 'streaming' | 'complete' | 'reconnecting' | 'paused' | 'held' | 'failed';

export interface Source {
  /** ws: or wss: address of /v1/stream; empty: there is none */
  url: string;
  /**
   * Address of the log as a file, for byte ranges; of a server's also for its chunks
   * (/v1/meshes/{id}/log)
   */
  log: string;
  /** `auto`: whatever works. */
  transport: 'auto' | TransportKind;
  /**
   * Where the server wants one for reading: sent with requests, and traded for a ticket before a
   * WebSocket.
   */
  token?: string;
  mesh: string;
  /**
   * Names of the fields to begin with, as the server calls them; null: the first one, whichever
   * that is; empty: none.
   */
  fields: string[] | null;
  limit: Limit;
  /** Nothing is asked of the network before `resume`. */
  paused?: boolean;
  /** A display follows soon: decoding lets its first picture go before what is finer. */
  pictureFirst?: boolean;
}

export type ToWorker =
  /** First of all: where the codec's WebAssembly lies. */
  | {type: 'load'; codecUrl: string}
  /** `run` counts the starts: what the worker says of an earlier one is of another mesh. */
  | {type: 'start'; source: Source; run: number}
  | {type: 'display'; display: Display}
  | {type: 'limit'; limit: Limit}
  | {type: 'look'; view: ViewRequest}
  | {type: 'pause'}
  | {type: 'resume'}
  /** The last snapshot is on the screen: the next may come. */
  | {type: 'shown'; drawingMs?: number | undefined}
  /** What was sent is lost: the picture once more. */
  | {type: 'repeat'}
  | ({id: number} & Question);

/** Each is answered by an `answer` of the same id. */
export type Question =
  | {type: 'digest'}
  | {type: 'pick'; ray: Ray}
  | {type: 'probe'; from: Vector; to: Vector}
  /** A volume with few cells, of which the page has version `have`; null: there is none. */
  | {type: 'coarse'; have: number};

/** One consistent picture; what did not change since the last one is absent. */
export interface Snapshot {
  surface?: TriangleSoup;
  isosurface?: TriangleSoup;
  /** null: none is wanted, or there are no values yet. */
  volume?: VolumeCells | null;
  /** One a plane; of each, and of the surface, nothing is to be seen above the (other) planes. */
  cuts: TriangleSoup[];
  planes: Plane[];
  /** Bounds of the surface in lattice coordinates: [x0, y0, z0, x1, y1, z1]. */
  bounds: number[];
  /** What the soups' values are of; null: there are none yet. */
  color: Scalar | null;
  /** What 0 and 1 of them mean, and which of them occur. */
  scaleRange: [number, number];
  extent: [number, number];
  statistics: Statistics;
  /** What making it took in the worker. */
  costMs: number;
}

/** As it travels; without a run it comes from before the first start. */
export type Posted = FromWorker & {run?: number};

export type FromWorker =
  | {type: 'manifest'; manifest: Manifest; digest: string; fields: number[]}
  /**
   * What the fields of now will take, as planOf tells it: after `manifest`, and whenever other
   * fields are wanted.
   */
  | {type: 'plan'; plan: LevelBytes[]}
  | {type: 'snapshot'; snapshot: Snapshot}
  | {type: 'progress'; statistics: Statistics; received: number}
  | {type: 'state'; state: StreamState; attempt: number; delayMs: number}
  | {type: 'error'; code: string; message: string}
  | {type: 'answer'; id: number; answer: string | Pick | Probe | CoarseCells | null};
