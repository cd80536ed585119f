// The time that our own readers have.
#include "simplify/read/process/reading_time.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

using std::chrono::seconds;

TEST(ReadingTime, endsAfterPatienceAndWhatTheSizeAdds) {
  EXPECT_FALSE(ReadingTime().isOver());
  EXPECT_FALSE(ReadingTime(seconds(60), 0).isOver());
  EXPECT_TRUE(ReadingTime(seconds(-60), 59 * ReadingTime::kSlowestBytesPerSecond).isOver());
  EXPECT_FALSE(ReadingTime(seconds(-60), 80 * ReadingTime::kSlowestBytesPerSecond).isOver());
  EXPECT_FALSE(ReadingTime(seconds(60), ~std::uint64_t{0}).isOver()) << "no clock overflows";
}

TEST(ReadingTime, anotherFileDoesNotBeginAnew) {
  ReadingTime time(seconds(-60), 0);
  time.addFile(30 * ReadingTime::kSlowestBytesPerSecond);
  EXPECT_TRUE(time.isOver());
  time.addFile(50 * ReadingTime::kSlowestBytesPerSecond);
  EXPECT_FALSE(time.isOver());
  for (int i = 0; i < 1000; ++i) time.addFile(~std::uint64_t{0});
  EXPECT_FALSE(time.isOver()) << "no clock overflows";
}

}  // namespace
}  // namespace qtet
