// Whether a mesh's coordinates were stored in floats too coarse for it. Far from the origin, as in
// a map's coordinates, float32 has few digits left for the shape.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// An edge has lost its shape where it is shorter than so many spacings of its coordinates.
/// Rounding has then turned it by up to an eighth.
inline constexpr double kSpacingsOfAnEdge = 8;
/// Coordinates are too coarse where more than this fraction of the edges has lost its shape; a few
/// short ones, as at seams, are usual.
inline constexpr double kLostEdges = 0.01;

/// A sentence on what float32 has lost: the spacing at the largest coordinate, how many edges it
/// spoils, and what to do. Empty where the points are no float32, or fine enough. The spacing
/// counts as too coarse as well where it is above the step of a lattice of 16 bits.
[[nodiscard]] std::optional<std::string> lostToFloats(const TetMesh& mesh);

/// The same of a mesh that comes in pieces.
class FloatSpacing {
 public:
  /// `low` and `high` are the corners of the whole mesh's box.
  FloatSpacing(const Position& low, const Position& high);
  void add(const TetMesh& piece);
  [[nodiscard]] std::optional<std::string> lost() const;

 private:
  double largest_ = 0;  // magnitude of a coordinate
  double longest_ = 0;  // side of the box
  double spacing_ = 0;
  bool isFloat32_ = false;
  std::uint64_t edges_ = 0, short_ = 0;  // an edge counts once for each cell that has it
};

}  // namespace qtet
