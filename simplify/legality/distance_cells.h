// Signed distances from a surface at the middles of cubes, each searched for once: what the
// envelope asks for at many places near one another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simplify/mesh/vector3.h"

namespace qtet {

/// How far a place is from a surface.
struct SignedDistance {
  float outside = 0;          ///< in lattice steps, below 0 inside; never less than it is
  std::uint32_t nearest = 0;  ///< triangle
};

/// A cube of the lattice: those of one size fill space, with a corner in the origin.
struct LatticeCube {
  std::uint8_t bits = 0;  ///< 2^bits steps long
  std::array<std::uint32_t, 3> number{};

  /// The cube of this size that holds p. REQUIRES: p in [0, 2^30)^3.
  [[nodiscard]] static LatticeCube at(const Vector3& p, int bits);
  [[nodiscard]] double length() const { return static_cast<double>(std::uint32_t{1} << bits); }
  [[nodiscard]] Vector3 middle() const;
  friend bool operator==(const LatticeCube&, const LatticeCube&) = default;
};

/// One thread's own. When it is full it forgets all, so that memory has a bound.
class DistanceCells {
 public:
  /// The signed distance of the cube's middle: `measure()`, unless it is known.
  template <class Measure>
  [[nodiscard]] SignedDistance at(const LatticeCube& cube, const Measure& measure) {
    Slot& slot = slotOf(cube);
    if (!slot.isTaken) slot = {cube, true, measure()};
    return slot.distance;
  }

 private:
  struct Slot {
    LatticeCube cube;
    bool isTaken = false;
    SignedDistance distance;
  };
  [[nodiscard]] Slot& slotOf(const LatticeCube& cube);
  [[nodiscard]] Slot& find(const LatticeCube& cube);
  void grow();

  std::vector<Slot> slots_;  // a power of two
  std::size_t taken_ = 0;
};

}  // namespace qtet
