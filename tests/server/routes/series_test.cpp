// Series of a real log through a real server: values at a point, and levels of one instant.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/server/program/loopback.h"
#include "tests/server/support/json.h"
#include "tests/support/paths/test_paths.h"
#include "tests/support/series_mesh.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

using test::Json;

class SeriesServer : public ::testing::Test {
 protected:
  static Result<MeshStore> openSeries(const std::filesystem::path& folder) {
    testing::writeLog(folder / "run.qtet", testing::seriesMesh(4, 3, 5));
    return MeshStore::open(folder);
  }
  [[nodiscard]] std::string series(const std::string& query) const {
    return "/v1/logs/" + mesh_->log.digest() + "/series?" + query;
  }
  [[nodiscard]] LatticeMesh finest() const {
    return meshAtLevel(mesh_->log, mesh_->manifest.levels.back().level).value();
  }
  /// A vertex of the last level, as a query for it there.
  [[nodiscard]] std::string vertex() const {
    const LatticeMesh mesh = finest();
    const auto p = mesh.lattice.position(mesh.points[mesh.tetrahedra[3][1]]);
    return "x=" + std::to_string(p[0]) + "&y=" + std::to_string(p[1]) +
           "&z=" + std::to_string(p[2]) +
           "&level=" + std::to_string(mesh_->manifest.levels.back().level) + "&";
  }

  const std::filesystem::path folder_ = testing::freshFolder("series-server");
  Result<MeshStore> store_ = openSeries(folder_);
  MeshPointer mesh_ = store_->find("run");
  ViewerFiles viewer_;
};

TEST_F(SeriesServer, theValuesAtAVertexAreThoseOfTheLevelsMesh) {
  test::RunningServer server(*store_, viewer_);
  test::RawClient client(server.port());
  const LatticeMesh mesh = finest();
  const VertexId v = mesh.tetrahedra[3][1];
  const auto answer = client.get(series(vertex() + "field=T"));
  ASSERT_EQ(answer.status, 200u) << answer.body;
  EXPECT_EQ(answer.header("content-type"), "application/json");
  const Json json = Json::parse(answer.body);
  ASSERT_EQ(json["values"].size(), 5u);
  for (std::size_t f = 0; f < 5; ++f) {
    const auto instant = static_cast<std::size_t>(2 * mesh.fields[f].name.instant()->time);
    EXPECT_NEAR(json["values"][instant][0].number(), mesh.fields[f].value(0, mesh.values[f][v]),
                1e-3);
  }
  const auto csv = client.get(series(vertex() + "field=C&format=csv"));
  ASSERT_EQ(csv.status, 200u) << csv.body;
  EXPECT_TRUE(csv.body.starts_with("time,C_0,C_1\r\n0,")) << csv.body;
}

TEST_F(SeriesServer, theNameLeadsToTheDigestsAddress) {
  test::RunningServer server(*store_, viewer_);
  test::RawClient client(server.port());
  const auto answer = client.get("/v1/meshes/run/series?" + vertex() + "field=T");
  EXPECT_EQ(answer.status, 307u);
  EXPECT_EQ(answer.header("location"), series(vertex() + "field=T"));
}

TEST_F(SeriesServer, whoHasItIsToldSoAndHeadMakesNothing) {
  test::RunningServer server(*store_, viewer_);
  test::RawClient client(server.port());
  const std::string target = series(vertex() + "field=T");
  ASSERT_TRUE(client.send("HEAD " + target + " HTTP/1.1\r\nHost: x\r\n\r\n"));
  const auto head = client.receive(true);
  EXPECT_EQ(head.status, 200u);
  EXPECT_TRUE(server.comesTo("levels_made_total", 0));
  const auto answer = client.get(target);
  EXPECT_EQ(answer.header("etag"), head.header("etag"));
  EXPECT_NE(answer.header("cache-control").find("immutable"), std::string::npos);
  EXPECT_TRUE(server.comesTo("levels_made_total", 1));
  const auto again = client.get(target, "If-None-Match: " + answer.header("etag") + "\r\n");
  EXPECT_EQ(again.status, 304u);
  const auto part = client.get(target, "Range: bytes=1-7\r\n");
  EXPECT_EQ(part.status, 206u);
  EXPECT_EQ(part.body, "\"field\"");
}

TEST_F(SeriesServer, aPointOutsideIsNotFoundAndNoFailure) {
  test::RunningServer server(*store_, viewer_);
  test::RawClient client(server.port());
  const auto answer = client.get(series("x=1e300&y=-1e300&z=0&field=T"));
  EXPECT_EQ(answer.status, 404u);
  EXPECT_EQ(answer.header("content-type"), "application/problem+json");
  EXPECT_NE(answer.body.find("lies in no cell of level"), std::string::npos) << answer.body;
  EXPECT_NE(answer.body.find("whose box is from"), std::string::npos) << answer.body;
  EXPECT_EQ(client.get(series("x=1e300&y=-1e300&z=0&field=T")).body, answer.body);
  EXPECT_TRUE(server.comesTo("levels_failed_total", 0));
  EXPECT_TRUE(server.comesTo("levels_made_total", 1));
  EXPECT_TRUE(server.comesTo("levels_found_total", 1)) << "the answer is kept";
}

TEST_F(SeriesServer, aLevelOfOneTimeIsTheFileThatExtractWrites) {
  test::RunningServer server(*store_, viewer_);
  test::RawClient client(server.port());
  for (const std::string ending : {".vtu", ".vtk", ".glb"})
    for (const std::string time : {"0", "0.5", "2", "first", "last"}) {
      const std::filesystem::path file = folder_ / ("level" + ending);
      const std::string command = std::string(testing::kTool) + " extract '" +
                                  (folder_ / "run.qtet").string() + "' -q --level 1 --time " +
                                  time + " -o '" + file.string() + "'";
      ASSERT_EQ(std::system(command.c_str()), 0) << command;
      std::ifstream in(file, std::ios::binary);
      const std::string expected{std::istreambuf_iterator<char>(in), {}};
      const auto level =
          client.get("/v1/logs/" + mesh_->log.digest() + "/levels/1" + ending + "?time=" + time);
      ASSERT_EQ(level.status, 200u) << level.body;
      EXPECT_TRUE(level.body == expected) << ending << " at " << time;
    }
}

}  // namespace
}  // namespace qtet
