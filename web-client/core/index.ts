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
  kMostPlanes,
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
export {kNoWishes, type Wishes} from './wishes';
export type {FromWorker, Snapshot, Source, StreamState} from './worker_messages';
