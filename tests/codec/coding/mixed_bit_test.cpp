// Mixed decisions: tables that are each other's inverse, learning, and the same answers on both
// sides.
#include "codec/coding/mixed_bit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace qtet {
namespace {

TEST(MixedBit, theTableIsTheLogisticFunction) {
  for (int x = -mixing::kMax; x <= mixing::kMax; ++x)
    ASSERT_NEAR(mixing::squash(x), 65536 / (1 + std::exp(-x / 256.0)), 270) << x;
  for (int x = -mixing::kMax; x < mixing::kMax; ++x)
    ASSERT_LE(mixing::squash(x), mixing::squash(x + 1)) << x;
}

TEST(MixedBit, stretchIsTheInverseOfSquash) {
  for (std::size_t p = 0; p + 1 < mixing::kStretch.size(); ++p)
    ASSERT_LE(mixing::kStretch[p], mixing::kStretch[p + 1]);
  for (std::uint32_t p = 2; p < 4094; ++p) {
    ASSERT_GE(mixing::squash(mixing::kStretch[p]), 16 * p + 8) << p;
    ASSERT_LT(mixing::squash(mixing::kStretch[p] - 1), 16 * p + 8) << p;
  }
}

// One model of three knows, the others see noise.
TEST(MixedBit, itLearnsWhomToTrust) {
  std::mt19937 random(5);
  std::vector<std::array<std::size_t, 3>> contexts;
  std::vector<int> bits;
  for (int i = 0; i < 20000; ++i) {
    const std::size_t knows = random() % 2;
    contexts.push_back({knows, random() % 8, random() % 8});
    bits.push_back((knows != 0) != (random() % 50 == 0));
  }
  const auto run = [&](auto& coder, const auto& each) {
    std::array<std::array<BitModel, 8>, 3> models;
    Mixer<3> mixer;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      const std::array<BitModel*, 3> asked{&models[0][contexts[i][0]], &models[1][contexts[i][1]],
                                           &models[2][contexts[i][2]]};
      each(i, mixedBit(coder, bits[i], asked, mixer));
    }
  };
  RangeEncoder encoder;
  run(encoder, [](std::size_t, int) {});
  const Bytes bytes = encoder.finish();
  const double entropy =
      -(0.02 * std::log2(0.02) + 0.98 * std::log2(0.98)) * static_cast<double>(bits.size()) / 8;
  EXPECT_LT(static_cast<double>(bytes.size()), 1.1 * entropy);
  RangeDecoder decoder(bytes);
  std::size_t wrong = 0;
  run(decoder, [&](std::size_t i, int bit) { wrong += bit != bits[i]; });
  EXPECT_EQ(wrong, 0u);
  EXPECT_TRUE(decoder.atEnd());
}

#ifdef __SSE2__
TEST(MixedBit, fourModelsAtOnceLearnWhatOneByOneLearns) {
  std::mt19937 random(11);
  for (int round = 0; round < 100'000; ++round) {
    std::array<BitModel, 4> some, same;
    Mixer<4> mixer, twin;
    std::array<std::int32_t, 4> opinion{};
    for (std::size_t i = 0; i < 4; ++i) {
      some[i].state = same[i].state = static_cast<std::uint32_t>(random()) << 16 |
                                      static_cast<std::uint32_t>(random()) % (range::kSlowest + 1);
      mixer.weight[i] = twin.weight[i] =
          static_cast<std::int32_t>(random() % (1u << 28)) - (1 << 27);
      opinion[i] = static_cast<std::int32_t>(random() % (2 * mixing::kMax + 1)) - mixing::kMax;
    }
    const int bit = static_cast<int>(random() % 2);
    const auto p = static_cast<std::int32_t>(range::kLowest +
                                             random() % (range::kHighest - range::kLowest + 1));
    mixing::learn(mixer, {&some[0], &some[1], &some[2], &some[3]}, opinion, (bit << 16) - p, bit);
    mixing::learnFour(twin, {&same[0], &same[1], &same[2], &same[3]}, opinion, (bit << 16) - p,
                      bit);
    ASSERT_EQ(mixer.weight, twin.weight);
    for (std::size_t i = 0; i < 4; ++i) ASSERT_EQ(some[i].state, same[i].state);
  }
}
#endif

}  // namespace
}  // namespace qtet
