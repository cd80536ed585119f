// Reading meshes through VTK: .vtu (any encoding) and legacy .vtk. Nothing but this file and vtk_grid.cpp uses VTK.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/tet_mesh.h"

namespace qtet {

/// What was in the file and is not in the mesh; `notes` says it in sentences for people.
struct ReadReport {
  std::uint64_t ignoredCells = 0;          ///< of dimension 0, 1 or 2
  std::vector<std::string> ignoredFields;  ///< texts, more than kMaxFieldComponents components
  std::vector<std::string> notes;          ///< also VTK's warnings
};

struct ReadMesh {
  TetMesh mesh;
  ReadReport report;
};

/// Which fields to read: all (nullopt: those of points first), or those of these names, in this order. A name means every field that has
/// it; "point:NAME" and "cell:NAME" mean one of two that share a name.
using FieldNames = std::optional<std::vector<std::string>>;

/// Reads tetrahedra, points and fields, with the file's numbering (`mesh.tetrahedra[i]` is the i-th tetrahedron; cells of lower
/// dimension are skipped, with their values). Vertex ids are checked. Field values keep NaN and infinity; coordinates must be finite.
/// Errors: those of checkVtkFile; bad-input (VTK's own message; cells of another kind; no tetrahedra; a coordinate that is not finite;
/// a vertex id outside the points; an integer above 2^53 in magnitude), not-found (no field of that name), limit-exceeded.
/// Not thread-safe: VTK's message window is global.
[[nodiscard]] Result<ReadMesh> readMesh(const std::filesystem::path& path, const FieldNames& fields = std::nullopt);

}  // namespace qtet
