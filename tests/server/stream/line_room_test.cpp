#include "server/stream/line_room.h"

#include <gtest/gtest.h>

#include <chrono>

namespace qtet {
namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;

constexpr std::uint64_t kPacket = 1448;
constexpr std::uint64_t kRate = 250'000;  // bytes a second: 2 Mbit/s

/// A line that has delivered kRate for a second, seen every 10 ms.
struct MeasuredLine {
  MeasuredLine() {
    for (int i = 0; i <= 100; ++i) pass(10ms);
  }
  void pass(milliseconds time, std::uint64_t rate = kRate) {
    now += time;
    figures.acknowledged += rate * static_cast<std::uint64_t>(time.count()) / 1000;
    (void)line.room(figures, now);
  }
  std::size_t room() { return line.room(figures, now); }

  LineFigures figures{.packetBytes = kPacket, .rtt = 50ms, .minRtt = 50ms};
  LineRoom::Clock::time_point now{1h};
  LineRoom line;
};

TEST(LineRoom, withoutAQueueOnlyUnsentBytesCount) {
  MeasuredLine m;
  m.figures.underWay = 12'500;
  EXPECT_EQ(m.room(), 10'000u) << "40 ms";
  m.figures.unsent = 6000;
  EXPECT_EQ(m.room(), 4000u);
  m.figures.unsent = 10'000;
  EXPECT_EQ(m.room(), 0u);
}

TEST(LineRoom, withoutAQueueWhatIsUnderWayTellsOfAFasterLine) {
  MeasuredLine m;
  m.figures.underWay = 50'000;
  EXPECT_EQ(m.room(), 40'000u) << "40 ms of 1 MB/s";
}

TEST(LineRoom, withAQueueWhatIsUnderWayCountsToo) {
  MeasuredLine m;
  m.figures.rtt = 200ms;
  m.figures.underWay = 12'500;
  EXPECT_EQ(m.room(), 10'000u) << "90 ms less the 50 that the line itself holds";
  m.figures.underWay = 22'500;
  EXPECT_EQ(m.room(), 0u);
}

TEST(LineRoom, aPieceTakesTheLineFortyMillisecondsButHasFourKilobytes) {
  LineRoom unknown;
  EXPECT_EQ(unknown.piece(), LineRoom::kUnbounded);
  MeasuredLine m;
  (void)m.room();
  EXPECT_EQ(m.line.piece(), 10'000u);
  for (int i = 0; i < 1000; ++i) m.pass(10ms, 50'000);
  (void)m.room();
  EXPECT_EQ(m.line.piece(), 4096u);
}

TEST(LineRoom, aSlowLineHoldsSixPackets) {
  LineRoom line;
  LineFigures figures{.unsent = 0, .packetBytes = kPacket, .rtt = 50ms, .minRtt = 50ms};
  EXPECT_EQ(line.room(figures, LineRoom::Clock::time_point(1h)), 6 * kPacket);
  figures.unsent = 6 * kPacket;
  EXPECT_EQ(line.room(figures, LineRoom::Clock::time_point(2h)), 0u);
}

TEST(LineRoom, waitsAsLongAsTheLineNeedsForTheExcess) {
  MeasuredLine m;
  m.figures.unsent = 12'500;
  ASSERT_EQ(m.room(), 0u);
  EXPECT_EQ(m.line.wait(), 10ms);
  m.figures.unsent = 1'000'000;
  ASSERT_EQ(m.room(), 0u);
  EXPECT_EQ(m.line.wait(), 20ms) << "at most";
  m.figures.unsent = 10'000;
  ASSERT_EQ(m.room(), 0u);
  EXPECT_EQ(m.line.wait(), 1ms) << "at least";
}

TEST(LineRoom, aRestTellsNothingOfTheLine) {
  MeasuredLine m;
  m.line.rests();
  m.now += 1h;
  for (int i = 0; i < 7; ++i) m.line.rests(), m.pass(1000ms, 0);
  EXPECT_EQ(m.room(), 10'000u);
}

TEST(LineRoom, aLineThatBecomesSlowerIsBelieved) {
  MeasuredLine m;
  for (int i = 0; i < 200; ++i) m.pass(10ms, kRate * 9 / 10);
  EXPECT_EQ(m.room(), 9000u);
}

TEST(LineRoom, aBurstOfAcknowledgementsIsNoFasterLine) {
  MeasuredLine m;
  for (int i = 0; i < 20; ++i) m.pass(50ms, i % 4 == 0 ? 4 * kRate : 0);
  EXPECT_EQ(m.room(), 10'000u) << "the mean of 200 ms is the same";
}

TEST(LineRoom, tellsWhetherSomethingWasAcknowledged) {
  MeasuredLine m;
  EXPECT_TRUE(m.line.progressed());
  (void)m.room();
  EXPECT_FALSE(m.line.progressed());
}

}  // namespace
}  // namespace qtet
