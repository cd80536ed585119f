// How well shaped the cells round a prey are, and would be with the prey elsewhere
// (ALGORITHM.md, "Shape").
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "simplify/legality/fixed_list.h"
#include "simplify/legality/local_star.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/two_vectors.h"

namespace qtet {

/// A shape is 1 for a regular cell, 0 for a flat one.
class StarShapes {
 public:
  /// `floor`: FusionLimits::shapeFloor. REQUIRES: both outlive this.
  StarShapes(const FusionMesh& mesh, const LocalStar& star, double floor)
      : mesh_(mesh), star_(star), floor_(floor) {}

  /// Takes the star as it is now. REQUIRES: LocalStar::gather was true.
  void measure();
  /// The worst shape in the star as it is. REQUIRES: measure.
  [[nodiscard]] double old() const { return old_; }
  /// The worst shape among the affected cells with the prey at p. Negative where a cell would flip
  /// or be squashed, or where the shape is worse than `least`. REQUIRES: measure, and the star not
  /// taken since.
  [[nodiscard]] double at(const LatticePoint& p, double least) const;

 private:
  // The bases of two affected cells: volume and shape with an apex d, both relative to the first
  // prey vertex. The last may be one cell's twice.
  struct Bases {
    TwoVectors normal;   // of twice the area, towards the apex
    Pair height;         // normal . a corner
    TwoVectors corners;  // sum of the corners
    // of the three edges and the corners' distances from the origin
    Pair squares;
    std::array<std::uint32_t, 2> cell;  // places in Star::affected
  };
  using Places = std::span<const Vector3>;  // by local vertex, relative to the first prey vertex
  [[nodiscard]] double addBases(std::uint32_t i, std::uint32_t j, Places places);
  [[nodiscard]] double exactVolume6(std::uint32_t affected, const LatticePoint& p,
                                    bool& allowed) const;

  const FusionMesh& mesh_;
  const LocalStar& star_;
  double floor_;
  FixedList<Bases, kMaxStarCells / 4> bases_;
  Vector3 origin_{};  // the first prey vertex
  double reach_ = 0;  // the star's largest coordinate
  double old_ = 1;
  // The index in bases_ of the cells that forbade the last point. They are asked first about the
  // next one.
  mutable std::size_t suspect_ = 0;
};

}  // namespace qtet
