// Whether a fusion would flip a cell at an instant at which the mesh has moved (SERIES.md,
// "Moving meshes").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simplify/legality/local_star.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/moved_place.h"

namespace qtet {

class MovedCheck {
 public:
  /// `fields`: the fields of displacements of the instants that count (sampledDisplacements).
  /// REQUIRES: mesh, star and the list outlive this.
  MovedCheck(const FusionMesh& mesh, const LocalStar& star, std::span<const std::size_t> fields)
      : mesh_(mesh), star_(star), fields_(fields) {}

  /// Another star from here on.
  void forget() { places_.clear(); }
  /// Whether some affected cell is positive at an instant as it is, and is not with the prey at p.
  /// `integers`: what the fused vertex has of each of the fields, three a field. REQUIRES:
  /// LocalStar::gather was true, and the star was not taken since.
  [[nodiscard]] bool flipsAt(const LatticePoint& p, std::span<const std::int32_t> integers);

 private:
  void findPlaces();

  const FusionMesh& mesh_;
  const LocalStar& star_;
  std::span<const std::size_t> fields_;
  std::vector<MovedPoint> places_;  // the star's vertices at one instant after the other
};

}  // namespace qtet
