// Whether a fusion keeps the topology of regions (tissues, materials): of each, of the interfaces
// between them, of the lines and points where more meet (ALGORITHM.md, "Regions").
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

class RegionCheck {
 public:
  /// Regions that may meet in one star; a fusion among more of them is not tried. Grows the work by
  /// powers of two.
  static constexpr std::size_t kMaxRegions = 6;

  /// REQUIRES: mesh.hasRegions(), `star` the prey's, and the fusion keeps the topology of the mesh
  /// as a whole.
  [[nodiscard]] bool passes(const FusionMesh& mesh, const Prey& prey, const Star& star);

 private:
  using Mask = std::uint8_t;  // bit i: region i of regions_

  struct Simplex {
    std::array<VertexId, 4> vertex;  // sorted, the rest kNoVertex
    std::uint8_t size;
    Mask regions;  // of the star's cells that hold it
    Mask ofLink;   // of the link's triangles that hold it, where it lies on the link
  };

  [[nodiscard]] bool addCell(const FusionMesh& mesh, const Prey& prey, CellId c, bool affected);
  void merge();
  [[nodiscard]] bool isContractible(Mask regions);
  std::uint32_t root(std::uint32_t i);

  std::vector<std::int64_t> regions_;
  std::vector<Simplex> simplices_;
  std::vector<std::uint32_t> parent_;
  std::vector<VertexId> corners_;
};

}  // namespace qtet
