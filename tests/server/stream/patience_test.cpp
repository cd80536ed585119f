#include "server/stream/patience.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

using std::chrono::seconds;
using Verdict = Patience::Verdict;

const Patience::Clock::time_point kBegin{seconds(100)};

TEST(Patience, aSilentClientIsPingedAtHalfTheTimeAndThenGivenUp) {
  Patience patience(seconds(30), seconds(1000), kBegin);
  EXPECT_EQ(patience.interval(), seconds(15));
  EXPECT_EQ(patience.at(kBegin + seconds(14)), Verdict::kWait);
  EXPECT_EQ(patience.at(kBegin + seconds(15)), Verdict::kPing);
  EXPECT_EQ(patience.at(kBegin + seconds(29)), Verdict::kPing);
  EXPECT_EQ(patience.at(kBegin + seconds(30)), Verdict::kGiveUp);
  patience.heard(kBegin + seconds(29));
  EXPECT_EQ(patience.at(kBegin + seconds(30)), Verdict::kWait);
}

TEST(Patience, whoTakesNothingIsGivenUpHoweverMuchItSays) {
  Patience patience(seconds(1000), seconds(30), kBegin);
  patience.took(kBegin);
  patience.heard(kBegin + seconds(29));
  EXPECT_EQ(patience.at(kBegin + seconds(29)), Verdict::kWait);
  EXPECT_EQ(patience.at(kBegin + seconds(30)), Verdict::kGiveUp);
  patience.took(kBegin + seconds(10));
  EXPECT_EQ(patience.at(kBegin + seconds(39)), Verdict::kWait);
  EXPECT_EQ(patience.at(kBegin + seconds(40)), Verdict::kGiveUp);
  patience.wrote();
  EXPECT_EQ(patience.at(kBegin + seconds(40)), Verdict::kWait) << "nothing is being written";
}

}  // namespace
}  // namespace qtet
