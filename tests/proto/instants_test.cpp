#include "proto/instants.h"

#include <gtest/gtest.h>

#include "proto/series.h"

namespace qtet {
namespace {

TEST(Instants, timesThatDifferByLostDigitsAreTheSame) {
  EXPECT_TRUE(isSameTime(1, 1 + 0.99 * kNearTime));
  EXPECT_TRUE(isSameTime(0, 0));
  EXPECT_FALSE(isSameTime(1, 1 + 1.01 * kNearTime));
  EXPECT_FALSE(isSameTime(0, 1e-300));
  EXPECT_FALSE(isSameTime(-1, 1));
}

TEST(Instants, theExactTimeIsMeantElseTheNearest) {
  const std::vector<double> times = {0, 1700000000, 1700000001};
  EXPECT_EQ(placeOfTime(times, 0), 0u);
  EXPECT_EQ(placeOfTime(times, 1700000001), 2u);
  EXPECT_EQ(placeOfTime(times, 1700000000.4), 1u);
  EXPECT_EQ(placeOfTime(times, 1700000000.6), 2u);
  EXPECT_FALSE(placeOfTime(times, 1));
  EXPECT_FALSE(placeOfTime({}, 0));
}

TEST(Instants, aFileHasTheInstantsOfItsTimeAndTheFieldsWithoutTime) {
  std::vector<ManifestField> fields(5);
  fields[0].name = "T@1", fields[1].name = "p", fields[2].name = "T@0";
  fields[3].name = "u@0", fields[4].name = "u@1";
  const std::vector<std::uint32_t> wanted = {0, 1, 2, 4};
  const Instants instants(fields, wanted, seriesOf(fields));
  EXPECT_EQ(instants.times(), (std::vector<double>{0, 1}));
  const InstantFile file = instants.fileAt(1);
  ASSERT_EQ(file.fields.size(), 3u);
  EXPECT_EQ(file.fields[0].name, "T");
  EXPECT_TRUE(file.fields[0].isInstant);
  EXPECT_EQ(file.fields[1].name, "p");
  EXPECT_EQ(file.fields[2].name, "u");
}

TEST(Instants, aNameThatIsTakenLeavesTheInstantItsOwn) {
  std::vector<ManifestField> fields(3);
  fields[0].name = "T@1", fields[1].name = "T@2", fields[2].name = "T";
  const std::vector<std::uint32_t> wanted = {0, 1, 2};
  const InstantFile file = Instants(fields, wanted, seriesOf(fields)).fileAt(2);
  ASSERT_EQ(file.fields.size(), 2u);
  EXPECT_EQ(file.fields[0].name, "T@2");
  EXPECT_EQ(file.fields[1].name, "T");
}

}  // namespace
}  // namespace qtet
