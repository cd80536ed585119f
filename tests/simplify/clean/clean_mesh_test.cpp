#include "simplify/clean/clean_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "codec/mesh/boundary.h"
#include "simplify/mesh/volume_sign.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

using testing::oneCell;
using testing::twoCells;
using Numbers = std::vector<std::uint64_t>;

CleanReport cleaned(TetMesh& mesh) {
  Result<CleanReport> report = cleanMesh(mesh);
  EXPECT_TRUE(report) << report.error().text();
  return report ? std::move(*report) : CleanReport{};
}

TEST(CleanMesh, aFlawlessMeshStaysAsItIs) {
  TetMesh mesh = boxSample();
  const TetMesh before = mesh;
  const CleanReport report = cleaned(mesh);
  EXPECT_TRUE(report.sentences().empty());
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(mesh.tetrahedra, before.tetrahedra);
  EXPECT_EQ(mesh.points, before.points);
}

TEST(CleanMesh, itsVolumeAndBoxAreReported) {
  TetMesh mesh = twoCells();
  mesh.points.push_back({99, 99, 99});  // of no cell
  const CleanReport report = cleaned(mesh);
  double volume = 0;
  for (const Tetrahedron& t : mesh.tetrahedra)
    volume +=
        roundedVolume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) /
        6;
  EXPECT_DOUBLE_EQ(report.volume, volume);
  EXPECT_GT(report.volume, 0);
  for (const Position& p : mesh.points)
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_LE(report.box[0][a], p[a]);
      EXPECT_GE(report.box[1][a], p[a]);
    }
  EXPECT_LT(report.box[1][0], 99);
}

TEST(CleanMesh, aCellThatNamesAVertexTwiceIsDropped) {
  TetMesh mesh = twoCells();
  mesh.tetrahedra.insert(mesh.tetrahedra.begin() + 1, {0, 2, 2, 3});
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.repeatedVertexCells.first, Numbers{1});
  EXPECT_EQ(mesh.tetrahedra.size(), 2u);
  EXPECT_EQ(report.sentences(),
            (std::vector<std::string>{"cells that name a vertex twice, dropped: 1 (cell 1)"}));
}

TEST(CleanMesh, duplicatesAreDroppedWhateverTheirOrder) {
  TetMesh mesh = twoCells();
  mesh.tetrahedra.push_back({3, 2, 1, 0});
  mesh.tetrahedra.push_back({4, 3, 1, 2});
  mesh.tetrahedra.push_back({0, 1, 2, 3});
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.duplicateCells.first, (Numbers{2, 3, 4}));
  EXPECT_EQ(mesh.tetrahedra, twoCells().tetrahedra);
}

TEST(CleanMesh, numbersAreThoseOfTheFileAlsoAfterDropping) {
  TetMesh mesh = twoCells();
  mesh.tetrahedra = {{0, 0, 1, 2}, {0, 1, 2, 3}, {2, 1, 0, 3}, {2, 1, 3, 4}};
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.repeatedVertexCells.first, Numbers{0});
  EXPECT_EQ(report.duplicateCells.first, Numbers{2});
  EXPECT_EQ(report.reorientedCells.first, Numbers{3});
}

TEST(CleanMesh, noMoreThanEightNumbersAreListed) {
  TetMesh mesh = oneCell();
  for (int i = 0; i < 20; ++i) mesh.tetrahedra.push_back({0, 0, 1, 2});
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.repeatedVertexCells.count, 20u);
  EXPECT_EQ(report.repeatedVertexCells.first, (Numbers{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(CleanMesh, aMixOfOrientationsBecomesPositive) {
  TetMesh mesh = boxSample();
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    if (i % 3 != 0) std::swap(mesh.tetrahedra[i][0], mesh.tetrahedra[i][1]);
  }
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.reorientedCells.count, 2048u);
  EXPECT_EQ(report.invertedCells.count, 0u);
  for (const Tetrahedron& t : mesh.tetrahedra)
    ASSERT_EQ(
        volumeSign(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]), 1);
}

TEST(CleanMesh, theBoundaryIsThatOfTheCleanedMesh) {
  TetMesh mesh = boxSample();
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); i += 2)
    std::swap(mesh.tetrahedra[i][2], mesh.tetrahedra[i][3]);
  mesh.points.insert(mesh.points.begin(), Position{9, 9, 9});
  for (Tetrahedron& t : mesh.tetrahedra)
    for (VertexId& v : t) ++v;
  mesh.tetrahedra.push_back(mesh.tetrahedra[7]);
  mesh.fields.clear();
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.duplicateCells.count, 1u);
  EXPECT_EQ(report.unusedPoints.count, 1u);
  EXPECT_GT(report.reorientedCells.count, 0u);
  EXPECT_EQ(report.boundary, boundaryOf(mesh.tetrahedra));
}

TEST(CleanMesh, aCellInsideOutAgainstItsNeighboursIsKeptAndReported) {
  TetMesh mesh = twoCells();
  // on the wrong side of the shared face: the second cell lies inside the first
  mesh.points[4] = {0.1, 0.1, 0.1};
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.invertedCells.first, Numbers{1});
  EXPECT_EQ(report.reorientedCells.count, 0u);
  EXPECT_EQ(mesh.tetrahedra.size(), 2u);
}

TEST(CleanMesh, flatCellsAreKept) {
  TetMesh mesh = twoCells();
  mesh.points[4] = {0.25, 0.25, 0.5};  // in the plane of the shared face
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.flatCells.first, Numbers{1});
  EXPECT_EQ(mesh.tetrahedra.size(), 2u);
}

