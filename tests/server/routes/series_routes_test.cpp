// Addresses of series: which fields and level they mean, and what is refused.
#include "server/routes/series_routes.h"

#include <gtest/gtest.h>

#include "tests/server/store/synthetic_log.h"

namespace qtet {
namespace {

/// A log of noise with a series T and plain fields; its levels halve their errors.
class SeriesRoutes : public ::testing::Test {
 protected:
  explicit SeriesRoutes(bool errors = true) {
    folder_.write("run.qtet",
                  test::makeLog({.fields = {"T@2", "velocity", "T@0", "T@1", "p", "u@3", "T@x"},
                                 .errors = errors}));
    mesh_ = openMesh(folder_.path() / "run.qtet", "run").value();
  }
  [[nodiscard]] Answer ask(const std::string& query, const std::string& path = "series") const {
    const std::string target = "/v1/logs/" + mesh_->log.digest() + "/" + path + "?" + query;
    const RequestView request{.method = "GET", .target = target};
    const RequestTarget parsed = *parseTarget(target);
    return path == "series" ? routeSeries(request, parsed, {mesh_, "run"})
                            : routeLevel(request, parsed, {mesh_, "run"}, path.substr(7));
  }
  [[nodiscard]] LevelRequest wanted(const std::string& query,
                                    const std::string& path = "series") const {
    Answer answer = ask(query, path);
    EXPECT_EQ(answer.reply.status, 200u) << query << textOf(answer.reply);
    return std::get<LevelRequest>(answer.work);
  }
  static std::string textOf(const Reply& reply) {
    const auto* text = std::get_if<std::string>(&reply.body);
    return text ? *text : "";
  }
  void expectRefused(unsigned status, const std::string& query, const std::string& says,
                     const std::string& path = "series") const {
    const Answer answer = ask(query, path);
    EXPECT_EQ(answer.reply.status, status) << query;
    EXPECT_NE(textOf(answer.reply).find(says), std::string::npos)
        << query << " is refused with " << textOf(answer.reply);
  }

