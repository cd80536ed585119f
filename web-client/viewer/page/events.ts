// The events of <qtet-viewer> and its attributes, as types.

import type {Statistics} from '../../core/decode/statistics';
import type {CameraState} from '../../webgl/camera';
import type {ViewAttribute} from '../settings/settings';

export interface QtetViewerEventMap {
  /** The first picture of a mesh is on the screen. */
  load: CustomEvent<Statistics>;
  /** More of the mesh is decoded. */
  progress: CustomEvent<Statistics>;
  /** A finer picture is on the screen. */
  refine: CustomEvent<Statistics>;
  /** The whole mesh is on the screen. */
  complete: CustomEvent<Statistics>;
  error: CustomEvent<{code: string; message: string}>;
  /** The camera has come to rest. */
  'camera-change': CustomEvent<CameraState>;
  /** The time bar shows another instant, or begins or ends to play. */
  'time-change': CustomEvent<{time: number; playing: boolean}>;
  'view-change': CustomEvent<{name: ViewAttribute; value: string | null}>;
}

/** For templates that are checked: `interface IntrinsicElements {'qtet-viewer': ...}`. */
export type QtetViewerAttributes = Partial<
  Record<'src' | 'transport' | 'time-group' | ViewAttribute, string>
>;
