// The values of a series at a point are those of the level's mesh there.
#include "server/store/series_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "codec/files/vtu_writer.h"
#include "server/store/level_maker.h"
#include "tests/server/support/json.h"
#include "tests/support/paths/test_paths.h"
#include "tests/support/series_mesh.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

using test::Json;

class SeriesTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kInstants = 9;

  static LatticeMesh mesh() {
    LatticeMesh out = testing::seriesMesh(4, 3, kInstants);
    out.fields.push_back({"p,\"q", 1, "float64", "point", 12, 0.25, {-3}, {-3, 1020}});
    out.values.emplace_back(out.values.front());
    out.fields.push_back({"-x@y", 1, "float64", "point", 12, 0.25, {-1024}, {-1024, -1}});
    out.values.emplace_back(out.values.front());
    return out;
  }
  /// A log whose one field p lacks the value of every seventh point.
  static MeshPointer withMissing() {
    LatticeMesh out = testing::gridMesh(4, 3);
    out.fields.resize(1), out.values.resize(1);
    out.fields[0].name = "p", out.fields[0].hasMissing = true;
    for (std::size_t v = 0; v < out.values[0].size(); v += 7) out.values[0][v] = kMissing;
    const std::filesystem::path folder = testing::freshFolder("series-missing");
    std::ofstream file(folder / "p.vtu", std::ios::binary);
    for (const std::uint8_t byte : vtuBytes(out)) file.put(static_cast<char>(byte));
    file.close();
    const std::string command = std::string(testing::kTool) + " simplify -q '" +
                                (folder / "p.vtu").string() + "' -o '" +
                                (folder / "p.qtet").string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return openMesh(folder / "p.qtet", "p").value();
  }
  static MeshPointer written(const LatticeMesh& mesh) {
    const auto path = testing::freshFolder("series-maker") / "run.qtet";
    testing::writeLog(path, mesh);
    return openMesh(path, "run").value();
  }
  /// Those whose names begin so, ascending.
  [[nodiscard]] std::vector<std::uint32_t> fields(std::string_view begin) const {
    std::vector<std::uint32_t> out;
    for (std::uint32_t f = 0; f < served_->manifest.fields.size(); ++f)
      if (served_->manifest.fields[f].name.text().starts_with(begin)) out.push_back(f);
    return out;
  }
  [[nodiscard]] LevelRequest request(std::string_view begin, std::uint32_t level,
                                     std::array<double, 3> point) const {
    LevelRequest out{served_, level, LevelForm::kJson, fields(begin)};
    out.point = point;
    return out;
  }
  static std::string text(const LevelRequest& request) {
    const Result<Bytes> made = makeLevel(request, {});
    EXPECT_TRUE(made) << made.error().text();
    return made ? std::string(made->begin(), made->end()) : "null";
  }
  /// The middle of a cell of the level.
  static std::array<double, 3> middleOf(const LatticeMesh& mesh, CellId cell) {
    std::array<double, 3> out{};
    for (const VertexId v : mesh.tetrahedra[cell])
      for (std::size_t a = 0; a < 3; ++a) out[a] += mesh.lattice.position(mesh.points[v])[a] / 4;
    return out;
  }
  [[nodiscard]] std::uint32_t last() const { return served_->manifest.levels.back().level; }

  MeshPointer served_ = written(mesh());
};

TEST_F(SeriesTest, pointValuesAreThoseBetweenTheCornersAtEveryLevel) {
  const std::vector<std::uint32_t> wanted = fields("T@");
  ASSERT_EQ(wanted.size(), kInstants);
  for (std::uint32_t level = 0; level <= last(); level += 3) {
    const LatticeMesh mesh = meshAtLevel(served_->log, level, wanted).value();
    const CellId cell = static_cast<CellId>(mesh.tetrahedra.size() / 2);
    const Json json = Json::parse(text(request("T@", level, middleOf(mesh, cell))));
    EXPECT_EQ(json["field"], "T");
    EXPECT_EQ(json["association"], "point");
    EXPECT_EQ(json["components"], 1);
    EXPECT_EQ(json["level"], level);
    EXPECT_EQ(json["tetrahedron"], cell);
    ASSERT_EQ(json["times"].size(), kInstants);
    ASSERT_EQ(json["values"].size(), kInstants);
    for (std::size_t i = 0; i < kInstants; ++i) {
      EXPECT_EQ(json["times"][i].number(), 0.5 * static_cast<double>(i));
      const auto field = std::ranges::find_if(mesh.fields, [&](const FieldInfo& info) {
        return info.name.instant()->time == 0.5 * static_cast<double>(i);
      });
      const auto& integers = mesh.values[static_cast<std::size_t>(field - mesh.fields.begin())];
      double expected = 0;
      for (const VertexId v : mesh.tetrahedra[cell]) expected += field->value(0, integers[v]) / 4;
      EXPECT_NEAR(json["values"][i][0].number(), expected, 1e-4);
    }
  }
}

