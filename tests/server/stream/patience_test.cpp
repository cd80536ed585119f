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
  EXPECT_EQ(patience.at(kBegin + seconds(29)), Verdict::kWait);
  EXPECT_EQ(patience.at(kBegin + seconds(30)), Verdict::kSilent);
  patience.heard(kBegin + seconds(29));
  EXPECT_EQ(patience.at(kBegin + seconds(30)), Verdict::kWait);
}

TEST(Patience, whoAnswersEveryPingStaysHoweverLateTheClockIs) {
  for (const int lateUs : {0, 1, 300, 2'000'000})
    for (const int answerUs : {0, 1, 300, 14'000'000}) {
      Patience patience(seconds(30), seconds(30), kBegin);
      auto now = kBegin;
      for (int i = 0; i < 20; ++i) {
        now += patience.interval() + std::chrono::microseconds(lateUs);
        const Verdict verdict = patience.at(now);
        ASSERT_NE(verdict, Verdict::kSilent) << lateUs << ", " << answerUs << ", check " << i;
        if (verdict != Verdict::kPing) continue;
        patience.begins(now);
        patience.took(now);
        patience.wrote();
        patience.heard(now + std::chrono::microseconds(answerUs));
      }
    }
}

TEST(Patience, aPingThatTheSystemTakesIsNoSignOfLife) {
  Patience patience(seconds(30), seconds(30), kBegin);
  ASSERT_EQ(patience.at(kBegin + seconds(16)), Verdict::kPing);
  patience.begins(kBegin + seconds(17));
  patience.took(kBegin + seconds(17));
  patience.wrote();
  EXPECT_EQ(patience.at(kBegin + seconds(31)), Verdict::kSilent);
}

TEST(Patience, whoTakesNothingIsGivenUpHoweverMuchItSays) {
  Patience patience(seconds(1000), seconds(30), kBegin);
  patience.begins(kBegin);
  patience.heard(kBegin + seconds(29));
  EXPECT_EQ(patience.at(kBegin + seconds(29)), Verdict::kWait);
  EXPECT_EQ(patience.at(kBegin + seconds(30)), Verdict::kStuck);
  patience.took(kBegin + seconds(10));
  EXPECT_EQ(patience.at(kBegin + seconds(39)), Verdict::kWait);
  EXPECT_EQ(patience.at(kBegin + seconds(40)), Verdict::kStuck);
  patience.wrote();
  EXPECT_EQ(patience.at(kBegin + seconds(40)), Verdict::kWait) << "nothing is being written";
}

TEST(Patience, waitingForRoomAnewDoesNotBeginThePatienceAnew) {
  Patience patience(seconds(1000), seconds(30), kBegin);
  patience.begins(kBegin);
  patience.begins(kBegin + seconds(29));
  EXPECT_EQ(patience.at(kBegin + seconds(30)), Verdict::kStuck);
}

TEST(Patience, whoeverTakesBytesSteadilyIsAliveThoughNoPongComes) {
  Patience patience(seconds(30), seconds(30), kBegin);
  patience.begins(kBegin);
  for (int i = 1; i <= 20; ++i) {
    patience.took(kBegin + seconds(10 * i));
    EXPECT_EQ(patience.at(kBegin + seconds(10 * i + 9)), Verdict::kWait) << i;
  }
  patience.wrote();
  EXPECT_EQ(patience.at(kBegin + seconds(215)), Verdict::kPing);
  EXPECT_EQ(patience.at(kBegin + seconds(229)), Verdict::kWait) << "since the last byte taken";
  EXPECT_EQ(patience.at(kBegin + seconds(230)), Verdict::kSilent);
}

TEST(Patience, aWriteThatHasJustBegunIsWaitedForHoweverLongTheClientWasSilent) {
  Patience patience(seconds(30), seconds(30), kBegin);
  patience.begins(kBegin + seconds(29));
  EXPECT_EQ(patience.at(kBegin + seconds(58)), Verdict::kWait) << "a ping would come behind it";
  EXPECT_EQ(patience.at(kBegin + seconds(59)), Verdict::kStuck);
}

}  // namespace
}  // namespace qtet
