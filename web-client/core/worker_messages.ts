// What passes between the page and the worker that decodes. Typed arrays travel by transfer, never by copy.

import type {TransportKind} from './auto_transport';
import type {Ray, Vector} from './cell_ray';
import type {Display} from './display';
import type {Scalar} from './field_scale';
import type {Pick, Probe} from './inspector';
import type {Limit} from './limit';
import type {Manifest} from './manifest';
import type {Plane} from './slice';
import type {Statistics} from './statistics';
import type {TriangleSoup} from './triangle_soup';
import type {CellOrder, VolumeCells} from './volume';
import type {Wishes} from './wishes';

/** Where the stream stands. `paused`: by the user; `held`: the level that was asked for is here. */
export type StreamState = 'connecting' | 'streaming' | 'complete' | 'reconnecting' | 'paused' | 'held' | 'failed';

export interface Source {
  /** ws: or wss: address of /v1/stream; empty: there is none */
  url: string;
  /** Address of the log as a file, for byte ranges; of a server's also for its chunks (/v1/meshes/{id}/log) */
  log: string;
  /** `auto`: whatever works. */
  transport: 'auto' | TransportKind;
  mesh: string;
  /** Names of the fields to begin with, as the server calls them; null: the first one, whichever that is; empty: none. */
  fields: string[] | null;
  limit: Limit;
}

export type ToWorker =
  /** First of all: where the codec's WebAssembly lies. */
  | {type: 'load'; codecUrl: string}
  | {type: 'start'; source: Source}
  | {type: 'display'; display: Display}
  | {type: 'limit'; limit: Limit}
  | {type: 'look'; wishes: Wishes}
  | {type: 'pause'}
  | {type: 'resume'}
  /** The last snapshot is on the screen: the next may come. */
  | {type: 'shown'}
  | ({id: number} & Question);

/** Each is answered by an `answer` of the same id. */
export type Question =
  | {type: 'digest'}
  | {type: 'pick'; ray: Ray}
  | {type: 'probe'; from: Vector; to: Vector}
  /** Of the last snapshot's volume, as seen from `eye` (lattice coordinates). */
  | {type: 'order'; eye: Vector};

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

export type FromWorker =
  | {type: 'manifest'; manifest: Manifest; digest: string; fields: number[]}
  | {type: 'snapshot'; snapshot: Snapshot}
  | {type: 'progress'; statistics: Statistics; received: number}
  | {type: 'state'; state: StreamState; attempt: number; delayMs: number}
  | {type: 'error'; code: string; message: string}
  | {type: 'answer'; id: number; answer: string | Pick | Probe | CellOrder | null};
