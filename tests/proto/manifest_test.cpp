#include "proto/manifest.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/sample_manifest.h"

namespace qtet {
namespace {

using Json = nlohmann::json;

Manifest sample() {
  Manifest m = testing::manifestWithoutLevels();
  m.fields.push_back({"velocity", 3, "float64", "point", 14, 1.0 / 3, {-1, -2, -3}, {0, 7}});
  m.levels = {{0, 100, 40, 60, 0}, {1, 105, 42, 62, 0}, {2, 230, 80, 90, 3}};
  return m;
}

Json sampleJson() { return Json::parse(manifestToJson(sample())); }

TEST(Manifest, isWrittenAsTheDocumentSays) {
  const Json json = sampleJson();
  EXPECT_EQ(json["generator"], "qtet 0.1.0");
  EXPECT_EQ(json["source"], "comb.vtu");
  EXPECT_EQ(json["lattice"],
            (Json{{"bits", 16}, {"step", 0.1 + 0.2}, {"origin", {-1.5, 1e-17, 3.0}}}));
  ASSERT_EQ(json["fields"].size(), 2u);
  EXPECT_EQ(json["fields"][1], (Json{{"name", "velocity"},
                                     {"components", 3},
                                     {"type", "float64"},
                                     {"association", "point"},
                                     {"bits", 14},
                                     {"step", 1.0 / 3},
                                     {"minimum", {-1.0, -2.0, -3.0}},
                                     {"range", {0.0, 7.0}}}));
  ASSERT_EQ(json["levels"].size(), 3u);
  EXPECT_EQ(json["levels"][2], (Json{{"level", 2},
                                     {"tetrahedra", 230},
                                     {"vertices", 80},
                                     {"boundaryTriangles", 90},
                                     {"chunk", 3}}));
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

TEST(Manifest, aNameThatIsNotUtf8IsWrittenAsJsonAllTheSame) {
  Manifest m = sample();
  m.source = "caf\xE9.vtu";
  EXPECT_EQ(Json::parse(manifestToJson(m))["source"], "caf\xEF\xBF\xBD.vtu");
}

}  // namespace
}  // namespace qtet