  test::TempFolder folder_;
  MeshPointer mesh_;
};

class SeriesRoutesWithoutErrors : public SeriesRoutes {
 protected:
  SeriesRoutesWithoutErrors() : SeriesRoutes(false) {}
};

const std::string kPoint = "x=1.5&y=-2e3&z=0&";
using Numbers = std::vector<std::uint32_t>;

TEST_F(SeriesRoutes, aSeriesIsAllItsInstants) {
  const LevelRequest series = wanted(kPoint + "field=T");
  EXPECT_EQ(series.fields, (Numbers{0, 2, 3}));
  EXPECT_EQ(series.point, (std::array<double, 3>{1.5, -2000, 0}));
  EXPECT_EQ(series.form, LevelForm::kJson);
  EXPECT_EQ(wanted(kPoint + "field=point:T").fields, (Numbers{0, 2, 3}));
  EXPECT_EQ(wanted(kPoint + "field=T@1").fields, (Numbers{3})) << "the instant of that name";
  EXPECT_EQ(wanted(kPoint + "field=p").fields, (Numbers{4}));
  EXPECT_EQ(wanted(kPoint + "field=u").fields, (Numbers{5})) << "an instant alone";
  EXPECT_EQ(wanted(kPoint + "field=p&format=csv").form, LevelForm::kCsv);
}

TEST_F(SeriesRoutes, theLevelIsTheCoarsestWithinTheErrorOfEveryInstant) {
  const std::vector<ManifestLevel>& levels = mesh_->manifest.levels;
  const auto worst = [&](std::uint32_t level) {
    double out = 0;
    for (const std::uint32_t f : {0u, 2u, 3u})
      out = std::max<double>(out, levels[level].error->fields[f].rms);
    return out;
  };
  const auto levelOf = [&](double bound) {
    return wanted(kPoint + "field=T&error=" + std::to_string(bound)).level;
  };
  ASSERT_GT(worst(4), worst(5));
  EXPECT_EQ(levelOf(worst(4) * 1.01), 4u);
  EXPECT_EQ(levelOf(worst(4) * 0.99), 5u);
  EXPECT_EQ(levelOf(0), levels.back().level);
  const std::uint32_t byDefault = wanted(kPoint + "field=T").level;
  EXPECT_LE(worst(byDefault), kDefaultSeriesError);
  EXPECT_GT(worst(byDefault - 1), kDefaultSeriesError);
}

TEST_F(SeriesRoutesWithoutErrors, theLevelIsTheFinest) {
  EXPECT_EQ(wanted(kPoint + "field=T").level, mesh_->manifest.levels.back().level);
  EXPECT_EQ(wanted(kPoint + "field=T&error=0.5").level, mesh_->manifest.levels.back().level);
}

TEST_F(SeriesRoutes, aLevelIsNamedUpToTheLast) {
  EXPECT_EQ(wanted(kPoint + "field=T&level=0").level, 0u);
  EXPECT_EQ(wanted(kPoint + "field=T&level=11").level, 11u);
  expectRefused(404, kPoint + "field=T&level=12", "there is no level 12; this mesh has the levels");
  for (const char* level : {"00", "01"})
    expectRefused(404, kPoint + "field=T&level=" + level, "there is no level");
  for (const char* level : {"", "-1", "x", "1.5", "4294967296"})
    expectRefused(400, kPoint + "field=T&level=" + level, "give a whole number");
}

TEST_F(SeriesRoutes, parametersWithoutSenseAreRefused) {
  for (const char* x : {"", "x", "nan", "-nan", "inf", "Infinity", "-inf", "1e999", "1,5", "0x1"})
    expectRefused(400, "y=0&z=0&field=T&x=" + std::string(x), "x is '" + std::string(x) + "'");
  expectRefused(400, "x=0&z=0&field=T", "y is missing");
  expectRefused(400, "x=0&y=0&field=T", "z is missing");
  expectRefused(400, kPoint, "field is missing");
  expectRefused(404, kPoint + "field=none", "no series and no field 'none'");
  expectRefused(404, kPoint + "field=", "no series and no field ''");
  expectRefused(404, kPoint + "field=cell:T", "no series and no field");
  expectRefused(400, kPoint + "field=T&level=1&error=0.1", "level and error exclude each other");
  for (const char* error : {"", "-0.1", "nan", "inf", "T:0.1"})
    expectRefused(400, kPoint + "field=T&error=" + error, "from 0 on");
  expectRefused(400, kPoint + "field=T&format=xml", "give json or csv");
}

TEST_F(SeriesRoutes, anAnswerMayBeKeptForEverUnderItsTag) {
  const Answer answer = ask(kPoint + "field=T");
  EXPECT_EQ(answer.reply.header("Content-Type"), "application/json");
  EXPECT_NE(answer.reply.header("Cache-Control").find("immutable"), std::string::npos);
  EXPECT_EQ(answer.reply.header("Content-Disposition"), "inline; filename=\"run-series.json\"");
  const Answer csv = ask(kPoint + "field=T&format=csv");
  EXPECT_EQ(csv.reply.header("Content-Type"), "text/csv");
  EXPECT_EQ(csv.reply.header("Content-Disposition"), "attachment; filename=\"run-series.csv\"");
  EXPECT_NE(csv.reply.header("ETag"), answer.reply.header("ETag"));
}

TEST_F(SeriesRoutes, aLevelHasTheInstantsOfOneTimeUnderTheirSeriesNames) {
  const LevelRequest level = wanted("time=1", "levels/3.vtu");
  EXPECT_EQ(level.fields, (Numbers{1, 3, 4, 5, 6}));
  EXPECT_EQ(level.names, (std::vector<std::string>{"velocity", "T", "p", "u@3", "T@x"}));
  EXPECT_EQ(wanted("time=1.0000000001&fields=T", "levels/3.vtu").fields, (Numbers{3}));
  EXPECT_EQ(wanted("time=first&fields=T", "levels/3.glb").fields, (Numbers{2}));
  EXPECT_EQ(wanted("time=last&fields=T", "levels/3.glb").fields, (Numbers{0}));
  EXPECT_EQ(wanted("fields=T", "levels/3.vtu").fields, (Numbers{0, 2, 3}));
  EXPECT_EQ(wanted("time=first&fields=p", "levels/3.vtu").names, (std::vector<std::string>{"p"}));
  EXPECT_NE(level.key(), wanted("fields=velocity,T@1,p,u@3,T@x", "levels/3.vtu").key());
}

TEST_F(SeriesRoutes, aTimeThatIsNotThereIsRefused) {
  expectRefused(404, "time=1.5", "no instant 1.5; they have 0, 1, 2; give time one of them",
                "levels/3.vtu");
  expectRefused(404, "time=1&fields=p", "none of them is a series", "levels/3.vtu");
  for (const char* time : {"", "all", "0:1", "nan", "inf", "x"})
    expectRefused(400, "time=" + std::string(time), "time is a number", "levels/3.vtu");
}

TEST_F(SeriesRoutes, aSeriesIsNoLevelsForm) {
  expectRefused(404, "", "a level is to be had as", "levels/3.json");
  expectRefused(404, "", "a level is to be had as", "levels/3.csv");
}

}  // namespace
}  // namespace qtet
