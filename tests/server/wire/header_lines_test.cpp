#include "server/wire/header_lines.h"

#include <gtest/gtest.h>

#include "server/wire/document.h"
#include "server/wire/http_date.h"

namespace qtet {
namespace {

TEST(HeaderLines, areALineEachInTheirOrder) {
  HeaderLines lines = {{"ETag", "\"a\""}, {"Vary", ""}};
  lines.add("Link", "<b>: c");
  EXPECT_EQ(lines.text(), "ETag: \"a\"\r\nVary: \r\nLink: <b>: c\r\n");
  EXPECT_EQ(lines.find("ETag"), "\"a\"");
  EXPECT_EQ(lines.find("Vary"), "");
  EXPECT_EQ(lines.find("Link"), "<b>: c");
}

TEST(HeaderLines, aNameIsFoundWholeAndAtALinesBegin) {
  const HeaderLines lines = {{"Content-Type", "Range: 1"}, {"Content-Range", "2"}};
  EXPECT_FALSE(lines.find("Content"));
  EXPECT_FALSE(lines.find("Range"));
  EXPECT_FALSE(lines.find("Type"));
  EXPECT_EQ(lines.find("Content-Range"), "2");
}

TEST(HeaderLines, settingReplacesTheFirstLineOfTheNameOrAddsOne) {
  HeaderLines lines = {{"A", "1"}, {"B", "2"}, {"A", "3"}};
  lines.set("A", "longer");
  lines.set("C", "4");
  EXPECT_EQ(lines.text(), "A: longer\r\nB: 2\r\nA: 3\r\nC: 4\r\n");
}

TEST(HeaderLines, removingLeavesTheOthers) {
  HeaderLines lines = {{"A", "1"}, {"B", "2"}, {"C", "3"}};
  lines.remove("B");
  lines.remove("D");
  EXPECT_EQ(lines.text(), "A: 1\r\nC: 3\r\n");
  lines.remove("A");
  lines.remove("C");
  EXPECT_EQ(lines, HeaderLines());
}

TEST(Document, hasAHeadForEachCodingAndNoVaryWithoutOne) {
  const Resource about{{"", 784111777}, "application/json", kRevalidate};
  const Document small("{}", about);
  EXPECT_FALSE(small.gzip || small.zstd);
  EXPECT_FALSE(small.identity.headers.find("Vary"));
  const Document large(std::string(kMinCompressedBytes, ' '), about);
  ASSERT_TRUE(large.gzip && large.zstd);
  for (const DocumentForm* form : {&large.identity, &*large.gzip, &*large.zstd}) {
    EXPECT_EQ(form->headers.find("Vary"), "Accept-Encoding");
    EXPECT_EQ(form->headers.find("ETag"), form->validators.etag);
    EXPECT_EQ(form->headers.find("Last-Modified"), "Sun, 06 Nov 1994 08:49:37 GMT");
  }
  EXPECT_FALSE(large.identity.headers.find("Content-Encoding"));
  EXPECT_EQ(large.gzip->headers.find("Content-Encoding"), "gzip");
  EXPECT_EQ(large.zstd->headers.find("Content-Encoding"), "zstd");
  EXPECT_EQ(large.zstd->validators.plainEtag, large.etag());
}

TEST(HttpDateNow, isTheTimeOfNow) {
  const auto read = parseHttpDate(httpDateNow());
  ASSERT_TRUE(read);
  EXPECT_LE(std::time(nullptr) - *read, 1);
}

}  // namespace
}  // namespace qtet
