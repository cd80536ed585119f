#include "codec/coding/float_bits.h"

#include <gtest/gtest.h>

#include <limits>

namespace qtet {
namespace {

TEST(FloatBits, everyKindOfFloatComesBackBitForBit) {
  for (const std::uint32_t bits :
       {0u, 0x80000000u, 1u, 0x807FFFFFu, 0x3F800000u, 0x7F7FFFFFu, 0x7F800000u, 0xFF800000u,
        0x7FC00000u, 0xFFC00001u, 0x7F800001u, 0xFFA00001u, 0x7FBFFFFFu, 0x7FFFFFFFu})
    EXPECT_EQ(std::bit_cast<std::uint32_t>(narrowed(widened(std::bit_cast<float>(bits)))), bits)
        << std::hex << bits;
  for (std::uint32_t bits = 0x7F800001u; bits < 0x7FFFFFF0u; bits += 4099)
    ASSERT_TRUE(std::isnan(widened(std::bit_cast<float>(bits))) &&
                std::bit_cast<std::uint32_t>(narrowed(widened(std::bit_cast<float>(bits)))) == bits)
        << std::hex << bits;
}

TEST(FloatBits, aNanThatNoFloatHoldsStaysANan) {
  const double low = std::bit_cast<double>(0x7FF0000000000001u);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(narrowed(low)), 0x7FC00000u);
  EXPECT_EQ(narrowed(1e300), std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace qtet
