// Places that stand for a surface or a volume: uniform, stratified, and the same on every machine.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/mesh/measure_geometry.h"

namespace qtet {

/// Places that a thread takes at a time: handing them out costs as much as a few searches.
inline constexpr std::size_t kPlacesPerRun = 256;

/// A place in a cell, or on the triangle of a ghost cell: there the fourth weight is 0.
struct ErrorSample {
  Vector3 at;
  std::uint32_t cell;
  std::array<double, 4> weights;  ///< barycentric
};

using CellSpan = std::span<const std::array<VertexId, 4>>;

/// `count` places uniform by area on the triangles `ids` (the first three vertices of these cells),
/// by strata along their order. Empty where all triangles are degenerate.
[[nodiscard]] std::vector<ErrorSample> samplesOnSurface(std::span<const LatticePoint> points,
                                                        CellSpan cells,
                                                        std::span<const std::uint32_t> ids,
                                                        std::size_t count, std::uint64_t seed);
/// The same by volume in the cells that have no ghost vertex; an inverted cell counts with its
/// volume's magnitude.
[[nodiscard]] std::vector<ErrorSample> samplesInVolume(std::span<const LatticePoint> points,
                                                       CellSpan cells, std::size_t count,
                                                       std::uint64_t seed);

}  // namespace qtet