TEST(CleanMesh, unusedPointsTakeTheirValuesAlong) {
  TetMesh mesh = oneCell();
  mesh.points.insert(mesh.points.begin() + 2, {9, 9, 9});
  mesh.points.push_back({8, 8, 8});
  mesh.tetrahedra = {{0, 1, 3, 4}};
  mesh.fields = {{"v", 2, "float32", {0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5}}};
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.unusedPoints.first, (Numbers{2, 5}));
  EXPECT_EQ(mesh.points, oneCell().points);
  EXPECT_EQ(mesh.tetrahedra, oneCell().tetrahedra);
  EXPECT_EQ(mesh.fields[0].values, (std::vector<double>{0, 0.5, 1, 1.5, 3, 3.5, 4, 4.5}));
}

TEST(CleanMesh, droppedCellsTakeTheirValuesAlong) {
  TetMesh mesh = twoCells();
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 0, 1, 2}, {3, 2, 1, 0}, {1, 2, 3, 4}};
  mesh.fields = {{"p", 1, "float32", {0, 1, 2, 3, 4}},
                 {"c", 2, "int32", {1, 10, 2, 20, 3, 30, 4, 40}, "cell"}};
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.repeatedVertexCells.count, 1u);
  EXPECT_EQ(report.duplicateCells.count, 1u);
  EXPECT_EQ(mesh.fields[0].values, (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(mesh.fields[1].values, (std::vector<double>{1, 10, 4, 40}));
}

TEST(CleanMesh, coincidentPointsAreOnlyReported) {
  TetMesh mesh = oneCell();
  // unused: the numbers reported are those before it goes
  mesh.points.insert(mesh.points.begin(), {7, 7, 7});
  for (const Position& p : oneCell().points) mesh.points.push_back({p[0] + 1, p[1], p[2]});
  mesh.tetrahedra = {{1, 2, 3, 4}, {5, 6, 7, 8}};
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.coincidentPoints.first, Numbers{5});
  EXPECT_EQ(mesh.points.size(), 8u);
  EXPECT_EQ(report.components, 2u);
}

TEST(CleanMesh, twoSolidsThatTouchAtAnEdgeAreReported) {
  TetMesh mesh = oneCell();
  mesh.points.push_back({-1, 0, 0.5});
  mesh.points.push_back({-1, -1, 0.5});
  mesh.tetrahedra.push_back({0, 3, 4, 5});
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.nonManifoldEdges.first, Numbers{0});
  EXPECT_EQ(report.nonManifoldEdgeEnds, Numbers{3});
  EXPECT_EQ(report.nonManifoldVertices.first, (Numbers{0, 3}));
  EXPECT_EQ(report.components, 2u);
}

TEST(CleanMesh, twoSolidsThatTouchAtAVertexAreReported) {
  TetMesh mesh = oneCell();
  for (const Position& p : {Position{-1, 0, 0}, Position{0, -1, 0}, Position{0, 0, -1}})
    mesh.points.push_back(p);
  mesh.tetrahedra.push_back({0, 4, 5, 6});
  const CleanReport report = cleaned(mesh);
  EXPECT_EQ(report.nonManifoldEdges.count, 0u);
  EXPECT_EQ(report.nonManifoldVertices.first, Numbers{0});
}

TEST(CleanMesh, threeCellsOnOneFaceAreRefusedByName) {
  TetMesh mesh = twoCells();
  mesh.points.push_back({2, 2, 2});
  mesh.tetrahedra.insert(mesh.tetrahedra.begin(), {0, 0, 1, 2});
  mesh.tetrahedra.push_back({1, 2, 3, 5});
  const Result<CleanReport> report = cleanMesh(mesh);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
  EXPECT_NE(report.error().message.find("3 cells (1, 2, 3) share one face"), std::string::npos)
      << report.error().message;
}

/// A closed chain of tetrahedra (w, w+1, w+2, w+3), each glued to the next by the face that they
/// share. `twisted` exchanges two vertices of the face that closes it, as a Moebius strip's ends
/// are glued.
TetMesh ringOf(VertexId n, bool twisted) {
  TetMesh mesh;
  const auto vertex = [&](VertexId w) {
    return w < n || !twisted ? w % n : w == n ? 0 : w == n + 1 ? 2 : 1;
  };
  for (VertexId w = 0; w < n; ++w) {
    mesh.points.push_back(
        {static_cast<double>(w * w % 7), static_cast<double>(w % 3), static_cast<double>(w)});
    mesh.tetrahedra.push_back({vertex(w), vertex(w + 1), vertex(w + 2), vertex(w + 3)});
  }
  return mesh;
}

TEST(CleanMesh, aRingWithoutInsideAndOutsideIsRefused) {
  for (const VertexId n : {9u, 10u}) {
    TetMesh mesh = ringOf(n, true);
    const Result<CleanReport> report = cleanMesh(mesh);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
    EXPECT_NE(report.error().message.find("Moebius"), std::string::npos) << report.error().message;
  }
}

TEST(CleanMesh, aRingThatClosesIsAccepted) {
  for (const VertexId n : {9u, 10u}) {
    TetMesh mesh = ringOf(n, false);
    EXPECT_EQ(cleaned(mesh).components, 1u);
  }
}

TEST(CleanMesh, aMeshOfWhichNothingRemainsIsRefused) {
  TetMesh mesh = oneCell();
  mesh.tetrahedra = {{0, 1, 2, 2}};
  const Result<CleanReport> report = cleanMesh(mesh);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace qtet
