#include "server/http/content_disposition.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

std::string saved(std::string_view name) {
  return contentDisposition(Disposition::kAttachment, name);
}

TEST(ContentDisposition, anOrdinaryNameStandsInQuotes) {
  EXPECT_EQ(saved("part-level-3.vtu"), "attachment; filename=\"part-level-3.vtu\"");
  EXPECT_EQ(saved("a b;c'd.vtu"), "attachment; filename=\"a b;c'd.vtu\"");
  EXPECT_EQ(contentDisposition(Disposition::kInline, "a.png"), "inline; filename=\"a.png\"");
}

TEST(ContentDisposition, anOddNameStandsThereTwice) {
  EXPECT_EQ(saved("100%.vtu"), "attachment; filename=\"100_.vtu\"; filename*=UTF-8''100%25.vtu");
  EXPECT_EQ(saved("a\"b\\c.vtu"),
            "attachment; filename=\"a_b_c.vtu\"; filename*=UTF-8''a%22b%5Cc.vtu");
  EXPECT_EQ(saved("Fl\303\274gel \360\237\233\251.vtu"),
            "attachment; filename=\"Fl_gel _.vtu\"; "
            "filename*=UTF-8''Fl%C3%BCgel%20%F0%9F%9B%A9.vtu");
}

TEST(ContentDisposition, noNameEndsTheHeaderOrTheParameter) {
  for (int byte = 0; byte < 256; ++byte) {
    const std::string header = saved(std::string("x") + static_cast<char>(byte) + "y");
    EXPECT_EQ(std::string_view(header).find_first_of("\r\n"), std::string_view::npos) << byte;
    const std::size_t opened = header.find('"');
    const std::size_t closed = header.find('"', opened + 1);
    EXPECT_EQ(header.substr(closed + 1).find('"'), std::string::npos) << byte;
  }
}

}  // namespace
}  // namespace qtet
