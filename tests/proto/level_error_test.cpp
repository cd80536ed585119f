// The known error of a level in the manifest: there and back, absent, and everything it must not be.
#include "proto/level_error.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "proto/manifest.h"

namespace qtet {
namespace {

using Json = nlohmann::json;

Manifest sample() {
  Manifest m;
  m.latticeBits = 16;
  m.fields.push_back({"density", 1, "float32", "point", 12, 0.00025, {0.1}, {0.1, 0.9}});
  m.fields.push_back({"velocity", 3, "float64", "point", 14, 0.5, {-1, -2, -3}, {0, 7}});
  const LevelError base{{0.001234, 0.02}, {0.001, 0.03}, 0.987654, {{0.0125, 0.3}, {1e-7, 2.5}}};
  m.levels = {{0, 100, 40, 60, 0, base}, {1, 105, 42, 62, 0}, {2, 230, 80, 90, 3, LevelError{{}, {}, 1, {{}, {}}}}};
  return m;
}

Json sampleJson() { return Json::parse(manifestToJson(sample())); }

void expectRefused(const std::string& pointer, const Json& value, const std::string& place) {
  Json json = sampleJson();
  json[Json::json_pointer("/levels/0/error" + pointer)] = value;
  const Result<Manifest> read = manifestFromJson(json.dump());
  ASSERT_FALSE(read) << "accepted: " << pointer << " = " << value;
  EXPECT_EQ(read.error().code, ErrorCode::kBadValue);
  EXPECT_NE(read.error().message.find("/levels/0/error" + place), std::string::npos) << read.error().message;
}

TEST(LevelError, comesBackToTheBit) {
  const Result<Manifest> read = manifestFromJson(manifestToJson(sample()));
  ASSERT_TRUE(read) << read.error().message;
  const auto& base = read->levels[0].error;
  ASSERT_TRUE(base);
  EXPECT_EQ(base->toLevel.mean, 0.001234);
  EXPECT_EQ(base->toLevel.max, 0.02);
  EXPECT_EQ(base->toOriginal.mean, 0.001);
  EXPECT_EQ(base->toOriginal.max, 0.03);
  EXPECT_EQ(base->boundaryDistance(), 0.03);
  EXPECT_EQ(base->boundaryMean(), 0.001234);
  EXPECT_EQ(base->volumeKept, 0.987654);
  ASSERT_EQ(base->fields.size(), 2u);
  EXPECT_EQ(base->fields[0].rms, 0.0125);
  EXPECT_EQ(base->fields[1].rms, 1e-7);
  EXPECT_EQ(base->fields[1].max, 2.5);
  EXPECT_FALSE(read->levels[1].error) << "an error that nobody measured";
  EXPECT_TRUE(read->levels[2].error);
  EXPECT_EQ(manifestToJson(*read), manifestToJson(sample()));
}

TEST(LevelError, isWrittenAsTheFormatSays) {
  EXPECT_EQ(sampleJson()["levels"][0]["error"], Json::parse(R"({"boundary": {"toLevel": {"mean": 0.001234, "max": 0.02},
    "toOriginal": {"mean": 0.001, "max": 0.03}}, "volumeKept": 0.987654, "fields": [{"rms": 0.0125, "max": 0.3}, {"rms": 1e-7, "max": 2.5}]})"));
  EXPECT_FALSE(sampleJson()["levels"][1].contains("error"));
}

TEST(LevelError, aManifestWithoutFieldsHasNoneHere) {
  Manifest m = sample();
  m.fields.clear();
  m.levels = {{0, 1, 4, 4, 0, LevelError{}}};
  const Result<Manifest> read = manifestFromJson(manifestToJson(m));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->levels[0].error->fields.empty());
}

TEST(LevelError, everyMemberIsRequired) {
  for (const char* member : {"/boundary", "/volumeKept", "/fields", "/boundary/toLevel", "/boundary/toOriginal", "/boundary/toLevel/mean",
                             "/boundary/toOriginal/max", "/fields/1/rms", "/fields/0/max"}) {
    Json json = sampleJson();
    const Json::json_pointer pointer("/levels/0/error" + std::string(member));
    if (json.at(pointer.parent_pointer()).is_object()) json.at(pointer.parent_pointer()).erase(pointer.back());
    const Result<Manifest> read = manifestFromJson(json.dump());
    ASSERT_FALSE(read) << member;
    EXPECT_NE(read.error().message.find("/levels/0/error" + std::string(member) + " is missing"), std::string::npos)
        << read.error().message;
  }
}

TEST(LevelError, valuesOfTheWrongKindOrRangeAreRefusedWithTheirPlace) {
  expectRefused("", 0.5, "");
  expectRefused("", nullptr, "");
  expectRefused("/boundary", Json::array(), "/boundary");
  expectRefused("/boundary/toLevel/max", "0.1", "/boundary/toLevel/max");
  expectRefused("/boundary/toLevel/max", -0.1, "/boundary/toLevel/max");
  expectRefused("/boundary/toOriginal/mean", -1e-9, "/boundary/toOriginal/mean");
  expectRefused("/boundary/toOriginal/mean", 0.04, "/boundary/toOriginal/mean is above");
  expectRefused("/volumeKept", -0.5, "/volumeKept");
  expectRefused("/volumeKept", nullptr, "/volumeKept");
  expectRefused("/fields", Json::array(), "/fields");
  expectRefused("/fields/0", 1, "/fields/0");
  expectRefused("/fields/1/rms", 2.6, "/fields/1/rms is above");
  expectRefused("/fields/1/max", true, "/fields/1/max");
  expectRefused("/fields", Json::parse(R"([{"rms":0,"max":0},{"rms":0,"max":0},{"rms":0,"max":0}])"), "/fields");
}

TEST(LevelError, aVolumeMayGrow) {
  Json json = sampleJson();
  json["levels"][0]["error"]["volumeKept"] = 1.0001;
  EXPECT_TRUE(manifestFromJson(json.dump()));
}

}  // namespace
}  // namespace qtet
