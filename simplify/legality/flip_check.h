// Whether a cell would flip, asked before the star is collected.
#pragma once

#include <array>
#include <cstdint>

#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

class FlipCheck {
 public:
  explicit FlipCheck(const FusionMesh& mesh) : mesh_(mesh) { forget(); }

  /// Another prey, or another mesh, from here on.
  void forget() { last_.fill(kNoCell); }
  /// Whether a cell of one of these prey vertices (one bit each) would flip or go flat with the
  /// prey at p, as far as doubles tell. REQUIRES: forget, when the last one was asked about another
  /// prey.
  [[nodiscard]] bool flipsAt(const Prey& prey, const LatticePoint& p, std::uint32_t moving) const;

 private:
  static constexpr CellId kNoCell = ~CellId{0};

  const FusionMesh& mesh_;
  // The cells that forbade the last point, one of each prey vertex. They are asked first about the
  // next one.
  mutable std::array<CellId, 4> last_;
};

}  // namespace qtet
