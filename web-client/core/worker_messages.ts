// What passes between the page and the worker that decodes. Typed arrays travel by transfer, never by copy.

import type {Manifest} from './manifest';
import type {Plane} from './slice';
import type {Statistics} from './statistics';
import type {TriangleSoup} from './triangle_soup';

/** Where the stream stands. `paused`: by the user, or because the page's budget of bytes is spent. */
export type StreamState = 'connecting' | 'streaming' | 'complete' | 'reconnecting' | 'paused' | 'failed';

export interface Source {
  /** ws: or wss: address of /v1/stream */
  url: string;
  mesh: string;
  /** Name of the field to show; null: the first one, whichever that is; empty: the mesh has none. */
  field: string | null;
  /** Payload bytes after which to pause; 0: never. */
  pauseAfter: number;
}

export type ToWorker =
  | {type: 'start'; source: Source}
  | {type: 'field'; name: string}
  | {type: 'clip'; plane: Plane | null}
  | {type: 'pause'}
  | {type: 'resume'}
  /** The last snapshot is on the screen: the next may come. */
  | {type: 'shown'}
  | {type: 'digest'; id: number};

/** One consistent picture; what did not change since the last one is absent. */
export interface Snapshot {
  surface?: TriangleSoup;
  /** The cut along `plane`; null: nothing is clipped. */
  cut?: {plane: Plane; cap: TriangleSoup} | null;
  /** Bounds of the surface in lattice coordinates: [x0, y0, z0, x1, y1, z1]. */
  bounds: number[];
  /** Index of the field that the values belong to, -1: none. */
  field: number;
  statistics: Statistics;
}

export type FromWorker =
  | {type: 'manifest'; manifest: Manifest; digest: string}
  | {type: 'snapshot'; snapshot: Snapshot}
  | {type: 'progress'; statistics: Statistics}
  | {type: 'state'; state: StreamState; attempt: number; delayMs: number}
  | {type: 'error'; code: string; message: string}
  | {type: 'digest'; id: number; hex: string};
