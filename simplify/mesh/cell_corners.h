// Finds which corners of a cell are a vertex. It is asked of every cell of every star, so it
// compares all four at once where the processor can.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "codec/mesh/mesh.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace qtet {

/// Bit j: corner j of `cell` is v.
[[nodiscard]] inline unsigned cornersThatAre(const std::array<VertexId, 4>& cell, VertexId v) {
#if defined(__SSE2__)
  const __m128i corners = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cell.data()));
  return static_cast<unsigned>(_mm_movemask_ps(
      _mm_castsi128_ps(_mm_cmpeq_epi32(corners, _mm_set1_epi32(static_cast<int>(v))))));
#else
  return unsigned{cell[0] == v} | unsigned{cell[1] == v} << 1 | unsigned{cell[2] == v} << 2 |
         unsigned{cell[3] == v} << 3;
#endif
}

/// The corner of a single bit. REQUIRES: 1, 2, 4 or 8.
[[nodiscard]] constexpr std::size_t onlyCorner(unsigned bit) {
  assert(std::has_single_bit(bit) && bit <= 8);
  return (bit >> 1) - (bit >> 3);
}

/// Corners that are not among those given by bit, two at most.
struct OtherCorners {
  std::uint8_t count = 0;
  std::array<std::uint8_t, 2> corner{};
};

inline constexpr std::array<OtherCorners, 16> kOtherCorners = [] {
  std::array<OtherCorners, 16> out{};
  for (unsigned corners = 0; corners < 16; ++corners)
    for (std::uint8_t j = 0; j < 4; ++j)
      if ((corners >> j & 1) == 0 && out[corners].count < 2)
        out[corners].corner[out[corners].count++] = j;
  return out;
}();

}  // namespace qtet
