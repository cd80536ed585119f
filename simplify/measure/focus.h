// The place in a mesh that its author refined.
#pragma once

#include <optional>

#include "codec/mesh/mesh.h"
#include "proto/manifest.h"

namespace qtet {

/// A box round the middle half of the cells along each axis, with some room. None if the cells are
/// spread over the mesh: the middle four fifths of them must lie within a quarter of its largest
/// extent. A far field has few large cells, so that the box holds what they surround. Integers
/// alone decide.
[[nodiscard]] std::optional<Focus> focusOf(const LatticeMesh& mesh);

}  // namespace qtet
