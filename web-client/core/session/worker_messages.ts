// Messages between the page and the worker that decodes. Typed arrays are transferred, never
// copied.

import type {LevelBytes} from '../decode/plan';
import type {Statistics} from '../decode/statistics';
import type {LayerSoups} from '../layers/shown';
import type {ArrowSoup} from '../picture/arrows';
import type {BaseFigures} from '../picture/base_figures';
import type {Ray} from '../picture/cell_ray';
import type {DerivedFields} from '../picture/derived_field';
import type {Display} from '../picture/display';
import type {Scalar} from '../picture/field_scale';
import type {Axis, Histogram} from '../picture/histogram';
import type {PartCount} from '../picture/part_counts';
import type {ShownLabels} from '../picture/labels';
import type {LineSoup} from '../picture/streamlines';
import type {TriangleSoup} from '../picture/triangle_soup';
import type {CoarseCells, VolumeCells} from '../picture/volume';
import type {Warp} from '../picture/warp';
import type {Vector, Plane} from '../protocol/geometry';
import {kFull, type Limit} from '../protocol/limit';
import type {Manifest} from '../protocol/manifest';
import type {LogAddress} from '../transport/transports';
import type {KeptPlaces, KeptValues, LineValues, Numbers, Pick, Probe} from './inspector';

/** The state of the stream. `paused`: by the user; `held`: it has reached the limit. */
export type StreamState =
  'connecting' | 'streaming' | 'complete' | 'reconnecting' | 'paused' | 'held' | 'failed';

export interface Source extends LogAddress {
  mesh: string;
  /** Keys of the fields, or series in a file, to begin with; null: the opening's; empty: none. */
  fields: string[] | null;
  /** Some of `fields` are series of a server's mesh, which asks for instants. */
  hasSeries?: boolean;
  /** The time at which series begin; null: that of the instants in the head. */
  time?: number | null;
  /** The log is a segment of a list: a single instant is a series, too. */
  isSegment?: boolean;
  limit: Limit;
  /** The network stays idle until `resume`. */
  paused?: boolean;
  /** A display follows soon: decoding sends a first picture before it refines. */
  pictureFirst?: boolean;
}

/** A source of which nothing is said. */
export const kNoSource: Source = {
  url: '',
  log: '',
  mesh: '',
  fields: null,
  limit: kFull,
  transport: 'auto',
};

export type ToWorker =
  /** The first message: where the codec's WebAssembly lies, and its part for the base mesh. */
  | {type: 'load'; baseUrl: string; codecUrl: string}
  /** `run` counts the starts. Messages of an earlier run concern another mesh. */
  | {type: 'start'; source: Source; run: number}
  | {type: 'display'; display: Display}
  | {type: 'limit'; limit: Limit}
  | {type: 'pause'}
  | {type: 'resume'}
  /** The last snapshot is on the screen, so that the next may come. */
  | {type: 'shown'; drawingMs?: number | undefined}
  /** The last snapshot is lost: send it again. */
  | {type: 'repeat'}
  | ({id: number} & Question);

/** The worker answers each by an `answer` with the same id. */
export type Question =
  | {type: 'digest'}
  /** Asks for the fields that a text defines, and those that the mesh implies. */
  | {type: 'derive'; text: string}
  | {type: 'pick'; ray: Ray}
  /** Asks for the streamline through a lattice place of a cell, of the display's vectors. */
  | {type: 'trace'; cell: number; place: Vector}
  | {type: 'probe'; from: Vector; to: Vector}
  | {type: 'line'; from: Vector; to: Vector}
  /** Asks for the cell at a lattice place of the mesh at rest. */
  | {type: 'at'; place: Vector}
  /** Asks for fields at a lattice place. */
  | {type: 'values'; place: Vector; fields: readonly number[]}
  /** Counts the values of the coloured field. */
  | {type: 'histogram'; axis: Axis}
  /** Counts the cells of the parts that a label makes. */
  | {type: 'parts'; field: number}
  /** Asks for kept points and lines, places of the mesh at rest, and for the extremes. */
  | {type: 'kept'; places: KeptPlaces}
  /** Asks for integrals over what is drawn. */
  | {type: 'numbers'}
  /** Asks for a volume with few cells. The page has version `have`. */
  | {type: 'coarse'; have: number};

/** The mesh without its warp. */
export interface AtRest {
  /** The surface's. */
  restBounds: number[];
  /** The ends of the lines along its creases, 6 lattice coordinates each; absent: not drawn. */
  restEdges?: Float32Array;
}

/** One consistent picture. Parts that have not changed are absent. */
export interface Snapshot extends LayerSoups {
  surface?: TriangleSoup;
  /** Null if none is wanted or there are no values yet. */
  volume?: VolumeCells | null;
  /** Null: there are none. */
  streamlines?: LineSoup | null;
  arrows?: ArrowSoup | null;
  /** One a plane. The parts above the other planes must be hidden, as for the surface. */
  cuts: TriangleSoup[];
  planes: Plane[];
  /** Bounds of the surface in lattice coordinates: [x0, y0, z0, x1, y1, z1]. */
  bounds: number[];
  /** How the vertices are moved; absent: they rest. */
  warp?: Warp & AtRest;
  /** The quantity that the soups' values show; null if there are none yet. */
  color: Scalar | null;
  /** A derived colour's id, and the fields that it is made of; absent: it is none. */
  derivedId?: number;
  inputs?: readonly number[];
  /** Those of a label in `color`; absent: it is none. */
  labels?: ShownLabels;
  /** The values that 0 and 1 stand for; `extent` is the part of [0, 1] that occurs. */
  scaleRange: [number, number];
  extent: [number, number];
  /**
   * Spread.middle of the values, as they were when the colour was first drawn: it stays while the
   * mesh refines.
   */
  middle: [number, number];
  /** The result of amountsOf at that time; absent without a volume. */
  amounts?: number[];
  statistics: Statistics;
  /** How long the worker took to make it. */
  costMs: number;
}

/** With its run. Messages without one come from before the first start. */
export type Posted = FromWorker & {run?: number};

/** The questions that an Inspector answers. */
export type Inspected = Exclude<Question, {type: 'digest' | 'derive' | 'coarse'}>;

export type Answer =
  | string
  | DerivedFields
  | Pick
  | Probe
  | LineValues[]
  | number[][]
  | Histogram
  | PartCount[]
  | KeptValues
  | Numbers
  | LineSoup
  | CoarseCells
  | null;

/** The newest figures of a log. */
export interface LogFigures {
  statistics: Statistics;
  /** Its bytes that have come. */
  received: number;
  /** The fields whose values are decoded for all of the present mesh. */
  here: readonly number[];
  /** An error keeps fields ahead from coming. */
  aheadEnded: boolean;
}

export type FromWorker =
  /** `isMore`: the same log's once more, with its later fields. */
  | {type: 'manifest'; manifest: Manifest; digest: string; fields: number[]; isMore?: boolean}
  /**
   * The result of planOf for the current fields. It is sent after `manifest` and whenever the
   * fields change.
   */
  | {type: 'plan'; plan: LevelBytes[]}
  /**
   * The base mesh is decoded with the values of the fields. Each log sends it once, so that the
   * first display can hold planes that stand at shares of its bounds.
   */
  | {type: 'base'; figures: BaseFigures}
  | {type: 'snapshot'; snapshot: Snapshot}
  | ({type: 'progress'} & LogFigures)
  | {type: 'state'; state: StreamState; attempt: number; delayMs: number}
  | {type: 'error'; code: string; message: string}
  | {type: 'answer'; id: number; answer: Answer};
