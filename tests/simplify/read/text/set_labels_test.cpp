// Named sets of cells as one label.
#include "simplify/read/text/set_labels.h"

#include <gtest/gtest.h>

#include <numeric>

#include "proto/limits.h"

namespace qtet {
namespace {

using Members = std::vector<std::vector<std::uint32_t>>;

CellSets setsOf(std::vector<std::string> names, const Members& members) {
  return {std::move(names),
          [&members](std::size_t set, std::vector<std::uint32_t>& cells) { cells = members[set]; }};
}

TEST(SetLabels, theLargestSetsThatDoNotOverlapStay) {
  const Members members{{0, 1, 2, 3, 4}, {0}, {0, 1}, {2, 3}, {2, 3}, {}};
  std::vector<std::string> notes;
  const auto field =
      labelOfSets("L", 5, setsOf({"all", "one", "a", "b", "c", "empty"}, members), notes);
  ASSERT_TRUE(field);
  EXPECT_EQ(field->values, (std::vector<double>{1, 1, 2, 2, 0}));
  EXPECT_EQ(field->labelNames, (LabelNames{{1, "a"}, {2, "c"}}));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("b, one"), std::string::npos) << notes[0];
}

TEST(SetLabels, setsOfAllCellsSayNothing) {
  const Members members{{0, 1}, {1, 0}};
  std::vector<std::string> notes;
  EXPECT_FALSE(labelOfSets("L", 2, setsOf({"a", "b"}, members), notes));
  EXPECT_TRUE(notes.empty());
}

TEST(SetLabels, thereAreAtMostAsManyNamesAsALogHolds) {
  for (const std::uint32_t count : {kMaxLabelNames - 1, kMaxLabelNames, kMaxLabelNames + 1}) {
    Members members(count);
    for (std::uint32_t i = 0; i < count; ++i) members[i] = {i};
    std::vector<std::string> notes;
    const auto field =
        labelOfSets("L", count, setsOf(std::vector<std::string>(count, "name"), members), notes);
    ASSERT_TRUE(field);
    EXPECT_EQ(field->labelNames.size(), std::min(count, kMaxLabelNames));
    ASSERT_EQ(notes.size(), count > kMaxLabelNames ? 1u : 0u);
    if (!notes.empty()) EXPECT_NE(notes[0].find("names for only 4096"), std::string::npos);
  }
}

}  // namespace
}  // namespace qtet
