// qtet/three: Snapshots of qtet/core as three.js objects, each with dispose(). three is the page's own.

export {OrbitCamera, type CameraState} from './camera';
export {kDirections, type Direction} from './directions';
export {FieldMaterial} from './field_material';
export {MeshView, type Insets, type Look, type ViewListeners} from './mesh_view';
export {SoupMesh} from './soup_mesh';
