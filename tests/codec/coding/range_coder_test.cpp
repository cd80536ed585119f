#include "codec/coding/range_coder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace qtet {
namespace {

TEST(RangeCoder, givesBackWhatItWasTold) {
  std::mt19937 random(7);
  std::vector<int> bits;
  std::vector<std::uint32_t> numbers;
  for (int i = 0; i < 20000; ++i)
    bits.push_back(random() % 10 == 0),
        numbers.push_back(static_cast<std::uint32_t>(random()) >> (random() % 32));
  RangeEncoder encoder;
  {
    std::array<BitModel, 2> models;
    NumberModel number;
    for (std::size_t i = 0; i < bits.size(); ++i)
      encoder.bit(bits[i], models[i % 2]), number.code(encoder, numbers[i]),
          encoder.raw(numbers[i], 32);
  }
  const Bytes bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  std::array<BitModel, 2> models;
  NumberModel number;
  for (std::size_t i = 0; i < bits.size(); ++i) {
    ASSERT_EQ(decoder.bit(0, models[i % 2]), bits[i]) << i;
    ASSERT_EQ(number.code(decoder, 0), numbers[i]) << i;
    ASSERT_EQ(decoder.raw(0, 32), numbers[i]) << i;
  }
  EXPECT_TRUE(decoder.atEnd());
  EXPECT_FALSE(decoder.overrun());
}

TEST(RangeCoder, skewedDecisionsCostNearTheirEntropy) {
  std::mt19937 random(3);
  RangeEncoder encoder;
  BitModel model;
  const int n = 200000;
  for (int i = 0; i < n; ++i) encoder.bit(random() % 100 < 3, model);
  const double entropy = -(0.03 * std::log2(0.03) + 0.97 * std::log2(0.97)) * n / 8;
  EXPECT_LT(static_cast<double>(encoder.finish().size()), 1.03 * entropy);
}

TEST(RangeCoder, theCheapestDecisionCostsWhatTheLimitsRelyOn) {
  RangeEncoder encoder;
  BitModel model;
  const std::size_t n = 10'000'000;
  for (std::size_t i = 0; i < n; ++i) encoder.bit(1, model);
  EXPECT_GT(encoder.finish().size() * (8 * 1500), n);
}

TEST(RangeCoder, tellsWhenMoreIsAskedThanWasWritten) {
  RangeEncoder encoder;
  for (int i = 0; i < 100; ++i) encoder.raw(static_cast<std::uint32_t>(i), 8);
  const Bytes bytes = encoder.finish();
  RangeDecoder decoder(ByteView(bytes).first(bytes.size() - 5));
  for (int i = 0; i < 100; ++i) (void)decoder.raw(0, 8);
  EXPECT_TRUE(decoder.overrun());
}

}  // namespace
}  // namespace qtet
