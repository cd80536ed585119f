// A TetMesh as a .vtu file.
#pragma once

#include "proto/bytes.h"
#include "simplify/tet_mesh.h"

namespace qtet {

/// Coordinates as Float32 if that loses nothing, else Float64; everything else as vtuBytes(VtuMesh).
[[nodiscard]] Bytes vtuBytes(const TetMesh& mesh);

}  // namespace qtet
