#include "server/http/http_conditions.h"

#include <gtest/gtest.h>

#include "server/wire/http_date.h"

namespace qtet {
namespace {

constexpr std::time_t kTime = 784111777;  // RFC 9110's own example
const Validators kResource{"\"abc\"", kTime};

Verdict verdict(const RequestView& request) { return evaluateConditions(request, kResource); }

TEST(HttpDate, isTheFormOfRfc9110BothWays) {
  EXPECT_EQ(httpDate(kTime), "Sun, 06 Nov 1994 08:49:37 GMT");
  EXPECT_EQ(parseHttpDate("Sun, 06 Nov 1994 08:49:37 GMT"), kTime);
  for (const std::time_t t : {std::time_t{0}, std::time_t{951782400}, std::time_t{4102444799}})
    EXPECT_EQ(parseHttpDate(httpDate(t)), t);
}

TEST(HttpDate, theTwoFormsThatAreObsoleteCountAsWell) {
  EXPECT_EQ(parseHttpDate("Sunday, 06-Nov-94 08:49:37 GMT"), kTime);
  EXPECT_EQ(parseHttpDate("Sun Nov  6 08:49:37 1994"), kTime);
  EXPECT_EQ(parseHttpDate("Wed Nov 16 08:49:37 1994"), kTime + 10 * 86400);
  // two digits: at most 50 years ahead
  EXPECT_EQ(parseHttpDate("Tuesday, 01-Jan-30 00:00:00 GMT"), 1893456000);
  EXPECT_EQ(
      verdict({.method = "GET", .target = "/", .ifModifiedSince = "Sun Nov  6 08:49:37 1994"}),
      Verdict::kNotModified);
  EXPECT_EQ(selectRange({.method = "GET",
                         .target = "/",
                         .range = "bytes=0-1",
                         .ifRange = "Sunday, 06-Nov-94 08:49:37 GMT"},
                        kResource, 10)
                .kind,
            ByteRange::Kind::kPart);
}

TEST(HttpDate, anythingElseIsNoDate) {
  for (const char* text :
       {"", "yesterday", "Mon, 06 Nov 1994 08:49:37 GMT", "Sun, 06 Nov 1994 25:49:37 GMT",
        "Sun, 31 Feb 1994 08:49:37 GMT", "Sun, 06-Nov-1994 08:49:37 GMT",
        "Sun, 06 Nov 1994 08:49:37 UTC", "Monday, 06-Nov-94 08:49:37 GMT",
        "Sunday, 06-Nov-1994 08:49:37 GMT", "Sunday, 06 Nov 94 08:49:37 GMT",
        "Sunday, 06-Nov-94 08:49:37", "Day, 06-Nov-94 08:49:37 GMT", "Sun Nov 06 8:49:37 1994",
        "Mon Nov  6 08:49:37 1994", "Sun Nov  6 08:49:37 94", "Sun Nov  6 08:49:37 1994 GMT",
        ", 06-Nov-94 08:49:37 GMT", "Sun Nov 31 08:49:37 1994"})
    EXPECT_FALSE(parseHttpDate(text)) << text;
}

TEST(Conditions, ifNoneMatchComparesWeaklyAndOverLists) {
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifNoneMatch = "\"abc\""}),
            Verdict::kNotModified);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifNoneMatch = "W/\"abc\""}),
            Verdict::kNotModified);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifNoneMatch = "\"x\" , \"abc\""}),
            Verdict::kNotModified);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifNoneMatch = "*"}), Verdict::kNotModified);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifNoneMatch = "\"x\""}), Verdict::kSend);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifNoneMatch = ""}), Verdict::kSend);
}

TEST(Conditions, ifMatchComparesStrongly) {
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifMatch = "\"abc\""}), Verdict::kSend);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifMatch = "*"}), Verdict::kSend);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifMatch = "W/\"abc\""}),
            Verdict::kPreconditionFailed);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifMatch = "\"x\""}),
            Verdict::kPreconditionFailed);
}

