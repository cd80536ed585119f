#include "simplify/read/parts/own_points.h"

#include <gtest/gtest.h>

#include "simplify/clean/clean_mesh.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/check_mesh.h"
#include "simplify/read/read_mesh.h"
#include "simplify/samples/samples.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

/// The box of samples, each cell with four points of its own, and a field f(place, cell).
template <class Value>
TetMesh apartBox(const Value& value) {
  const TetMesh box = boxSample();
  TetMesh out;
  out.pointType = "float64";
  MeshField u{"u", 1, "float64", {}, "point"};
  for (const Tetrahedron& cell : box.tetrahedra) {
    const auto first = static_cast<VertexId>(out.points.size());
    for (const VertexId v : cell) {
      u.values.push_back(value(box.points[v], out.tetrahedra.size()));
      out.points.push_back(box.points[v]);
    }
    out.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
  }
  out.fields.push_back(u);
  return out;
}

double smooth(const Position& p, std::size_t /*cell*/) { return p[0] + 2 * p[1] + 3 * p[2]; }

std::filesystem::path vtuOf(const TetMesh& mesh) {
  const Bytes file = vtuBytes(mesh);
  return testing::fileWith("own.vtu", std::string(file.begin(), file.end()));
}

ReadMesh readOf(const TetMesh& mesh, const ReadOptions& options = {}) {
  Result<ReadMesh> read = readMesh(vtuOf(mesh), options);
  EXPECT_TRUE(read) << read.error().text();
  return read ? std::move(*read) : ReadMesh{};
}

TEST(OwnPoints, cellsThatAgreeAtTheirPointsAreJoined) {
  const ReadMesh read = readOf(apartBox(smooth));
  EXPECT_EQ(read.mesh.points.size(), boxSample().points.size());
  EXPECT_TRUE(read.report.warnings.empty());
  ASSERT_EQ(read.report.notes.size(), 1u);
  EXPECT_NE(read.report.notes[0].find("have points of their own"), std::string::npos);
  const CheckReport checked = checkMesh(vtuOf(apartBox(smooth)), {});
  EXPECT_EQ(checked.components, 1u);
  for (std::size_t v = 0; v < read.mesh.points.size(); ++v)
    EXPECT_DOUBLE_EQ(read.mesh.fields[0].values[v], smooth(read.mesh.points[v], 0));
}

TEST(OwnPoints, coordinatesThatRoundingMovedApartAreOne) {
  TetMesh mesh = apartBox(smooth);
  for (std::size_t v = 0; v < mesh.points.size(); v += 3) mesh.points[v][0] *= 1 + 1e-15;
  EXPECT_EQ(readOf(mesh).mesh.points.size(), boxSample().points.size());
}

TEST(OwnPoints, aDiscontinuousFieldKeepsThemApartWithAWarning) {
  const TetMesh mesh =
      apartBox([](const Position&, std::size_t cell) { return static_cast<double>(cell); });
  const ReadMesh read = readOf(mesh);
  EXPECT_EQ(read.mesh.points.size(), mesh.points.size());
  ASSERT_EQ(read.report.warnings.size(), 1u);
  EXPECT_NE(read.report.warnings[0].find("`weld` 0 joins the points"), std::string::npos);
  ReadOptions welded;
  welded.weld = 0;
  EXPECT_TRUE(readOf(mesh, welded).report.warnings.empty());
  ReadOptions apart;
  apart.joinPieces = false;
  EXPECT_EQ(readOf(apartBox(smooth), apart).report.warnings.size(), 1u);
}

TEST(OwnPoints, pointsAtAJumpStayApart) {
  // one cell of many has other values
  const TetMesh mesh = apartBox(
      [](const Position& p, std::size_t cell) { return cell == 0 ? 1e3 : smooth(p, cell); });
  const OwnPoints own = [&] {
    CellMesh cells;
    cells.points = mesh.points;
    cells.fields = mesh.fields;
    for (const Tetrahedron& cell : mesh.tetrahedra) cells.addCell(kTetrahedronCell, cell);
    return joinOwnPoints(cells, OwnJoin::kByValues);
  }();
  EXPECT_GT(own.differing, 0u);
  EXPECT_EQ(readOf(mesh).mesh.points.size(), boxSample().points.size() + 4);
}

TEST(OwnPoints, allReadingsOfASeriesMakeOneMesh) {
  const TetMesh agreeing = apartBox(smooth),
                differing =
                    apartBox([](const Position&, std::size_t c) { return static_cast<double>(c); });
  ReadOptions options;
  options.joinsOwnPoints = true;
  EXPECT_EQ(readOf(differing, options).mesh.points.size(), boxSample().points.size());
  options.joinsOwnPoints = false;
  EXPECT_EQ(readOf(agreeing, options).mesh.points.size(), agreeing.points.size());
  EXPECT_EQ(readOf(agreeing).report.ownPointsJoined, true);
  EXPECT_EQ(readOf(differing).report.ownPointsJoined, false);
  EXPECT_EQ(readOf(boxSample()).report.ownPointsJoined, std::nullopt);
  // points at a jump are joined in a series, too
  const TetMesh jump = apartBox(
      [](const Position& p, std::size_t cell) { return cell == 0 ? 1e3 : smooth(p, cell); });
  options = {};
  options.namesTime = true;
  EXPECT_EQ(readOf(jump, options).mesh.points.size(), boxSample().points.size());
}

TEST(OwnPoints, aPointOfEachPatchMayLieInAnyOrder) {
  const TetMesh before = apartBox(smooth);
  TetMesh mesh = before;
  const auto count = static_cast<VertexId>(mesh.points.size());
  const auto moved = [&](VertexId v) { return count - 1 - (v + 5) % count; };
  for (VertexId v = 0; v < count; ++v) {
    mesh.points[moved(v)] = before.points[v];
    mesh.fields[0].values[moved(v)] = before.fields[0].values[v];
  }
  for (Tetrahedron& cell : mesh.tetrahedra)
    for (VertexId& v : cell) v = moved(v);
  EXPECT_EQ(readOf(mesh).mesh.points.size(), boxSample().points.size());
}

TEST(OwnPoints, partsThatTouchStayApart) {
  TetMesh mesh = boxSample();
  TetMesh other = boxSample();
  const auto first = static_cast<VertexId>(mesh.points.size());
  double width = 0;
  for (const Position& p : mesh.points) width = std::max(width, p[0]);
  for (Position p : other.points) mesh.points.push_back({p[0] + width, p[1], p[2]});
  for (const Tetrahedron& t : other.tetrahedra)
    mesh.tetrahedra.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  mesh.fields.clear();
  EXPECT_EQ(readOf(mesh).mesh.points.size(), mesh.points.size());
}

}  // namespace
}  // namespace qtet
