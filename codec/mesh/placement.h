// Where a fused vertex lies with respect to its prey: what the lattice lets a decoder say of one
// prey vertex from the others.
#pragma once

#include <cassert>
#include <cstdint>
#include <span>

#include "codec/mesh/mesh.h"

namespace qtet {

enum class Placement : std::uint8_t {
  kAtPrey = 0,   ///< at one prey vertex, the near one
  kMiddle = 1,   ///< the mean of the prey vertices, rounded down
  kQuarter = 2,  ///< k = 2: (3 near + far) / 4, rounded to the nearest, halves up
  kFree = 3,
};

/// REQUIRES: 2 to 4 points, no coordinate negative.
[[nodiscard]] inline LatticePoint middle(std::span<const LatticePoint> prey) {
  assert(prey.size() >= 2 && prey.size() <= 4);
  LatticePoint sum{};
  for (const LatticePoint& p : prey) {
    assert(p[0] >= 0 && p[1] >= 0 && p[2] >= 0);
    for (std::size_t a = 0; a < 3; ++a) sum[a] += p[a];
  }
  for (std::int32_t& x : sum) x /= static_cast<std::int32_t>(prey.size());
  return sum;
}
[[nodiscard]] inline LatticePoint quarter(const LatticePoint& near, const LatticePoint& far) {
  return {(3 * near[0] + far[0] + 2) >> 2, (3 * near[1] + far[1] + 2) >> 2,
          (3 * near[2] + far[2] + 2) >> 2};
}

}  // namespace qtet
