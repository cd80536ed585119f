#include "simplify/read/options/time_text.h"

#include <gtest/gtest.h>

#include <vector>

namespace qtet {
namespace {

TEST(TimeText, aTimeIsAPlainNumber) {
  EXPECT_EQ(timeIn("0.5"), 0.5);
  EXPECT_EQ(timeIn(" \t0.5\r\n"), 0.5);
  EXPECT_EQ(timeIn("+0.5"), 0.5);
  EXPECT_EQ(timeIn("-1"), -1);
  EXPECT_EQ(timeIn("1.5D-3"), 1.5e-3);
  EXPECT_EQ(timeIn("2d+2"), 200);
  EXPECT_EQ(timeIn("1E2"), 100);
}

TEST(TimeText, anythingElseIsNone) {
  for (const char* text : {"", " ", "0.1s", "0,1", "nan", "inf", "-infinity", "1e999", "+-1", "++1",
                           "1 2", "0x10", "t=1", "D", "1d2d3"})
    EXPECT_EQ(timeIn(text), std::nullopt) << text;
  EXPECT_EQ(plainTime("0.5"), 0.5);
  for (const char* text : {"", " 1", "+1", "1D2", "nan", "inf"})
    EXPECT_EQ(plainTime(text), std::nullopt) << text;
}

TEST(TimeText, sixTimesAreShownAndTheOthersCounted) {
  const std::vector<double> times{0, 0.5, 1, 2, 3, 4, 5, 6};
  EXPECT_EQ(shownTimes(std::span(times).first(6)), "0, 0.5, 1, 2, 3, 4");
  EXPECT_EQ(shownTimes(times), "0, 0.5, 1, 2, 3, 4 and 2 more");
}

}  // namespace
}  // namespace qtet
