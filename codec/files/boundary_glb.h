// The boundary surface of a mesh as binary glTF 2.0: with KHR_draco_mesh_compression, which
// three.js, Babylon.js, Cesium and Blender read, or plain.
#pragma once

#include "codec/mesh/mesh.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// One mesh of one primitive: the bytes of boundaryDrc, and accessors that describe them. A point
/// field of 1 to 4 components without missing values is the attribute "_NAME" (glTF wants the
/// underscore); others are in the Draco bytes and not named. The first point field is the colours,
/// too: COLOR_0, viridis over the field's range, grey where it has missing values. Axes and units
/// are the mesh's own. Where float32 is too coarse for the mesh's places, positions are relative to
/// the lattice's origin, and the node's translation is that origin. REQUIRES and errors: those of
/// boundaryDrc; also bad-input for 4 GiB or more in all: .glb counts with 32 bits.
[[nodiscard]] Result<Bytes> boundaryGlb(const LatticeMesh& mesh);

/// The same without Draco, for readers that do not know the extension (VTK). Points, triangles,
/// colours and the named fields are plain accessors. Positions (with the node's translation as
/// above) and fields are float32. Points have
/// the order of the mesh. REQUIRES: as boundaryDrc. Errors: bad-input (no boundary; coordinates of
/// 1e38 and more; 4 GiB or more in all).
[[nodiscard]] Result<Bytes> plainBoundaryGlb(const LatticeMesh& mesh);

}  // namespace qtet
