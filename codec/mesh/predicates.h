// Exact orientation of lattice points: every decision of encoder, decoder and browser agrees to the
// bit.
#pragma once

#include <cassert>
#include <cstdint>

#include "codec/mesh/mesh.h"
#include "proto/limits.h"

namespace qtet {

__extension__ typedef __int128 Int128;

namespace detail {

struct Difference {
  std::int64_t x, y, z;
};

[[nodiscard]] inline Difference difference(const LatticePoint& from, const LatticePoint& to) {
  return {std::int64_t{to[0]} - from[0], std::int64_t{to[1]} - from[1],
          std::int64_t{to[2]} - from[2]};
}

/// Every coordinate is in [0, 2^kMaxPositionBits).
[[nodiscard]] inline bool isOnLattice(const LatticePoint& p) {
  return (static_cast<std::uint32_t>(p[0] | p[1] | p[2]) >> kMaxPositionBits) == 0;
}

/// u x v . w; the cross product's components fit 64 bits for differences below 2^28, the last
/// products need `Wide`.
template <class Wide>
[[nodiscard]] inline Wide determinant(const Difference& u, const Difference& v,
                                      const Difference& w) {
  return Wide{u.y * v.z - u.z * v.y} * w.x + Wide{u.z * v.x - u.x * v.z} * w.y +
         Wide{u.x * v.y - u.y * v.x} * w.z;
}

/// Whether every |component| is below 2^20. v ^ (v >> 63) is v or -v - 1: never more than |v|, and
/// never less than |v| - 1.
[[nodiscard]] inline bool isShort(const Difference& u, const Difference& v, const Difference& w) {
  const auto fold = [](std::int64_t value) { return value ^ (value >> 63); };
  return ((fold(u.x) | fold(u.y) | fold(u.z) | fold(v.x) | fold(v.y) | fold(v.z) | fold(w.x) |
           fold(w.y) | fold(w.z)) >>
          20) == 0;
}

}  // namespace detail

// |determinant| <= 6 * 2^(3 k) for differences of magnitude up to 2^k: below 2^63 for k = 20, below
// 2^87 for k = kMaxPositionBits.
inline constexpr int kShortBits = 20;
static_assert(kMaxPositionBits <= 30, "the cross product's components must fit 64 bits");

/// Six times the signed volume of (a, b, c, d), (b-a) x (c-a) . (d-a), in lattice units, exactly.
/// REQUIRES: coordinates in [0, 2^kMaxPositionBits).
[[nodiscard]] inline Int128 volume6(const LatticePoint& a, const LatticePoint& b,
                                    const LatticePoint& c, const LatticePoint& d) {
  assert(detail::isOnLattice(a) && detail::isOnLattice(b));
  assert(detail::isOnLattice(c) && detail::isOnLattice(d));
  const detail::Difference u = detail::difference(a, b), v = detail::difference(a, c),
                           w = detail::difference(a, d);
  if (detail::isShort(u, v, w)) return detail::determinant<std::int64_t>(u, v, w);
  return detail::determinant<Int128>(u, v, w);
}

/// The sign of volume6: +1 for a cell as VTK orients it, 0 for a flat one, -1 for an inverted one.
/// REQUIRES: as volume6.
[[nodiscard]] inline int orientation(const LatticePoint& a, const LatticePoint& b,
                                     const LatticePoint& c, const LatticePoint& d) {
  assert(detail::isOnLattice(a) && detail::isOnLattice(b));
  assert(detail::isOnLattice(c) && detail::isOnLattice(d));
  const detail::Difference u = detail::difference(a, b), v = detail::difference(a, c),
                           w = detail::difference(a, d);
  if (detail::isShort(u, v, w)) {
    const std::int64_t volume = detail::determinant<std::int64_t>(u, v, w);
    return (volume > 0) - (volume < 0);
  }
  const Int128 volume = detail::determinant<Int128>(u, v, w);
  return (volume > 0) - (volume < 0);
}

}  // namespace qtet
