// qtet/three: snapshots of qtet/core as three.js objects, each with dispose(). The page brings its
// own three.

export {OrbitCamera, type CameraState} from './camera';
export {kDirections, type Direction} from './directions';
export {FieldMaterial} from './field_material';
export {openView} from './worker_view';
export {MeshView} from './mesh_view';
export type {Pose} from './pose';
export {SoupMesh} from './soup_mesh';
export type {Frame, Insets, Look, Tile, View, ViewListeners} from './view';