TEST(Conditions, datesCountWhereNoTagDoes) {
  const std::string same = httpDate(kTime), before = httpDate(kTime - 1),
                    after = httpDate(kTime + 1);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifModifiedSince = same}),
            Verdict::kNotModified);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifModifiedSince = after}),
            Verdict::kNotModified);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifModifiedSince = before}), Verdict::kSend);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifModifiedSince = "soon"}), Verdict::kSend);
  EXPECT_EQ(
      verdict({.method = "GET", .target = "/", .ifNoneMatch = "\"x\"", .ifModifiedSince = after}),
      Verdict::kSend);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifUnmodifiedSince = before}),
            Verdict::kPreconditionFailed);
  EXPECT_EQ(verdict({.method = "GET", .target = "/", .ifUnmodifiedSince = same}), Verdict::kSend);
  EXPECT_EQ(
      verdict({.method = "GET", .target = "/", .ifMatch = "\"abc\"", .ifUnmodifiedSince = before}),
      Verdict::kSend);
}

struct RangeCase {
  const char* text;
  ByteRange::Kind kind;
  std::uint64_t first, size;
};

TEST(Ranges, ofATenByteFile) {
  using enum ByteRange::Kind;
  for (const RangeCase& c :
       std::initializer_list<RangeCase>{{"bytes=0-0", kPart, 0, 1},
                                        {"bytes=0-9", kPart, 0, 10},
                                        {"bytes=0-", kPart, 0, 10},
                                        {"bytes=9-", kPart, 9, 1},
                                        {"bytes=3-5", kPart, 3, 3},
                                        {"Bytes=3-5", kPart, 3, 3},
                                        {" bytes= 3-5 ", kPart, 3, 3},
                                        {"bytes=3-100", kPart, 3, 7},
                                        {"bytes=3-99999999999999999999999", kPart, 3, 7},
                                        {"bytes=-4", kPart, 6, 4},
                                        {"bytes=-10", kPart, 0, 10},
                                        {"bytes=-11", kPart, 0, 10},
                                        {"bytes=-99999999999999999999999", kPart, 0, 10},
                                        {"bytes=10-", kUnsatisfiable, 0, 0},
                                        {"bytes=10-20", kUnsatisfiable, 0, 0},
                                        {"bytes=99999999999999999999999-", kUnsatisfiable, 0, 0},
                                        {"bytes=-0", kUnsatisfiable, 0, 0},
                                        {"bytes=5-3", kWhole, 0, 0},
                                        {"bytes=-", kWhole, 0, 0},
                                        {"bytes=", kWhole, 0, 0},
                                        {"bytes=a-b", kWhole, 0, 0},
                                        {"bytes=1-2x", kWhole, 0, 0},
                                        {"bytes=+1-2", kWhole, 0, 0},
                                        {"bytes=1 - 2", kWhole, 0, 0},
                                        {"bytes=0-1,4-5", kWhole, 0, 0},
                                        {"items=0-1", kWhole, 0, 0},
                                        {"bytes", kWhole, 0, 0},
                                        {"", kWhole, 0, 0}}) {
    const ByteRange range =
        selectRange({.method = "GET", .target = "/", .range = c.text}, kResource, 10);
    EXPECT_EQ(range.kind, c.kind) << c.text;
    EXPECT_EQ(range.first, c.first) << c.text;
    EXPECT_EQ(range.size, c.size) << c.text;
  }
}

TEST(Ranges, anEmptyFileHasNone) {
  for (const char* text : {"bytes=0-0", "bytes=0-", "bytes=-1"})
    EXPECT_EQ(selectRange({.method = "GET", .target = "/", .range = text}, kResource, 0).kind,
              ByteRange::Kind::kUnsatisfiable)
        << text;
}

TEST(Ranges, countForGetAloneAndOnlyWhenIfRangeHolds) {
  const auto kind = [](std::string_view method, std::optional<std::string_view> ifRange) {
    return selectRange({.method = method, .target = "/", .range = "bytes=0-1", .ifRange = ifRange},
                       kResource, 10)
        .kind;
  };
  EXPECT_EQ(kind("GET", "\"abc\""), ByteRange::Kind::kPart);
  EXPECT_EQ(kind("GET", httpDate(kTime)), ByteRange::Kind::kPart);
  EXPECT_EQ(kind("GET", "\"x\""), ByteRange::Kind::kWhole);
  EXPECT_EQ(kind("GET", "W/\"abc\""), ByteRange::Kind::kWhole);
  EXPECT_EQ(kind("GET", httpDate(kTime + 1)), ByteRange::Kind::kWhole);
  EXPECT_EQ(kind("HEAD", std::nullopt), ByteRange::Kind::kWhole);
}

}  // namespace
}  // namespace qtet
