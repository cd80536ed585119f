// The lattice of a mesh, whether the mesh is at hand or comes in pieces (quantise.h).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "codec/mesh/predicates.h"
#include "simplify/clean/quantise.h"

namespace qtet {

/// The lowest and highest coordinates of some points.
struct PointBox {
  bool isEmpty = true;
  Position low{}, high{};

  void include(std::span<const Position> points);
  /// The longest side; infinite where a double cannot hold it.
  [[nodiscard]] double extent() const;
};

/// Errors: bad-value (bits outside their limits).
[[nodiscard]] Status checkQuantiseOptions(const QuantiseOptions& options);
/// Errors: bad-input (an extent that a double cannot hold or divide).
[[nodiscard]] Status checkBox(const PointBox& box);

[[nodiscard]] Lattice latticeOf(const PointBox& box, int bits);
[[nodiscard]] std::vector<LatticePoint> onLattice(std::span<const Position> points,
                                                  const Lattice& lattice);

/// Whether a cell that had a volume of this sign is flatter at these corners, or inside out.
[[nodiscard]] inline bool isWorse(int before, const std::array<LatticePoint, 4>& corners) {
  if (before < 0) return false;
  const int now = orientation(corners[0], corners[1], corners[2], corners[3]);
  return now < 0 || (now == 0 && before > 0);
}

/// Notes what the bits of the lattice cost. REQUIRES: the report's worse cells.
void notePositions(int bits, QuantiseReport& report);
/// A lattice has one step on all axes, so it holds no mesh that is much thinner than long. Errors:
/// bad-input (more than kMostWorseCells of `cells`).
[[nodiscard]] Status checkWorse(std::uint64_t cells, const PointBox& box,
                                const QuantiseReport& report);

}  // namespace qtet
