// A decision predicted by several models at once: their opinions are added up as log odds with
// weights that learn (FORMAT.md, "Mixed decisions"). Integers only, so that every machine predicts
// alike.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "codec/coding/range_coder.h"

namespace qtet {
namespace mixing {

// Log odds are in 1/256 and lie in +-kMax.
inline constexpr int kMax = 2047;
// 65536 / (1 + exp(-x / 2)) for x = -16..16, rounded: probabilities at log odds of -8, -7.5 ... 8.
inline constexpr std::array<std::int32_t, 33> kLogistic{
    22,    36,    60,    98,    162,   267,   439,   720,   1179,  1921,  3108,
    4971,  7812,  11955, 17625, 24743, 32768, 40793, 47911, 53581, 57724, 60565,
    62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514};

/// The probability, in 1/65536, at log odds of x. REQUIRES |x| <= kMax.
[[nodiscard]] constexpr std::uint32_t squash(int x) {
  assert(-kMax <= x && x <= kMax);
  const auto at = static_cast<std::size_t>(x + 2048);
  const std::int32_t low = kLogistic[at >> 7];
  return static_cast<std::uint32_t>(
      low + ((kLogistic[(at >> 7) + 1] - low) * static_cast<std::int32_t>(at & 127) >> 7));
}

// Read when a program starts, so that compilers make the tables then: as data they would be a tenth
// of the WebAssembly module.
inline const volatile int atStart = 0;

/// The inverse of squash: by the top 12 bits of a probability the least log odds that reach it.
inline const auto kStretch = [] {
  std::array<std::int16_t, 4096> out{};
  int x = atStart - kMax;
  for (std::uint32_t p = 0; p < out.size(); ++p) {
    while (x < kMax && squash(x) < p * 16 + 8) ++x;
    out[p] = static_cast<std::int16_t>(x);
  }
  return out;
}();

/// By log odds + 2048: squash, clamped to what the range coder takes.
inline const auto kSquash = [] {
  std::array<std::uint16_t, 4096> out{};
  for (int x = atStart - kMax; x <= kMax; ++x)
    out[static_cast<std::size_t>(x + 2048)] =
        static_cast<std::uint16_t>(std::clamp(squash(x), range::kLowest, range::kHighest));
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

namespace mixing {

/// No model is there twice.
template <std::size_t N>
[[nodiscard]] constexpr bool areDifferent(const std::array<BitModel*, N>& models) {
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (models[i] == models[j]) return false;
  return true;
}

/// After a decision: the weights follow the opinions that were right, and the models the decision.
template <std::size_t N>
[[gnu::always_inline]] inline void learn(Mixer<N>& mixer, const std::array<BitModel*, N>& models,
                                         const std::array<std::int32_t, N>& opinion,
                                         std::int32_t error, int bit) {
  for (std::size_t i = 0; i < N; ++i) {
    mixer.weight[i] += (opinion[i] * error + (1 << (kRate - 1))) >> kRate;  // below 2^28
    range::update(*models[i], bit);
  }
}

#ifdef __SSE2__
/// The same of four at once, to the bit: a tenth of a decoder's time. REQUIRES four different
/// models.
[[gnu::always_inline]] inline void learnFour(Mixer<4>& mixer,
                                             const std::array<BitModel*, 4>& models,
                                             const std::array<std::int32_t, 4>& opinion,
                                             std::int32_t error, int bit) {
  assert(areDifferent(models));
  const auto four = [](auto a, auto b, auto c, auto d) {
    const auto one = [](auto x) { return _mm_cvtsi32_si128(static_cast<int>(x)); };
    return _mm_unpacklo_epi64(_mm_unpacklo_epi32(one(a), one(b)),
                              _mm_unpacklo_epi32(one(c), one(d)));
  };
  // opinion * error = opinion * (error mod 4) + 4 opinion * floor(error / 4), products of 16 bits.
  const __m128i low = four(opinion[0], opinion[1], opinion[2], opinion[3]);
  const __m128i factors =
      _mm_or_si128(_mm_and_si128(low, _mm_set1_epi32(0xFFFF)), _mm_slli_epi32(low, 18));
  const __m128i product =
      _mm_madd_epi16(factors, _mm_set1_epi32((error >> 2) * 65536 + (error & 3)));
  auto* const weights = reinterpret_cast<__m128i*>(mixer.weight.data());
  _mm_storeu_si128(
      weights, _mm_add_epi32(_mm_loadu_si128(weights),
                             _mm_srai_epi32(
                                 _mm_add_epi32(product, _mm_set1_epi32(1 << (kRate - 1))), kRate)));
  // Towards 1 what it lacks is added times the rate; towards 0 the same with all bits turned round,
  // before and after.
  const std::array<std::uint32_t, 4> s{models[0]->state, models[1]->state, models[2]->state,
                                       models[3]->state};
  const auto rate = [&](std::size_t i) {
    return std::bit_cast<std::uint32_t>(range::kRates[s[i] & 0xFFFF]);
  };
  const __m128i rates = four(rate(0), rate(1), rate(2), rate(3));
  const __m128i ones = _mm_set1_epi32(-1), turn = _mm_set1_epi32(bit - 1);
  const __m128i states = _mm_xor_si128(four(s[0], s[1], s[2], s[3]), turn);
  const __m128i step = _mm_mulhi_epu16(_mm_srli_epi32(_mm_xor_si128(states, ones), 16), rates);
  __m128i next = _mm_add_epi32(_mm_xor_si128(_mm_add_epi32(states, _mm_slli_epi32(step, 16)), turn),
                               _mm_srli_epi32(rates, 16));
  for (BitModel* const model : models)
    model->state = static_cast<std::uint32_t>(_mm_cvtsi128_si32(next)),
    next = _mm_shuffle_epi32(next, 0b111001);
}
#endif

}  // namespace mixing

/// One decision, of which each model has an opinion. All of them learn. REQUIRES N different
/// models.
template <class Coder, std::size_t N>
[[gnu::always_inline]] inline int mixedBit(Coder& coder, int value,
                                           const std::array<BitModel*, N>& models,
                                           Mixer<N>& mixer) {
  assert(mixing::areDifferent(models));
  std::array<std::int32_t, N> opinion;
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < N; ++i) {
    opinion[i] = mixing::kStretch[models[i]->state >> 20];
    sum += std::int64_t{mixer.weight[i]} * opinion[i];
  }
  const std::uint32_t p = mixing::kSquash[static_cast<std::size_t>(
      std::clamp<std::int64_t>(sum >> 16, -mixing::kMax, mixing::kMax) + 2048)];
  const int bit = coder.likely(value, p);
  const std::int32_t error = (bit << 16) - static_cast<std::int32_t>(p);
#ifdef __SSE2__
  if constexpr (N == 4)
    mixing::learnFour(mixer, models, opinion, error, bit);
  else
#endif
    mixing::learn(mixer, models, opinion, error, bit);
  return bit;
}

}  // namespace qtet
