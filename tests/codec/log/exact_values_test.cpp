// Exact values: every bit pattern comes back, and a damaged block is refused or gives other
// numbers, never a crash.
#include "codec/log/exact_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "codec/mesh/mesh.h"

namespace qtet {
namespace {

double floatOf(std::uint32_t bits) {
  // Payloads of NaN go into the double's own leading digits, as a reader of float32 hands them on.
  if ((bits & 0x7F800000u) == 0x7F800000u && (bits & 0x7FFFFFu) != 0)
    return std::bit_cast<double>(std::uint64_t{bits >> 31} << 63 | std::uint64_t{0x7FF} << 52 |
                                 std::uint64_t{bits & 0x7FFFFFu} << 29);
  return static_cast<double>(std::bit_cast<float>(bits));
}

std::vector<std::uint64_t> bitsOf(const std::vector<double>& values) {
  std::vector<std::uint64_t> out;
  for (const double v : values) out.push_back(std::bit_cast<std::uint64_t>(v));
  return out;
}

void expectBack(const Approximation& known, const std::vector<double>& exact) {
  const Bytes bytes = encodeExact(known, exact);
  const auto back = decodeExact(known, bytes);
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(bitsOf(*back), bitsOf(exact));
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(decodeExact(known, longer).error().code, ErrorCode::kBadValue);
  for (const std::size_t length : {std::size_t{0}, bytes.size() / 2, bytes.size() - 1})
    EXPECT_EQ(decodeExact(known, ByteView(bytes).first(length)).error().code, ErrorCode::kBadValue)
        << length;
}

TEST(ExactValues, anyBitsAtAllComeBack) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 40; ++round) {
    std::vector<std::int32_t> integers;
    std::vector<double> singles, doubles;
    const std::uint32_t components = 1 + static_cast<std::uint32_t>(round % 5);
    for (std::size_t i = 0; i < 60 * components; ++i) {
      integers.push_back(random() % 9 == 0 ? kMissing : static_cast<std::int32_t>(random() % 4096));
      singles.push_back(floatOf(static_cast<std::uint32_t>(random())));
      doubles.push_back(std::bit_cast<double>(random()));
    }
    const std::vector<double> minimum(components, -3.25);
    expectBack({integers, components, minimum, 0.001, "float32"}, singles);
    expectBack({integers, components, minimum, 0.001, "float64"}, doubles);
  }
}

TEST(ExactValues, theOddOnesComeBack) {
  using Double = std::numeric_limits<double>;
  using Float = std::numeric_limits<float>;
  const std::vector<double> doubles{0.0,
                                    -0.0,
                                    Double::infinity(),
                                    -Double::infinity(),
                                    Double::quiet_NaN(),
                                    -Double::quiet_NaN(),
                                    Double::denorm_min(),
                                    -Double::denorm_min(),
                                    Double::max(),
                                    Double::lowest(),
                                    Double::min(),
                                    std::bit_cast<double>(0x7FF8000000001234u),
                                    std::bit_cast<double>(0x7FF0000000000001u),
                                    std::bit_cast<double>(0xFFFFFFFFFFFFFFFFu)};
  const std::vector<double> singles{0.0,
                                    -0.0,
                                    Double::infinity(),
                                    -Double::infinity(),
                                    floatOf(0x7FC00000u),
                                    floatOf(0xFFC00001u),
                                    floatOf(0x7F800001u),
                                    static_cast<double>(Float::denorm_min()),
                                    -static_cast<double>(Float::denorm_min()),
                                    static_cast<double>(Float::max()),
                                    static_cast<double>(Float::lowest()),
                                    floatOf(0xFFFFFFFFu)};
  for (const double step : {1e-300, 1e-3, 1e300}) {
    expectBack({std::vector<std::int32_t>(doubles.size(), 7), 1, {0}, step, "float64"}, doubles);
    expectBack({std::vector<std::int32_t>(singles.size(), kMissing), 1, {0}, step, "float32"},
               singles);
  }
  expectBack({std::vector<std::int32_t>(4, 3), 1, {-5e15}, 1e8, "int64"},
             {-9007199254740991.0, 9007199254740991.0, 0, -1});
  // The values agree in their high digits, so only the low ones are coded.
  expectBack({std::vector<std::int32_t>(5, 0), 1, {0}, 1, "float64"}, {-0.5, 0.25, -0.75, 1, -1});
}

TEST(ExactValues, takeWhatTheLatticeLeavesOpen) {
  std::mt19937_64 random(2);
  const double step = std::ldexp(1.0, -16);
  std::vector<std::int32_t> integers, planes;
  std::vector<double> exact, level;
  for (int i = 0; i < 20000; ++i) {
    // in [1, 2): eight digits of a float32 lie below the step of 2^-15
    integers.push_back(static_cast<std::int32_t>(65536 + random() % 65536));
    exact.push_back(static_cast<double>(static_cast<float>(
        step * integers.back() + step * (static_cast<double>(random() % 1000) / 1000 - 0.5))));
    planes.push_back(static_cast<std::int32_t>(random() % 5));
    level.push_back(planes.back() * 0.3);
  }
  const double bits =
      8.0 * static_cast<double>(encodeExact({integers, 1, {0}, step, "float32"}, exact).size()) /
      20000;
  EXPECT_LT(bits, 8.0);  // 2^7 places of a float32 within the step, and a little
  EXPECT_GT(bits, 6.5);
  EXPECT_LT(encodeExact({planes, 1, {0}, 0.3, "float64"}, level).size(), 120u);
  expectBack({integers, 1, {0}, step, "float32"}, exact);
}

TEST(ExactValues, damageIsRefusedOrGivesNumbersOfTheType) {
  std::mt19937_64 random(3);
  std::vector<std::int32_t> integers(200);
  for (std::int32_t& x : integers) x = static_cast<std::int32_t>(random() % 64);
  std::vector<double> exact;
  for (const std::int32_t x : integers)
    exact.push_back(static_cast<double>(static_cast<float>(x) * 1.01f));
  const Approximation known{integers, 1, {0}, 1, "float32"};
  const Bytes bytes = encodeExact(known, exact);
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Bytes damaged = bytes;
      damaged[at] ^= static_cast<std::uint8_t>(1 << bit);
      const auto back = decodeExact(known, damaged);
      if (!back) {
        EXPECT_EQ(back.error().code, ErrorCode::kBadValue);
        continue;
      }
      ASSERT_EQ(back->size(), exact.size());
      for (const double x : *back)
        ASSERT_TRUE(std::isnan(x) || x == static_cast<double>(static_cast<float>(x)));
    }
}

}  // namespace
}  // namespace qtet
