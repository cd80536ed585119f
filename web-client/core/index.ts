// qtet/core: a progressive mesh in a worker, without a rendering engine. Client in, Snapshots out.

export {Client, type Listener} from './client';
export type {Ray, Stretch, Vector} from './cell_ray';
export {
  colorGradient,
  colorTable,
  isColorMapName,
  kColorMapEntries,
  kColorMapNames,
  type ColorMapName,
} from './color_maps';
export type {Counts} from './counts';
export {
  fieldsOf,
  kClipModes,
  kMaxPlanes,
  kPlainDisplay,
  type ClipMode,
  type Display,
} from './display';
export {errorCode, errorText, QtetError} from './errors';
export {kMagnitude, scalarRange, type Scalar} from './field_scale';
export type {FieldValue, Pick, Probe} from './inspector';
export {errorOfLevel, kFull, limitText, parseLimit, type Limit} from './limit';
export {
  fieldKeys,
  type FieldInfo,
  type LevelError,
  type LevelInfo,
  type Manifest,
  type Spread,
} from './manifest';
export type {Plane} from './slice';
export type {Statistics} from './statistics';
export {logTicks, niceTicks, type Tick, type Ticks} from './ticks';
export {kOpacityPath, transferTables, type TransferTables} from './transfer';
export type {TriangleSoup} from './triangle_soup';
export type {CoarseCells, VolumeCells} from './volume';
export {kNoViewRequest, type ViewRequest} from './view_request';
// Aliases of version 0.1.
export {kMaxPlanes as kMostPlanes} from './display';
export {kNoViewRequest as kNoWishes, type ViewRequest as Wishes} from './view_request';
export type {FromWorker, Snapshot, Source, StreamState} from './worker_messages';
