// A decision predicted by several models at once: their opinions are added up as log odds with weights that learn (FORMAT.md, "Mixed decisions").
// Integers only, so that every machine predicts alike.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "codec/range_coder.h"

namespace qtet {
namespace mixing {

// Log odds are in 1/256 and lie in +-kMost.
inline constexpr int kMost = 2047;
// 65536 / (1 + exp(-x / 2)) for x = -16..16, rounded: probabilities at log odds of -8, -7.5 ... 8.
inline constexpr std::array<std::int32_t, 33> kLogistic{22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4971, 7812, 11955, 17625, 24743, 32768, 40793, 47911, 53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514};

/// The probability, in 1/65536, at log odds of x. REQUIRES |x| <= kMost.
[[nodiscard]] constexpr std::uint32_t squash(int x) {
  const auto at = static_cast<std::size_t>(x + 2048);
  const std::int32_t low = kLogistic[at >> 7];
  return static_cast<std::uint32_t>(low + ((kLogistic[(at >> 7) + 1] - low) * static_cast<std::int32_t>(at & 127) >> 7));
}

/// Its inverse: by the top 12 bits of a probability the least log odds that reach it.
inline constexpr auto kStretch = [] {
  std::array<std::int16_t, 4096> out{};
  int x = -kMost;
  for (std::uint32_t p = 0; p < out.size(); ++p) {
    while (x < kMost && squash(x) < p * 16 + 8) ++x;
    out[p] = static_cast<std::int16_t>(x);
  }
  return out;
}();

inline constexpr int kRate = 17;  // of the weights, as a shift; 15 to 19 measured

}  // namespace mixing

/// The weights of N opinions, in 1/65536.
template <std::size_t N>
struct Mixer {
  std::array<std::int32_t, N> weight = [] {
    std::array<std::int32_t, N> w{};
    w.fill(static_cast<std::int32_t>(80000 / N));
    return w;
  }();
};

/// One decision, of which each model has an opinion. All of them learn.
template <class Coder, std::size_t N>
[[gnu::always_inline]] inline int mixedBit(Coder& coder, int value, const std::array<BitModel*, N>& models, Mixer<N>& mixer) {
  std::array<std::int32_t, N> opinion;
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < N; ++i) {
    opinion[i] = mixing::kStretch[models[i]->probability >> 4];
    sum += std::int64_t{mixer.weight[i]} * opinion[i];
  }
  const auto odds = static_cast<int>(std::clamp<std::int64_t>(sum >> 16, -mixing::kMost, mixing::kMost));
  const std::uint32_t p = std::clamp(mixing::squash(odds), range::kLowest, range::kHighest);
  const int bit = coder.likely(value, p);
  const std::int32_t error = (bit << 16) - static_cast<std::int32_t>(p);
  for (std::size_t i = 0; i < N; ++i) {
    mixer.weight[i] += static_cast<std::int32_t>((std::int64_t{opinion[i]} * error + (1 << (mixing::kRate - 1))) >> mixing::kRate);
    range::update(*models[i], bit);
  }
  return bit;
}

}  // namespace qtet
