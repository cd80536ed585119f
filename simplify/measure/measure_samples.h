// Places that stand for a surface or a volume: uniform, stratified, and the same on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/mesh/measure_geometry.h"
#include "simplify/mesh/split_mix64.h"

namespace qtet {

/// Places that a thread takes at a time: handing them out costs as much as a few searches.
inline constexpr std::size_t kPlacesPerRun = 256;

/// A place in a cell, or on the triangle of a ghost cell: there the fourth weight is 0.
struct ErrorSample {
  Vector3 at;
  std::uint32_t cell;
  std::array<double, 4> weights;  ///< barycentric
};

/// The places of a cell's first N vertices.
template <std::size_t N, class Cell>
[[nodiscard]] std::array<Vector3, N> cornersOf(std::span<const LatticePoint> points,
                                               const Cell& cell) {
  std::array<Vector3, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = toVector(points[cell[i]]);
  return out;
}

/// Twice the area, by which triangles share out places.
[[nodiscard]] double placesMeasure(const std::array<Vector3, 3>& triangle);
/// Six times the volume's magnitude, by which tetrahedra do.
[[nodiscard]] double placesMeasure(const std::array<Vector3, 4>& tetrahedron);

/// Draws places while the cells of a mesh go by in their order: one in each of `count` equal parts
/// of the total measure. For each cell: enter, then `take` while it has a place.
class PlaceDraw {
 public:
  /// `total` is the sum of all measures, in the same order.
  PlaceDraw(double total, std::size_t count, std::uint64_t seed);

  void enter(double measure) {
    end_ += measure;
    isOpen_ = measure > 0;
  }
  [[nodiscard]] bool hasPlace() const { return isOpen_ && wanted_ < end_ && isWanting(); }
  /// Whether places are left. Rounding may leave one behind the last cell.
  [[nodiscard]] bool isWanting() const { return drawn_ < count_; }
  /// Barycentric weights of the place. REQUIRES: isWanting.
  [[nodiscard]] std::array<double, 4> takeInTriangle();
  [[nodiscard]] std::array<double, 4> takeInTetrahedron();

 private:
  void next();

  double total_ = 0, end_ = 0, wanted_ = 0;
  std::size_t count_ = 0, drawn_ = 0;
  bool isOpen_ = false;
  SplitMix64 random_;
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
