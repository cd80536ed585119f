// The displacements that move the mesh in the viewer's first picture
// (web-client/viewer/settings/warp.ts, firstWarp).
#pragma once

#include <cstdint>
#include <optional>

#include "codec/mesh/mesh.h"
#include "proto/manifest.h"

namespace qtet {

/// The first point field of displacements that a viewer has with its first picture: of a series the
/// instant in the head. None if there is none.
[[nodiscard]] std::optional<std::uint32_t> displacementOf(const Manifest& manifest);

/// Moves the points by the field that displacementOf names. The largest displacement must pass an
/// edge of the whole mesh, and be seen at true size. Points whose values are missing stay. All stay
/// if `mesh` does not have the field. REQUIRES: a boundary; the log's lattice.
void moveAsFirstShown(LatticeMesh& mesh, const Manifest& manifest);

}  // namespace qtet
