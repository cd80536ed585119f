// Where a fused vertex lies with respect to its prey: what the lattice lets a decoder say of one prey vertex from the others.
#pragma once

#include <cstdint>

#include "codec/mesh.h"

namespace qtet {

enum class Placement : std::uint8_t {
  kAtPrey = 0,   ///< at prey vertex 0
  kMiddle = 1,   ///< k = 2: (prey 0 + prey 1) / 2, rounded down
  kQuarter = 2,  ///< k = 2: (3 prey 0 + prey 1) / 4, rounded to the nearest, halves up
  kFree = 3,
};

/// Prey tuples in the positions block.
[[nodiscard]] constexpr int positionTuples(int k, Placement placement) {
  return placement == Placement::kFree ? k : placement == Placement::kAtPrey ? k - 1 : 1;
}

/// Where no prey vertex is distinguished, the first label of the record is prey 0's, the next new one prey 1's, and so on.
[[nodiscard]] constexpr bool labelsInOrder(Placement placement) { return placement == Placement::kMiddle || placement == Placement::kFree; }

[[nodiscard]] inline LatticePoint middle(const LatticePoint& a, const LatticePoint& b) {
  return {(a[0] + b[0]) >> 1, (a[1] + b[1]) >> 1, (a[2] + b[2]) >> 1};
}
[[nodiscard]] inline LatticePoint quarter(const LatticePoint& near, const LatticePoint& far) {
  return {(3 * near[0] + far[0] + 2) >> 2, (3 * near[1] + far[1] + 2) >> 2, (3 * near[2] + far[2] + 2) >> 2};
}

}  // namespace qtet