TEST_F(SeriesTest, cellValuesAreThoseOfTheCell) {
  const LatticeMesh mesh = meshAtLevel(served_->log, last(), fields("C@")).value();
  const Json json = Json::parse(text(request("C@", last(), middleOf(mesh, 11))));
  EXPECT_EQ(json["association"], "cell");
  EXPECT_EQ(json["components"], 2);
  ASSERT_EQ(json["values"].size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_EQ(json["values"][i][c].number(), mesh.fields[0].value(c, mesh.values[0][22 + c]));
}

TEST_F(SeriesTest, csvHasARowForEachInstant) {
  const LatticeMesh mesh = meshAtLevel(served_->log, 0, fields("C@")).value();
  LevelRequest wanted = request("C@", 0, middleOf(mesh, 0));
  const Json values = Json::parse(text(wanted))["values"];
  wanted.form = LevelForm::kCsv;
  const std::string csv = text(wanted);
  EXPECT_TRUE(csv.starts_with("time,C_0,C_1\r\n0,")) << csv;
  EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
  EXPECT_TRUE(csv.ends_with("\r\n"));
}

TEST_F(SeriesTest, aFieldWithoutTimeHasOneValue) {
  const LatticeMesh mesh = meshAtLevel(served_->log, last(), fields("p")).value();
  LevelRequest wanted = request("p", last(), middleOf(mesh, 5));
  const Json json = Json::parse(text(wanted));
  EXPECT_EQ(json["field"], "p,\"q");
  EXPECT_TRUE(json["times"].isNull());
  ASSERT_EQ(json["values"].size(), 1u);
  EXPECT_FALSE(json["values"][0][0].isNull());
  wanted.form = LevelForm::kCsv;
  EXPECT_TRUE(text(wanted).starts_with("time,\"p,\"\"q\"\r\n,")) << text(wanted);
}

TEST_F(SeriesTest, noNameIsAFormulaAndNumbersAreNumbers) {
  const LatticeMesh mesh = meshAtLevel(served_->log, last(), fields("-x")).value();
  LevelRequest wanted = request("-x", last(), middleOf(mesh, 5));
  wanted.form = LevelForm::kCsv;
  EXPECT_TRUE(text(wanted).starts_with("time,\"'-x@y\"\r\n,-")) << text(wanted);
}

TEST_F(SeriesTest, aValueIsMissingWhereThatOfACornerIsThatCounts) {
  served_ = withMissing();
  const LatticeMesh mesh = meshAtLevel(served_->log, last()).value();
  const auto isMissing = [&](VertexId v) { return mesh.values[0][v] == kMissing; };
  int mixed = 0;
  for (CellId cell = 0; cell < mesh.tetrahedra.size(); cell += 10) {
    const Tetrahedron& corners = mesh.tetrahedra[cell];
    const auto missing = std::ranges::count_if(corners, isMissing);
    LevelRequest wanted = request("p", last(), middleOf(mesh, cell));
    EXPECT_EQ(Json::parse(text(wanted))["values"][0][0].isNull(), missing > 0) << cell;
    wanted.form = LevelForm::kCsv;
    EXPECT_EQ(text(wanted) == "time,p\r\n,\r\n", missing > 0) << cell;
    if (missing == 0 || missing == 4) continue;
    ++mixed;
    for (const VertexId v : corners) {
      wanted = request("p", last(), mesh.lattice.position(mesh.points[v]));
      EXPECT_EQ(Json::parse(text(wanted))["values"][0][0].isNull(), isMissing(v)) << v;
    }
  }
  EXPECT_GT(mixed, 0);
}

TEST_F(SeriesTest, aPointOutsideIsNotFoundAndTheBoxIsNamed) {
  const Result<Bytes> made = makeLevel(request("T@", 0, {1e9, 0.5, -2}), {});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kNotFound);
  EXPECT_TRUE(made.error().message.starts_with(
      "the point (1e+09, 0.5, -2) lies in no cell of level 0, whose box is from ("))
      << made.error().message;
}

TEST_F(SeriesTest, pointsAfterTheFirstHaveTheSameValues) {
  const LatticeMesh mesh = meshAtLevel(served_->log, last()).value();
  // A series of points, a field without time, a series of cells; both ways of decoding in turns.
  for (const std::uint64_t kept :
       {std::uint64_t{0}, std::uint64_t{3000}, limits::kKeptValueBytes}) {
    SeriesMaker series(kept);
    for (const std::uint32_t level : {last(), last() / 2})
      for (const std::string_view field : {"T@", "p", "C@", "T@"})
        for (const CellId cell : {0u, 5u, 1'000'000u}) {
          const auto point =
              cell < mesh.tetrahedra.size() ? middleOf(mesh, cell) : std::array{1e9, 0.0, 0.0};
          LevelRequest wanted = request(field, level, point);
          const Result<Bytes> fresh = makeLevel(wanted, {}), next = series.make(wanted, {});
          ASSERT_EQ(next.has_value(), fresh.has_value()) << field << kept;
          if (fresh) EXPECT_EQ(*next, *fresh) << field << kept;
          if (!fresh) EXPECT_EQ(next.error().text(), fresh.error().text());
        }
    std::stop_source stop;
    stop.request_stop();
    series.forget();
    EXPECT_FALSE(series.make(request("T@", last(), middleOf(mesh, 0)), stop.get_token()));
    EXPECT_TRUE(series.make(request("T@", last(), middleOf(mesh, 0)), {}));
  }
}

TEST_F(SeriesTest, whoStopsGetsNothing) {
  std::stop_source stop;
  stop.request_stop();
  const Result<Bytes> made = makeLevel(request("T@", 0, {0, 0, 0}), stop.get_token());
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kIo);
}

TEST_F(SeriesTest, everyPartOfARequestIsInItsKey) {
  const LevelRequest one = request("T@", 1, {1, 2, 3});
  LevelRequest other = request("T@", 1, {1, 2, 4});
  EXPECT_NE(one.key(), other.key());
  other = one, other.form = LevelForm::kCsv;
  EXPECT_NE(one.key(), other.key());
  other = one, other.names = {"a", "b"};
  LevelRequest third = one;
  third.names = {"a 1:b"};
  EXPECT_NE(other.key(), third.key());
  EXPECT_EQ(one.key(), request("T@", 1, {1, 2, 3}).key());
}

}  // namespace
}  // namespace qtet
