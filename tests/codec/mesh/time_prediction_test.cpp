#include "codec/mesh/time_prediction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace qtet {
namespace {

constexpr std::int32_t kEnd = 1 << 30;
constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();

TEST(TimePrediction, valuesEndAtTwoToTheThirtiethOnBothSides) {
  const TimePrediction same{{{{0, TimePrediction::kOne}}}, 1};
  for (const std::int32_t beyond : {-1, 0, 1}) {
    const auto at = [](std::int32_t value) { return [=](std::uint16_t) { return value; }; };
    const std::int32_t end = kEnd + std::min(beyond, 0);
    EXPECT_EQ(restoreInTime(same, beyond, at(kEnd), kNone), end) << beyond;
    EXPECT_EQ(restoreInTime(same, -beyond, at(-kEnd), kNone), -end) << beyond;
  }
}

TEST(TimePrediction, theLargestSumOfParentsEndsThereToo) {
  for (const std::int8_t weight : {std::int8_t{127}, std::int8_t{-127}}) {
    const TimePrediction::Parent parent{0, weight};
    const TimePrediction four{{parent, parent, parent, parent}, 4};
    const auto largest = [](std::uint16_t) { return kEnd; };
    EXPECT_EQ(restoreInTime(four, 0, largest, kNone), weight > 0 ? kEnd : -kEnd);
  }
}

}  // namespace
}  // namespace qtet
