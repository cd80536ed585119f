// How far doubles can be trusted with lattice coordinates.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>

#include "proto/limits.h"
#include "simplify/mesh/vector3.h"

namespace qtet {

/// In a star whose coordinates stay below 2^16 every volume is an integer under 2^53, exact in
/// doubles. Where they reach r, it is off by less than 2^5 r^3 2^-52.
inline constexpr int kExactBits = 16;
inline constexpr double kRounding = 0x1p-47;

/// Lattice steps that rounding may take from a distance: coordinates below 2^30 in doubles.
inline constexpr double kDistanceRounding = 0x1p-18;

/// A bound on the rounding errors of volumes with an apex at d over triangles of this reach, on a
/// lattice of so many bits. Both relative to the same origin.
[[nodiscard]] inline double roundingAt(const Vector3& d, double reach, int latticeBits) {
  assert(reach >= 0);
  if (latticeBits <= kExactBits) return 0;
  const double farthest = std::max({reach, std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  return farthest < 1 << kExactBits ? 0 : kRounding * farthest * farthest * farthest;
}

[[nodiscard]] inline bool isOnLattice(const LatticePoint& p, int bits) {
  assert(bits > 0 && bits <= kMaxPositionBits);
  const auto end = std::int64_t{1} << bits;
  return std::ranges::all_of(p, [&](std::int32_t x) { return x >= 0 && x < end; });
}

}  // namespace qtet
