#include "simplify/read/check_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simplify/clean/hanging_points.h"
#include "simplify/log/write_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

using testing::fileWith;
using testing::oneCell;
using testing::twoCells;
using Numbers = std::vector<std::uint64_t>;

CheckReport checked(const TetMesh& mesh, const ReadOptions& options = {}) {
  const Bytes bytes = vtuBytes(mesh);
  return checkMesh(fileWith("checked.vtu", {bytes.begin(), bytes.end()}), options);
}

const Finding* finding(const CheckReport& report, const std::string& kind) {
  const auto at = std::ranges::find(report.findings, kind, &Finding::kind);
  return at == report.findings.end() ? nullptr : &*at;
}

void expectFinding(const CheckReport& report, const std::string& kind, Verdict verdict,
                   const Numbers& first) {
  const Finding* found = finding(report, kind);
  ASSERT_TRUE(found) << kind;
  EXPECT_EQ(found->verdict, verdict) << kind;
  EXPECT_EQ(found->found.first, first) << kind;
  EXPECT_EQ(report.refused(), verdict == Verdict::kRefused);
}

TEST(CheckMesh, aFlawlessMeshHasNoFinding) {
  const CheckReport report = checked(boxSample());
  EXPECT_TRUE(report.findings.empty());
  EXPECT_FALSE(report.refused());
  EXPECT_EQ(report.tetrahedra, 3072u);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.fields.size(), 1u);
}

TEST(CheckMesh, whatCleaningRepairsIsLocated) {
  TetMesh mesh = twoCells();
  mesh.points.push_back({9, 9, 9});
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 0, 1, 2}, {3, 2, 1, 0}, {2, 1, 3, 4}};
  const CheckReport report = checked(mesh);
  expectFinding(report, "repeatedVertexCells", Verdict::kRepaired, {1});
  expectFinding(report, "duplicateCells", Verdict::kRepaired, {2});
  expectFinding(report, "reorientedCells", Verdict::kRepaired, {3});
  expectFinding(report, "unusedPoints", Verdict::kRepaired, {5});
}

TEST(CheckMesh, whatStaysIsLocated) {
  TetMesh inverted = twoCells();
  inverted.points[4] = {0.1, 0.1, 0.1};
  expectFinding(checked(inverted), "invertedCells", Verdict::kKept, {1});
  TetMesh flat = twoCells();
  flat.points[4] = {0.25, 0.25, 0.5};
  expectFinding(checked(flat), "flatCells", Verdict::kKept, {1});
  TetMesh nan = twoCells();
  nan.fields = {{"f",
                 2,
                 "float32",
                 {0, 1, 2, 3, 4, std::nan(""), 6, 7, std::numeric_limits<double>::infinity(), 9}}};
  expectFinding(checked(nan), "nonFiniteValues", Verdict::kKept, {2, 4});
}

TEST(CheckMesh, facesOfThreeCellsAreCountedAndRefused) {
  TetMesh mesh = twoCells();
  mesh.points.push_back({2, 2, 2});
  mesh.tetrahedra.insert(mesh.tetrahedra.begin(), {0, 0, 1, 2});
  mesh.tetrahedra.push_back({1, 2, 3, 5});
  expectFinding(checked(mesh), "crowdedFaces", Verdict::kRefused, {1});
}

TEST(CheckMesh, twoPartsWithCoincidentPointsAreFoundAndWeldedOnRequest) {
  TetMesh mesh = oneCell();
  for (const VertexId v : {1u, 2u, 3u}) mesh.points.push_back(mesh.points[v]);
  mesh.points.push_back({1, 1, 1});
  mesh.tetrahedra.push_back({4, 5, 6, 7});
  const CheckReport apart = checked(mesh);
  expectFinding(apart, "coincidentPoints", Verdict::kKept, {4, 5, 6});
  ASSERT_TRUE(finding(apart, "components"));
  EXPECT_EQ(finding(apart, "components")->found.count, 2u);
  EXPECT_FALSE(finding(apart, "hangingPoints"));
  ReadOptions weld;
  weld.weld = 0;
  const CheckReport joined = checked(mesh, weld);
  EXPECT_FALSE(finding(joined, "coincidentPoints"));
  EXPECT_FALSE(finding(joined, "components"));
}

TEST(CheckMesh, aTJunctionIsFoundWithTheFilesOwnNumber) {
  TetMesh mesh{
      {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0, 0}, {0, 0, -1}, {0, 1, -1}},
      {{1, 2, 3, 4}, {1, 5, 3, 6}, {5, 2, 3, 6}},
      {}};
  // The lower side of the face 1-2-3 is two triangles that meet in the point 5 on the edge 1-2.
  const CheckReport report = checked(mesh);
  expectFinding(report, "hangingPoints", Verdict::kKept, {5});
  mesh.points[5] = {0.5, -0.1, 0};
  EXPECT_FALSE(finding(checked(mesh), "hangingPoints"));
}

TEST(CheckMesh, quadrilateralsCutTwoWaysAreFound) {
  // Above and below the square 0-1-2-3 a pyramid, each of two tetrahedra, cut along different
  // diagonals.
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}},
                     {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 3, 1, 5}, {1, 3, 2, 5}},
                     {}};
  const CheckReport report = checked(mesh);
  ASSERT_TRUE(finding(report, "crossedFaces"));
  EXPECT_EQ(finding(report, "crossedFaces")->found.count, 1u);
  ReadOptions weld;
  weld.weld = 0;
  EXPECT_TRUE(checked(mesh, weld).findings.empty());
}

TEST(CheckMesh, filesThatCannotBeReadAreRefused) {
  const Bytes bytes = vtuBytes(boxSample());
  const std::string whole(bytes.begin(), bytes.end());
  const CheckReport cut = checkMesh(fileWith("cut.vtu", whole.substr(0, whole.size() / 2)), {});
  EXPECT_TRUE(cut.refused());
  EXPECT_EQ(cut.findings[0].kind, "truncated");
  TetMesh mesh = oneCell();
  mesh.points[2][0] = std::nan("");
  EXPECT_TRUE(checked(mesh).refused());
}

TEST(HangingPoints, pointsOnEdgesAndInsideCountCornersAndNeighboursDoNot) {
  const std::vector<Position> points{{0, 0, 0},    {4, 0, 0},   {0, 4, 0}, {1, 1, 0},    {2, 0, 0},
                                     {0, 0, 1e-9}, {1, 1, 0.1}, {5, 5, 0}, {2, -1e-3, 0}};
  std::vector<Triangle> boundary{{0, 1, 2}};
  for (VertexId v = 3; v < points.size(); ++v) boundary.push_back({v, v, v});
  EXPECT_EQ(hangingPointsOf(points, boundary), (std::vector<VertexId>{3, 4}));
}

}  // namespace
}  // namespace qtet
