#include "simplify/words/byte_count.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

TEST(ByteCount, readsWhatPeopleWrite) {
  EXPECT_EQ(parseByteCount("0"), 0u);
  EXPECT_EQ(parseByteCount("1500M"), 1'500'000'000u);
  EXPECT_EQ(parseByteCount("4G"), 4'000'000'000u);
  EXPECT_EQ(parseByteCount("2T"), 2'000'000'000'000u);
  EXPECT_EQ(parseByteCount("7k"), 7000u);
  EXPECT_EQ(parseByteCount("999999999999"), 999'999'999'999u);
  for (const char* text :
       {"", "G", "-1", "1.5G", "4GB", "4g", " 4", "1000000000000", "999999999999T"})
    EXPECT_EQ(parseByteCount(text), std::nullopt) << text;
}

}  // namespace
}  // namespace qtet
