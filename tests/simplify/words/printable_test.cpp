#include "simplify/words/printable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "simplify/words/columns.h"

namespace qtet {
namespace {

TEST(Printable, whatATerminalObeysIsReplacedAndAllElseStays) {
  EXPECT_EQ(printable("T in °C, λ"), "T in °C, λ");
  EXPECT_EQ(printable("\033[31mred\007"), "\uFFFD[31mred\uFFFD");
  EXPECT_EQ(printable("a\x7F"), "a\uFFFD");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m\xC2\xA0\xC2"),
            "\uFFFD31m\xC2\xA0?")
      << "CSI is one, no-break space none, and half a character is passed on";
  EXPECT_EQ(printable("a\nb\tc\r"), "a\uFFFDb\uFFFDc\uFFFD");
  EXPECT_EQ(printable("a\nb\r", true), "a\nb\uFFFD");
}

TEST(Printable, widthIsOfCharactersAndCountsHaveTheirWord) {
  EXPECT_EQ(textWidth("T in °C, λ"), 10u);
  EXPECT_EQ(textWidth(""), 0u);
  EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
  EXPECT_EQ(counted(0, "vertex", "vertices"), "0 vertices");
  EXPECT_EQ(counted(1234567, "vertex", "vertices"), "1,234,567 vertices");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
}

TEST(Printable, paragraphsAreFilledAndKeptApart) {
  EXPECT_EQ(filled("one\ntwo\n\nthree\n--json: four\nfive"), "one two\n\nthree\n--json: four five");
  EXPECT_EQ(filled(""), "");
  const std::string item(92, 'i');
  EXPECT_EQ(filled("one of:\n  a    " + item + " x\n  b c  y\n  d\nend"),
            "one of:\n  a    " + item + "\n       x\n  b c  y d end");
  std::string words;
  for (int i = 0; i < 60; ++i) words += "w\u00F6rd ";
  const std::string text = filled(words + std::string(120, 'x') + " end", "  ");
  std::istringstream lines(text);
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);)
    if (line.find('x') == std::string::npos) longest = std::max(longest, textWidth(line));
  EXPECT_LE(longest, kHelpColumns);
  EXPECT_GT(longest, kHelpColumns - 5);
  EXPECT_NE(text.find("\n  w\u00F6rd"), std::string::npos);
  EXPECT_NE(text.find("\n  " + std::string(120, 'x') + "\n  end"), std::string::npos);
}

TEST(Columns, areAsWideAsTheirWidestCell) {
  EXPECT_EQ(columns({{"field", "bits"}, {"T", "1.25"}, {"\u00E4ther", "12.50"}}),
            "field   bits\nT       1.25\n\u00E4ther  12.50\n");
  EXPECT_EQ(moreFields(kShownFields, "--all"), "");
  EXPECT_EQ(moreFields(kShownFields + 1, "--all"), "and 1 more field: --all\n");
}

}  // namespace
}  // namespace qtet
