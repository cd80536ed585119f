// Lagrange and Bezier cells: where their nodes lie, and the linear cells between them. The order of
// nodes is VTK's; of pyramids, for which VTK has none, the corners come first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The highest degree that VTK knows; a hexahedron of it has 1,331 nodes.
inline constexpr int kMaxDegree = 10;

/// A cell field tells degrees that differ by direction, three a cell. A point field has a rational
/// Bezier cell's weights. Both are attributes of these names in VTK's files.
inline constexpr const char* kDegreesField = "HigherOrderDegrees";
inline constexpr const char* kWeightsField = "RationalWeights";

/// A tetrahedron's three are alike, as are those of a wedge's triangles.
using Degrees = std::array<int, 3>;
/// A node's place: steps of 1 / degree along each direction from corner 0. A pyramid of degree n
/// has (n - k + 1)^2 of them at height k, of which (i, j, k + 1) lies over the middle of (i, j, k)
/// and (i + 1, j + 1, k).
using NodePlace = std::array<int, 3>;

/// A linear part of a cell of higher degree. Its node numbers are as in VTK's linear cell, or an
/// octahedron's six in the order of a quadratic tetrahedron's edge nodes.
struct LinearPart {
  enum Kind : std::uint8_t { kTetrahedron, kOctahedron, kWedge, kHexahedron, kPyramid } kind{};
  std::array<std::uint16_t, 8> nodes{};
  [[nodiscard]] std::size_t size() const {
    return kind == kTetrahedron ? 4 : kind == kPyramid ? 5 : kind == kHexahedron ? 8 : 6;
  }
};

struct HigherCell {
  Degrees degrees{};
  std::vector<NodePlace> places;  ///< by node
  std::vector<LinearPart> parts;  ///< they fill the cell, and cut faces alike from both sides
};

[[nodiscard]] bool isHigherCell(std::uint8_t type);
[[nodiscard]] bool isBezierCell(std::uint8_t type);

/// The cell's degrees: as stated (a tuple of kDegreesField; empty: not), or such that all are
/// alike. nullopt: no cell of this type has so many nodes, or degrees beyond kMaxDegree.
[[nodiscard]] std::optional<Degrees> degreesOf(std::uint8_t type, std::size_t nodes,
                                               std::span<const double> stated);

/// Kept for the program's life. REQUIRES: what degreesOf gave for the type. Not for several threads
/// at once.
[[nodiscard]] const HigherCell& higherCell(std::uint8_t type, const Degrees& degrees);

}  // namespace qtet
