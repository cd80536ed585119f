// The cell of a mesh that holds a point, and what its corners count there.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "codec/mesh/mesh.h"
#include "proto/level_error.h"

namespace qtet {

/// Lattice steps. A point no farther than that from a cell counts as one of it. The input's points
/// moved to the lattice by up to half a step on each axis, 0.87 together. So those of its surface
/// may lie outside.
inline constexpr double kNearSteps = 1;

struct PointInCell {
  CellId cell = 0;
  std::array<double, 4> weights{};  ///< barycentric: none negative, together 1
};

/// The first cell that holds `point` (lattice coordinates, not rounded). If none does, the nearest
/// cell within `near` steps, with the weights of its point nearest to `point`. Else nullopt. Cells
/// without volume hold nothing. Looks at every cell. REQUIRES: indices within range.
[[nodiscard]] std::optional<PointInCell> cellAtPoint(std::span<const LatticePoint> points,
                                                     std::span<const Tetrahedron> cells,
                                                     const std::array<double, 3>& point,
                                                     double near = kNearSteps);

/// Low and high corner of the points' box; both 0 without points.
[[nodiscard]] std::array<LatticePoint, 2> boxOf(std::span<const LatticePoint> points);

/// Lattice steps. A point of the original may lie so far outside a level: kNearSteps, and the known
/// distance from the original's boundary to the level's.
[[nodiscard]] double nearStepsOf(std::span<const LatticePoint> points,
                                 const std::optional<LevelError>& error);

}  // namespace qtet
