#include "proto/segment_list.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

const char* const kTwo =
    R"({"qtet": "series", "made": [1], "segments": [
      {"log": "flow.0.qtet", "times": [0, 0.1, 0.2], "note": null},
      {"log": "flow.1.qtet", "times": [0.3]}]})";

SegmentList listOf(std::size_t segments) {
  SegmentList out;
  for (std::size_t i = 0; i < segments; ++i)
    out.segments.push_back({"run." + std::to_string(i) + ".qtet", {static_cast<double>(i)}});
  return out;
}

/// A list of one segment.
std::string one(const std::string& log, const std::string& times) {
  return R"({"qtet":"series","segments":[{"log":")" + log + R"(","times":)" + times + "}]}";
}

void expectRefused(const std::string& text, const std::string& place) {
  const Result<SegmentList> list = readSegmentList(text);
  ASSERT_FALSE(list) << text;
  EXPECT_EQ(list.error().code, ErrorCode::kBadValue) << text;
  EXPECT_NE(list.error().message.find(place), std::string::npos) << list.error().text();
}

TEST(SegmentList, unknownMembersAreIgnored) {
  const SegmentList list = readSegmentList(kTwo).value();
  ASSERT_EQ(list.segments.size(), 2u);
  EXPECT_EQ(list.segments[0].log, "flow.0.qtet");
  EXPECT_EQ(list.segments[1].times, std::vector<double>{0.3});
  EXPECT_EQ(list.times(), (std::vector<double>{0, 0.1, 0.2, 0.3}));
}

TEST(SegmentList, timesComeBackToTheBit) {
  SegmentList list = listOf(1);
  list.segments[0].times = {-1e300, 0.1, 1.0 / 3, 1e300};
  const SegmentList read = readSegmentList(segmentListText(list).value()).value();
  EXPECT_EQ(read.segments[0].times, list.segments[0].times);
}

TEST(SegmentList, itsTextIsASegmentALine) {
  EXPECT_EQ(segmentListText(readSegmentList(kTwo).value()).value(),
            "{\n  \"qtet\": \"series\",\n  \"segments\": [\n"
            "    {\"log\": \"flow.0.qtet\", \"times\": [0.0,0.1,0.2]},\n"
            "    {\"log\": \"flow.1.qtet\", \"times\": [0.3]}\n  ]\n}\n");
}

TEST(SegmentList, segmentsAreLimited) {
  EXPECT_TRUE(segmentListText(listOf(kMaxSegments - 1)));
  EXPECT_TRUE(segmentListText(listOf(kMaxSegments)));
  const auto text = segmentListText(listOf(kMaxSegments + 1));
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::kLimitExceeded);
  expectRefused(R"({"qtet":"series","segments":[]})", "/segments must be an array of 1");
  EXPECT_FALSE(segmentListText({}));
}

TEST(SegmentList, bytesAreLimited) {
  std::string text = kTwo;
  text.resize(kMaxListBytes - 1, ' ');
  EXPECT_TRUE(readSegmentList(text));
  text.resize(kMaxListBytes, ' ');
  EXPECT_TRUE(readSegmentList(text));
  text.resize(kMaxListBytes + 1, ' ');
  EXPECT_EQ(readSegmentList(text).error().code, ErrorCode::kLimitExceeded);
}

TEST(SegmentList, aLogIsAFileBesideTheList) {
  for (const char* log : {"a.qtet", "a b.0.qtet", "-.qtet"})
    EXPECT_TRUE(readSegmentList(one(log, "[0]"))) << log;
  for (const char* log : {"", ".qtet", "a.vtu", "a.qtet ", "b/a.qtet", "/a.qtet", "..qtet",
                          "a..qtet", "b\\\\a.qtet", "a\\u0000.qtet", "../a.qtet"})
    expectRefused(one(log, "[0]"), "/segments/0/log");
}

TEST(SegmentList, timesAscendOverAllSegments) {
  expectRefused(one("a.qtet", "[]"), "/segments/0/times");
  expectRefused(one("a.qtet", "[0, 0]"), "/segments/0/times/1");
  expectRefused(one("a.qtet", "[1e999]"), "no JSON");
  expectRefused(one("a.qtet", "[\"0\"]"), "/segments/0/times/0");
  SegmentList list = listOf(3);
  list.segments[2].times = {1};
  EXPECT_NE(segmentListText(list).error().message.find("/segments/2/times/0"), std::string::npos);
  list.segments[2].times = {std::numeric_limits<double>::quiet_NaN()};
  EXPECT_FALSE(segmentListText(list));
}

TEST(SegmentList, otherDocumentsAreRefused) {
  expectRefused("", "no JSON");
  expectRefused("[]", "must be an object");
  expectRefused("{}", "/qtet is missing");
  expectRefused(R"({"qtet":"series"})", "/segments is missing");
  expectRefused(R"({"qtet":"log","segments":[{"log":"a.qtet","times":[0]}]})", "/qtet must be");
  expectRefused(R"({"qtet":"series","segments":[7]})", "/segments/0 must be an object");
  expectRefused(std::string(100, '['), "nested too deeply");
}

TEST(SegmentList, everyTruncationIsRefused) {
  const std::string text = segmentListText(listOf(2)).value();
  for (std::size_t size = 0; size + 2 < text.size(); ++size)
    EXPECT_FALSE(readSegmentList(std::string_view(text).substr(0, size))) << size;
}

TEST(SegmentList, goldenListsAreReadOrRefusedByTheirCode) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::kGoldenFolder) / "lists";
  const auto read = [](const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return readSegmentList(std::string{std::istreambuf_iterator<char>(in), {}});
  };
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder / "valid")) {
    EXPECT_TRUE(read(entry.path())) << entry.path();
    ++files;
  }
  for (const auto& entry : fs::directory_iterator(folder / "must-fail")) {
    const Result<SegmentList> list = read(entry.path());
    ASSERT_FALSE(list) << entry.path();
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(errorCodeName(list.error().code), name.substr(0, name.find('.'))) << name;
    ++files;
  }
  EXPECT_GE(files, 6u);
}

}  // namespace
}  // namespace qtet
