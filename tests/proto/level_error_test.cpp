// The known error of a level as JSON.
#include "proto/level_error.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "proto/manifest.h"

namespace qtet {
namespace {

using Json = nlohmann::json;

Manifest withErrors() {
  Manifest m;
  m.latticeBits = 16;
  m.fields.push_back({"density", 1, "float32", "point", 12, 0.00025, {0.1}, {0.1, 0.9}});
  m.fields.push_back({"velocity", 3, "float64", "point", 14, 0.5, {-1, -2, -3}, {0, 7}});
  const LevelError base{
      {0.001234, 0.02}, {0.001, 0.03}, 0.012346, 0.004, {{0.0125, 0.3}, {1e-7, 2.5}}};
  m.levels = {{0, 100, 40, 60, 0, base},
              {1, 105, 42, 62, 0},
              {2, 230, 80, 90, 3, LevelError{{}, {}, 0, 0, {{}, {}}}}};
  return m;
}

Json withErrorsJson() { return Json::parse(manifestToJson(withErrors())); }

TEST(LevelError, theLargerOfBothWaysCounts) {
  const LevelError base = *withErrors().levels[0].error;
  EXPECT_EQ(base.boundaryDistance(), 0.03);
  EXPECT_EQ(base.boundaryMean(), 0.001234);
}

TEST(LevelError, isWrittenAsTheFormatSays) {
  EXPECT_EQ(withErrorsJson()["levels"][0]["error"],
            Json::parse(R"({"boundary": {"toLevel": {"mean": 0.001234, "max": 0.02},
    "toOriginal": {"mean": 0.001, "max": 0.03}}, "volumeLost": 0.012346, "volumeGained": 0.004,
    "fields": [{"rms": 0.0125, "max": 0.3}, {"rms": 1e-7, "max": 2.5}]})"));
  EXPECT_FALSE(withErrorsJson()["levels"][1].contains("error"));
}

}  // namespace
}  // namespace qtet
