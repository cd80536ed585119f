#include "codec/coding/number_type.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "codec/coding/nearest_integer.h"

namespace qtet {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class T>
std::vector<T> written(const char* type, const std::vector<double>& values) {
  Bytes bytes;
  numberType(type).append(bytes, values);
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

/// The field's step is a half, so every second value lies midway between two integers.
TEST(NumberType, integersAreTheNearestAndHalvesGoUp) {
  EXPECT_EQ(written<std::int8_t>("int8", {-2.5, -2, -1.5, -1, -0.5, 0, 0.5, 1, 1.5, 2, 2.5}),
            (std::vector<std::int8_t>{-2, -2, -1, -1, 0, 0, 1, 1, 2, 2, 3}));
  EXPECT_EQ(written<std::int64_t>("int64", {-1000000.5, -1000000.75, 1000000.25}),
            (std::vector<std::int64_t>{-1000000, -1000001, 1000000}));
}

TEST(NumberType, valuesBesideAHalfAreNotOnIt) {
  EXPECT_EQ(nearestInteger(std::nextafter(0.5, 0)), 0);
  EXPECT_EQ(nearestInteger(std::nextafter(-0.5, -1)), -1);
  EXPECT_EQ(nearestInteger(4503599627370497.0), 4503599627370497.0);  // 2^52 + 1
  EXPECT_EQ(nearestInteger(-4503599627370495.5), -4503599627370495.0);
}

TEST(NumberType, whatATypeCannotHoldIsItsNearestNumber) {
  EXPECT_EQ(written<std::uint8_t>("uint8", {-0.5, -0.75, -7, 254.5, 255.5, 1e300, kInfinity, kNan}),
            (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 255, 0}));
  EXPECT_EQ(written<std::int64_t>("int64", {1e19, -1e19, -kInfinity}),
            (std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::max(),
                                       std::numeric_limits<std::int64_t>::min(),
                                       std::numeric_limits<std::int64_t>::min()}));
}

}  // namespace
}  // namespace qtet
