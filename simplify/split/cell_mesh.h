// A mesh of any volume cells as its file has it, before its cells are split (split_cells.h). Every
// reader makes one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// VTK's numbers for kinds of cells (but for the last two), with VTK's order of vertices, whatever
/// the file was.
enum CellType : std::uint8_t {
  kTetrahedronCell = 10,
  kVoxelCell = 11,
  kHexahedronCell = 12,
  kWedgeCell = 13,
  kPyramidCell = 14,
  kPentagonalPrismCell = 15,
  kHexagonalPrismCell = 16,
  kQuadraticTetrahedronCell = 24,
  kQuadraticHexahedronCell = 25,
  kQuadraticWedgeCell = 26,
  kQuadraticPyramidCell = 27,
  kTriquadraticHexahedronCell = 29,
  kQuadraticLinearWedgeCell = 31,
  kBiquadraticQuadraticWedgeCell = 32,
  kBiquadraticQuadraticHexahedronCell = 33,
  kTriquadraticPyramidCell = 37,
  kPolyhedronCell = 42,
  kLagrangeTetrahedronCell = 71,
  kLagrangeHexahedronCell = 72,
  kLagrangeWedgeCell = 73,
  kBezierTetrahedronCell = 78,
  kBezierHexahedronCell = 79,
  kBezierWedgeCell = 80,
  /// Not VTK's: a quadratic pyramid with a node at the centre of its base.
  kBiquadraticPyramidCell = 250,
  /// Not VTK's, which has a number for it (74) and no order of its nodes: that of higherCell.
  kLagrangePyramidCell = 251,
};

/// Numbers that name a polyhedron's faces: real ones have some hundred, and splitting one takes
/// time in proportion to the square.
inline constexpr std::size_t kMaxPolyhedronNumbers = 16384;

/// Calls visit(id) with each vertex among the `ids` of a cell (CellMesh::vertices), a polyhedron's
/// counts left out. A count that goes beyond the ids' end ends there.
template <class Id, class Visit>
void forEachId(std::uint8_t type, std::span<Id> ids, const Visit& visit) {
  if (type != kPolyhedronCell) {
    for (Id& id : ids) visit(id);
    return;
  }
  for (std::size_t at = 1; at < ids.size();) {
    const std::size_t end = at + 1 + std::min<std::size_t>(ids[at], ids.size() - at - 1);
    for (++at; at < end; ++at) visit(ids[at]);
  }
}

/// A label that the structure of the file gives its cells, such as its blocks. It is no field of
/// the file, and the same at all time steps (read/steps/cell_labels.h).
struct CellLabel {
  std::string name;
  std::vector<std::int32_t> values;  ///< one a cell; 0: none
  LabelNames names;
};

/// Cells of three dimensions only. `vertices` of a polyhedron: the number of its faces, then each
/// face's number of vertices and its vertices.
struct CellMesh {
  std::vector<Position> points;
  std::vector<std::uint8_t> types;  ///< CellType, one a cell
  /// Where each cell's vertices begin, and the end of the last.
  std::vector<std::uint64_t> begins{0};
  std::vector<VertexId> vertices;        ///< kGhost stands for an id that the file must not hold
  std::vector<std::uint64_t> cellIds;    ///< each cell's number in the file; empty: 0, 1, 2 ...
  std::vector<MeshField> fields;         ///< one tuple a point, or a cell of `types`
  std::vector<std::string> otherFields;  ///< names of the file's fields that are not wanted
  std::string pointType{};               ///< as TetMesh's
  /// The file's own number of each point in all of its pieces (GlobalNodeIds and the like); empty:
  /// none.
  std::vector<std::uint64_t> pointIds{};
  std::vector<CellLabel> labels{};

  [[nodiscard]] std::size_t cells() const { return types.size(); }
  [[nodiscard]] std::span<const VertexId> cell(std::size_t i) const {
    return std::span(vertices).subspan(begins[i], begins[i + 1] - begins[i]);
  }
  [[nodiscard]] std::uint64_t cellId(std::size_t i) const {
    return cellIds.empty() ? i : cellIds[i];
  }
  void addCell(std::uint8_t type, std::span<const VertexId> ids) {
    types.push_back(type);
    vertices.insert(vertices.end(), ids.begin(), ids.end());
    begins.push_back(vertices.size());
  }
  /// Each cell names names[v] in place of the point v. REQUIRES: ids below the number of names, or
  /// kGhost (counts in a polyhedron's stream apart).
  void renamePoints(std::span<const VertexId> names);
};

/// "hexahedron"; "cell of VTK type 41" for a kind that is not read.
[[nodiscard]] std::string cellTypeName(std::uint8_t type);

/// How many vertices a cell of this type has; 0: any number (polyhedra, cells of higher degree), or
/// a kind that is not read.
[[nodiscard]] std::uint32_t verticesOf(std::uint8_t type);

/// Errors: bad-input (the first cell, named, of a kind that is not read, with too few or too many
/// vertices, or with an id outside the points; no points; no cells; a coordinate that is not
/// finite; a field of a wrong length). limit-exceeded (points, the faces of a polyhedron).
[[nodiscard]] Status checkCellMesh(const CellMesh& mesh, const std::filesystem::path& path);

}  // namespace qtet
