#include "proto/rounding_error.h"

#include <gtest/gtest.h>

#include "proto/manifest.h"

namespace qtet {
namespace {

TEST(RoundingError, isHalfAStepAndTheRoundingOfTheType) {
  ManifestField field{"T", 1, "float64", "point", 4, 2, {-7}, {-7, 23}};
  EXPECT_DOUBLE_EQ(largestMagnitude(field), 23);  // -7 + 2 * 15
  EXPECT_DOUBLE_EQ(largestRoundingError(field), 1 + std::ldexp(23.0, -49));
  field.type = "float32";
  EXPECT_DOUBLE_EQ(largestRoundingError(field), 1 + std::ldexp(23.0, -24) + std::ldexp(23.0, -49));
  field.type = "int64";  // of more bits than a log stores
  EXPECT_DOUBLE_EQ(largestRoundingError(field), 1.5 + std::ldexp(23.0, -49));
  field = {"v", 2, "float64", "point", 1, 2, {-100, 5}, {0, 100}};
  EXPECT_DOUBLE_EQ(largestMagnitude(field), 100) << "of any component";
}

TEST(RoundingError, thereIsNoneOfIntegersAndConstants) {
  EXPECT_EQ(largestRoundingError(ManifestField{"i", 3, "uint8", "cell", 8, 1, {0, 0, 0}, {}}), 0);
  ManifestField field{"c", 1, "float32", "point", 12, 1, {0.1}, {0.1, 0.1}};
  EXPECT_EQ(largestRoundingError(field), 0);
  field.minimum[0] = 0;  // an instant that is constant in a series that is not
  EXPECT_GT(largestRoundingError(field), 0.5);
}

}  // namespace
}  // namespace qtet
