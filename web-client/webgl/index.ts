// qtet/webgl: a canvas that shows snapshots of qtet/core by WebGL 2, without another library.

export type {CameraState} from './camera';
export {kDirections, type Direction} from './directions';
export {MeshView} from './mesh_view';
export type {Pose} from './pose';
export type {Boxed, Frame, Insets, Look, Rendered, Tile, View, ViewListeners} from './view';
export {openView} from './worker_view';
