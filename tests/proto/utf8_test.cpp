#include "proto/utf8.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

TEST(Utf8, isToldFromWhatLooksLikeIt) {
  for (const std::string_view good :
       {"", "a", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
        "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_TRUE(isUtf8(good)) << ::testing::PrintToString(good);
  for (const std::string_view bad :
       {"\x80", "\xC0\x80", "\xC1\xBF", "\xC2", "\xC2\x41", "\xE0\x9F\xBF", "\xE1\x80",
        "\xED\xA0\x80", "\xED\xBF\xBF", "\xF0\x8F\xBF\xBF", "\xF1\x80\x80", "\xF4\x90\x80\x80",
        "\xF5\x80\x80\x80", "\xFF"})
    EXPECT_FALSE(isUtf8(bad)) << ::testing::PrintToString(bad);
}

TEST(Utf8, whatIsNoneIsMarkedByteByByte) {
  EXPECT_EQ(soundUtf8(""), "");
  EXPECT_EQ(soundUtf8("Dichte \u03C1"), "Dichte \u03C1");
  EXPECT_EQ(soundUtf8("caf\xE9.vtu"), "caf?.vtu");
  EXPECT_EQ(soundUtf8("\xED\xA0\x80\xE2\x82"), "?????");
}

TEST(Utf8, charactersThatMoveOrEndALineAreControls) {
  for (const char* control :
       {"\n", "a\x1F", "\x7F", "\xC2\x80", "a\xC2\x9F", "\xE2\x80\xA8", "a\xE2\x80\xA9"})
    EXPECT_TRUE(hasControl(control)) << control;
  for (const char* shown :
       {"", "a b~", "\xC2\xA0", "\xC3\x85", "\xE2\x80\xA7", "\xE2\x80\xAA", "\xE2\x81\xA8"})
    EXPECT_FALSE(hasControl(shown)) << shown;
  EXPECT_TRUE(hasControl(std::string_view("\0", 1)));
}

}  // namespace
}  // namespace qtet
