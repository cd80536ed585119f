#include "proto/manifest.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "proto/limits.h"

namespace qtet {
namespace {

using Json = nlohmann::json;

Manifest sample() {
  Manifest m;
  m.generator = "qtet 0.1.0";
  m.source = "comb.vtu";
  m.latticeBits = 16;
  m.latticeStep = 0.1 + 0.2;
  m.latticeOrigin = {-1.5, 1e-17, 3};
  m.fields.push_back({"density", 1, "float32", "point", 12, 0.00025, {0.1}, {0.1, 0.9}});
  m.fields.push_back({"velocity", 3, "float64", "point", 14, 1.0 / 3, {-1, -2, -3}, {0, 7}});
  m.levels = {{0, 100, 40, 60, 0}, {1, 105, 42, 62, 0}, {2, 230, 80, 90, 3}};
  return m;
}

Json sampleJson() { return Json::parse(manifestToJson(sample())); }

void expectRefused(const Json& json, const std::string& pointer, ErrorCode code = ErrorCode::kBadValue) {
  const Result<Manifest> result = manifestFromJson(json.dump());
  ASSERT_FALSE(result) << "accepted: " << json.dump();
  EXPECT_EQ(result.error().code, code);
  EXPECT_NE(result.error().message.find(pointer), std::string::npos) << result.error().message;
}

TEST(Manifest, whatWasWrittenIsReadBackToTheBit) {
  const Manifest a = sample();
  const Result<Manifest> read = manifestFromJson(manifestToJson(a));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->generator, a.generator);
  EXPECT_EQ(read->layout, "stream");
  EXPECT_EQ(read->source, a.source);
  EXPECT_EQ(read->latticeBits, a.latticeBits);
  EXPECT_EQ(read->latticeStep, a.latticeStep);
  EXPECT_EQ(read->latticeOrigin, a.latticeOrigin);
  ASSERT_EQ(read->fields.size(), 2u);
  EXPECT_EQ(read->fields[1].name, "velocity");
  EXPECT_EQ(read->fields[1].step, a.fields[1].step);
  EXPECT_EQ(read->fields[1].minimum, a.fields[1].minimum);
  EXPECT_EQ(read->fields[1].range, a.fields[1].range);
  ASSERT_EQ(read->levels.size(), 3u);
  EXPECT_EQ(read->levels[2].tetrahedra, 230u);
  EXPECT_EQ(read->levels[2].chunk, 3u);
  EXPECT_EQ(manifestToJson(*read), manifestToJson(a));
}

TEST(Manifest, everyMemberIsMissedByItsName) {
  for (const char* member : {"generator", "layout", "source", "lattice", "fields", "levels"}) {
    Json json = sampleJson();
    json.erase(member);
    expectRefused(json, std::string("/") + member + " is missing");
  }
  for (const char* member : {"name", "components", "type", "association", "bits", "step", "minimum", "range"}) {
    Json json = sampleJson();
    json["fields"][1].erase(member);
    expectRefused(json, std::string("/fields/1/") + member + " is missing");
  }
  for (const char* member : {"level", "tetrahedra", "vertices", "boundaryTriangles", "chunk"}) {
    Json json = sampleJson();
    json["levels"][2].erase(member);
    expectRefused(json, std::string("/levels/2/") + member + " is missing");
  }
}

TEST(Manifest, valuesOutsideTheirRangeAreRefusedWithTheirPlace) {
  const std::vector<std::pair<std::string, Json>> wrong = {{"/layout", "spiral"},
                                                           {"/lattice/bits", 29},
                                                           {"/lattice/bits", 3},
                                                           {"/lattice/bits", -16},
                                                           {"/lattice/bits", 16.5},
                                                           {"/lattice/step", 0},
                                                           {"/lattice/step", -1},
                                                           {"/lattice/step", "1"},
                                                           {"/lattice/origin", {1, 2}},
                                                           {"/lattice/origin/1", nullptr},
                                                           {"/fields/0/components", 0},
                                                           {"/fields/0/components", 17},
                                                           {"/fields/0/name", ""},
                                                           {"/fields/0/bits", 0},
                                                           {"/fields/0/bits", 29},
                                                           {"/fields/0/minimum", {1, 2}},
                                                           {"/fields/1/minimum", {1, 2}},
                                                           {"/fields/0/type", "complex"},
                                                           {"/fields/0/association", "edge"},
                                                           {"/fields/0/range", {1}},
                                                           {"/fields/1/name", "density"},
                                                           {"/levels", Json::array()},
                                                           {"/levels/1/level", 2},
                                                           {"/levels/2/tetrahedra", kMaxElements + 1ull},
                                                           {"/levels/2/chunk", kMaxChunks},
                                                           {"/fields", Json::object()},
                                                           {"/levels/0", 7}};
  for (const auto& [pointer, value] : wrong) {
    Json json = sampleJson();
    json[Json::json_pointer(pointer)] = value;
    expectRefused(json, pointer);
  }
}

TEST(Manifest, limitsThemselvesAreAllowed) {
  Json json = sampleJson();
  json["lattice"]["bits"] = kMaxPositionBits;
  json["fields"][0]["bits"] = kMaxFieldBits;
  json["levels"][2]["tetrahedra"] = kMaxElements;
  json["levels"][2]["chunk"] = kMaxChunks - 1;
  json["fields"][0]["name"] = std::string(kMaxNameBytes, 'n');
  EXPECT_TRUE(manifestFromJson(json.dump()));
  json["fields"][0]["name"] = std::string(kMaxNameBytes + 1, 'n');
  expectRefused(json, "/fields/0/name");
}

TEST(Manifest, aPointFieldAndACellFieldMayShareAName) {
  Json json = sampleJson();
  json["fields"][1]["name"] = "density";
  expectRefused(json, "/fields/1/name");
  json["fields"][1]["association"] = "cell";
  const Result<Manifest> read = manifestFromJson(json.dump());
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(fieldKey(*read, 0), "density");
  EXPECT_EQ(fieldKey(*read, 1), "cell:density");
  json["fields"][1]["association"] = "corner";
  expectRefused(json, "/fields/1/association");
}

TEST(Manifest, aFieldIsFoundByItsKey) {
  Manifest m = sample();
  m.fields[0].association = "cell";
  m.fields.push_back(m.fields[0]);
  m.fields[2].association = "point";
  EXPECT_EQ(fieldOfKey(m, "density"), 2u);
  EXPECT_EQ(fieldOfKey(m, "point:density"), 2u);
  EXPECT_EQ(fieldOfKey(m, "cell:density"), 0u);
  EXPECT_EQ(fieldOfKey(m, "velocity"), 1u);
  EXPECT_EQ(fieldOfKey(m, "cell:velocity"), std::nullopt);
  EXPECT_EQ(fieldOfKey(m, "cell:"), std::nullopt);
  EXPECT_EQ(fieldOfKey(m, ""), std::nullopt);
  m.fields.pop_back();
  EXPECT_EQ(fieldOfKey(m, "density"), 0u);
  for (std::uint32_t f = 0; f < m.fields.size(); ++f) EXPECT_EQ(fieldOfKey(m, fieldKey(m, f)), f);
}

TEST(Manifest, aLevelThatEndsBeforeTheOneBelowItIsRefused) {
  Json json = sampleJson();
  json["levels"][1]["chunk"] = 4;
  expectRefused(json, "/levels/2/chunk");
}

TEST(Manifest, unknownMembersAreLeftToLaterVersions) {
  Json json = sampleJson();
  json["errors"] = {{"rms", 0.1}};
  json["levels"][0]["rms"] = 0.2;
  EXPECT_TRUE(manifestFromJson(json.dump()));
}

TEST(Manifest, everyTruncationIsRefused) {
  const std::string whole = manifestToJson(sample());
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_FALSE(manifestFromJson(whole.substr(0, n))) << n;
}

TEST(Manifest, whatIsTooLongIsNotEvenParsed) {
  const Result<Manifest> result = manifestFromJson(std::string(kMaxManifestBytes + 1, ' '));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kLimitExceeded);
}

TEST(Manifest, depthDoesNotExhaustTheStack) {
  EXPECT_FALSE(manifestFromJson(std::string(1 << 20, '[')));
  EXPECT_FALSE(manifestFromJson(std::string(1 << 20, '[') + std::string(1 << 20, ']')));
}

TEST(Manifest, aNameThatIsNotUtf8IsWrittenAsJsonAllTheSame) {
  Manifest m = sample();
  m.source = "caf\xE9.vtu";
  EXPECT_TRUE(manifestFromJson(manifestToJson(m)));
}

}  // namespace
}  // namespace qtet
