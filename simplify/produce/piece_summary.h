// The summary of a mesh whose pieces are files of their own: a .pvtu.
#pragma once

#include <span>
#include <string>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// `shape` has the fields of each piece, `files` are named relative to the summary.
[[nodiscard]] std::string pieceSummary(const TetMesh& shape, std::span<const std::string> files);

}  // namespace qtet
