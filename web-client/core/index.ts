// qtet/core: a progressive mesh in a worker, without a rendering engine. Client in, Snapshots out.

export type {Vector, Plane} from './protocol/geometry';
export {Client, type Listener} from './session/client';
export type {Ray, Stretch} from './picture/cell_ray';
export {
  colorGradient,
  colorTable,
  isColorMapName,
  kColorMapEntries,
  kColorMapNames,
  type ColorMapName,
} from './picture/color_maps';
export type {Counts} from './protocol/counts';
export {fieldsOf} from './layers/shown';
export {
  kClipModes,
  kMaxPlanes,
  kPlainDisplay,
  type ClipMode,
  type Display,
} from './picture/display';
export {errorCode, errorText, QtetError} from './protocol/errors';
export {kMagnitude, scalarRange, type Scalar} from './picture/field_scale';
export type {FieldValue, LineValues, Pick, Probe} from './session/inspector';
export {errorOfLevel, kFull, limitText, parseLimit, type Limit} from './protocol/limit';
export {fieldKeys, type FieldInfo, type Instant} from './protocol/fields';
export type {LevelError, LevelInfo, Manifest, Spread} from './protocol/manifest';
export type {Statistics} from './decode/statistics';
export {logTicks, niceTicks, type Tick, type Ticks} from './picture/ticks';
export {kOpacityPath, transferTables, type TransferTables} from './picture/transfer';
export type {TriangleSoup} from './picture/triangle_soup';
export type {CoarseCells, VolumeCells} from './picture/volume';
export type {FromWorker, Snapshot, Source, StreamState} from './session/worker_messages';
