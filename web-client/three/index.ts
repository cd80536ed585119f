// qtet/three: snapshots of qtet/core as three.js objects, each with dispose(). The page brings its
// own three.

export {FieldMaterial} from './field_material';
export {SoupMesh} from './soup_mesh';
