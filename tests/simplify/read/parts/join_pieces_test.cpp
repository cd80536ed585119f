#include "simplify/read/parts/join_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace qtet {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Adds a unit cube with points of its own, its least corner at `at`, as a hexahedron.
void addCube(CellMesh& mesh, const Position& at) {
  const auto first = static_cast<VertexId>(mesh.points.size());
  const Position corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                              {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (const Position& c : corners)
    mesh.points.push_back({at[0] + c[0], at[1] + c[1], at[2] + c[2]});
  std::array<VertexId, 8> ids{};
  for (VertexId i = 0; i < 8; ++i) ids[i] = first + i;
  mesh.addCell(kHexahedronCell, ids);
}

std::set<VertexId> pointsOf(const CellMesh& mesh, std::size_t cell) {
  const auto ids = mesh.cell(cell);
  return {ids.begin(), ids.end()};
}

std::size_t shared(const CellMesh& mesh, std::size_t a, std::size_t b) {
  const std::set<VertexId> one = pointsOf(mesh, a), other = pointsOf(mesh, b);
  return static_cast<std::size_t>(
      std::ranges::count_if(one, [&](VertexId v) { return other.contains(v); }));
}

TEST(JoinPieces, piecesHangTogetherAtTheirSeam) {
  CellMesh mesh;
  addCube(mesh, {0, 0, 0});
  addCube(mesh, {1, 0, 0});
  mesh.fields.push_back({"T", 1, "float64", {}, "point"});
  for (const Position& p : mesh.points) mesh.fields[0].values.push_back(p[0]);
  const JoinedPieces joined = joinPieces(mesh, std::vector<VertexId>{8, 16});
  EXPECT_EQ(joined.points, 4u);
  EXPECT_FALSE(joined.byIds);
  ASSERT_EQ(mesh.points.size(), 12u);
  EXPECT_EQ(shared(mesh, 0, 1), 4u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(mesh.fields[0].values[i], mesh.points[i][0]);
  for (std::size_t c = 0; c < 2; ++c)
    for (const VertexId v : mesh.cell(c)) EXPECT_NEAR(mesh.points[v][0], double(c) + 0.5, 0.5);
}

TEST(JoinPieces, pointsThatRoundingMovedApartAreOneIfAllSeamsCloseThen) {
  for (const auto& [gap, near] :
       {std::pair{1e-7, 4u}, std::pair{0.009, 4u}, std::pair{0.011, 0u}, std::pair{-1e-7, 4u}}) {
    CellMesh mesh;
    addCube(mesh, {0, 0, 0});
    addCube(mesh, {1 + gap, 0, 0});
    addCube(mesh, {0, 1, 0});  // exactly
    const JoinedPieces joined = joinPieces(mesh, std::vector<VertexId>{8, 16, 24});
    EXPECT_EQ(joined.nearPoints, near) << gap;
    EXPECT_EQ(joined.points, 4 + near) << gap;
    EXPECT_EQ(joined.apartPoints, 0u) << gap;
    EXPECT_EQ(shared(mesh, 0, 1), near) << gap;
    EXPECT_EQ(shared(mesh, 0, 2), 4u) << gap;
  }
}

TEST(JoinPieces, nearPointsOfPiecesThatDoNotFitStayApart) {
  // a face of 2 x 2 x 2 cubes against a face of one cube of twice the size
  CellMesh mesh;
  for (const double z : {0.0, 1.0})
    for (const double y : {0.0, 1.0}) addCube(mesh, {0, y, z});
  // one piece: its cubes share their points
  std::vector<VertexId> names(mesh.points.size());
  for (VertexId v = 0; v < names.size(); ++v)
    names[v] =
        static_cast<VertexId>(std::ranges::find(mesh.points, mesh.points[v]) - mesh.points.begin());
  mesh.renamePoints(names);
  const std::size_t first = mesh.points.size();
  addCube(mesh, {0, 0, 0});
  for (std::size_t v = first; v < mesh.points.size(); ++v) {
    const Position p = mesh.points[v];
    mesh.points[v] = {1 + 1e-7 + 2 * p[0], 2 * p[1], 2 * p[2]};
  }
  const auto ends =
      std::vector{static_cast<VertexId>(first), static_cast<VertexId>(mesh.points.size())};
  const JoinedPieces joined = joinPieces(mesh, ends);
  EXPECT_EQ(joined.points, 0u);
  EXPECT_EQ(joined.nearPoints, 0u);
  EXPECT_EQ(joined.apartPoints, 4u);
}

TEST(JoinPieces, onePieceStaysAsItIs) {
  CellMesh mesh;
  addCube(mesh, {0, 0, 0});
  addCube(mesh, {1, 0, 0});
  EXPECT_EQ(joinPieces(mesh, std::vector<VertexId>{16}).points, 0u);
  EXPECT_EQ(mesh.points.size(), 16u) << "a slit in a piece is meant";
}

/// Four cubes round the z axis. The two pieces are x < 0 and x > 0, and a slit runs through both
/// along y = 0.
TEST(JoinPieces, aSlitThatCrossesTheSeamStaysOpenAlongItsWholeLength) {
  CellMesh mesh;
  addCube(mesh, {-1, -1, 0});
  addCube(mesh, {-1, 0, 0});
  addCube(mesh, {0, -1, 0});
  addCube(mesh, {0, 0, 0});
  EXPECT_EQ(joinPieces(mesh, std::vector<VertexId>{16, 32}).points, 8u);
  EXPECT_EQ(shared(mesh, 0, 2), 4u) << "below the slit the pieces hang together";
  EXPECT_EQ(shared(mesh, 1, 3), 4u) << "above it, too";
  EXPECT_EQ(shared(mesh, 0, 1), 0u);
  EXPECT_EQ(shared(mesh, 2, 3), 0u);
  EXPECT_EQ(shared(mesh, 0, 3), 0u);
}

TEST(JoinPieces, noPointJoinsTwoOfOnePiece) {
  CellMesh mesh;  // the slit of the first piece ends at the second, which has none
  addCube(mesh, {-1, -1, 0});
  addCube(mesh, {-1, 0, 0});
  const auto second = static_cast<VertexId>(mesh.points.size());
  addCube(mesh, {0, -1, 0});
  addCube(mesh, {0, 0, 0});
  std::vector<VertexId> names(mesh.points.size());
  for (VertexId v = 0; v < names.size(); ++v) {
    names[v] = v;
    for (VertexId w = second; w < v; ++w)
      if (v > second && mesh.points[w] == mesh.points[v]) names[v] = w;
  }
  mesh.renamePoints(names);
  joinPieces(mesh, std::vector<VertexId>{second, 32});
  EXPECT_EQ(shared(mesh, 0, 1), 0u);
  EXPECT_EQ(shared(mesh, 2, 3), 4u);
}

TEST(JoinPieces, idsDecideWhereTheyHoldForAllPieces) {
  CellMesh mesh;
  addCube(mesh, {0, 0, 0});
  addCube(mesh, {1, 0, 0});
  mesh.points[8][1] += 1e-9;  // rounded otherwise by the other process
  mesh.pointIds = {0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 9, 2, 5, 10, 11, 6};
  const JoinedPieces joined = joinPieces(mesh, std::vector<VertexId>{8, 16});
  EXPECT_TRUE(joined.byIds);
  EXPECT_EQ(joined.points, 4u);
  EXPECT_EQ(mesh.pointIds, (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST(JoinPieces, idsThatEachPieceCountsForItselfAreNoIds) {
  CellMesh mesh;
  addCube(mesh, {0, 0, 0});
  addCube(mesh, {1, 0, 0});
  mesh.pointIds = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
  const JoinedPieces joined = joinPieces(mesh, std::vector<VertexId>{8, 16});
  EXPECT_FALSE(joined.byIds);
  EXPECT_EQ(shared(mesh, 0, 1), 4u);
}

TEST(JoinPieces, aValueThatThePointsOwnPieceMissesIsTheOthers) {
  CellMesh mesh;
  addCube(mesh, {0, 0, 0});
  addCube(mesh, {1, 0, 0});
  mesh.fields.push_back({"T", 1, "float64", std::vector<double>(16, 7), "point"});
  std::fill_n(mesh.fields[0].values.begin(), 8, kNan);
  joinPieces(mesh, std::vector<VertexId>{8, 16});
  for (const VertexId v : mesh.cell(1)) EXPECT_EQ(mesh.fields[0].values[v], 7);
}

TEST(JoinPieces, minusZeroIsZeroAndWhatIsNoNumberJoinsNothing) {
  CellMesh mesh;
  addCube(mesh, {-1, 0, 0});
  addCube(mesh, {0, 0, 0});
  for (const VertexId v : mesh.cell(0))
    if (mesh.points[v][0] == 0) mesh.points[v][0] = -0.0;
  mesh.points[0] = {kNan, kNan, kNan};
  mesh.points[15] = {-kNan, 1, kNan};
  EXPECT_EQ(joinPieces(mesh, std::vector<VertexId>{8, 16}).points, 3u);
}

TEST(JoinPieces, idsOutsideThePointsStayWhatTheyAre) {
  CellMesh mesh;
  addCube(mesh, {0, 0, 0});
  addCube(mesh, {1, 0, 0});
  mesh.vertices[3] = kGhost;
  mesh.addCell(kPolyhedronCell, std::vector<VertexId>{kGhost, 3, kGhost, 1, 2, kGhost});
  joinPieces(mesh, std::vector<VertexId>{8, 16});
  EXPECT_EQ(mesh.cell(0)[3], kGhost);
  EXPECT_EQ(mesh.cell(2)[0], kGhost) << "a polyhedron's counts are no ids";
}

/// Two cubes that touch, as blocks 1 and 2, with `left` and `right` as their values of T.
CellMesh twoBlocks(double left, double right, const std::string& type = "float64") {
  CellMesh mesh;
  addCube(mesh, {0, 0, 0});
  addCube(mesh, {1, 0, 0});
  mesh.fields.push_back({"T", 1, type, std::vector<double>(16, left), "point"});
  std::ranges::fill(mesh.fields[0].values.begin() + 8, mesh.fields[0].values.end(), right);
  mesh.fields.push_back({"wide", 1, "float64", std::vector<double>(16, 0), "point"});
  return mesh;
}

BlocksOfPoints blocksOfCubes(std::optional<NumberPairs> apart = {}) {
  BlocksOfPoints out{std::vector<std::int32_t>(16, 1), std::move(apart)};
  std::ranges::fill(out.block.begin() + 8, out.block.end(), 2);
  return out;
}

const std::vector<VertexId> kCubeEnds{8, 16};

TEST(JoinPieces, pointsOfBlocksStayApartWhereTheirValuesDiffer) {
  CellMesh mesh = twoBlocks(1, 8000);
  const JoinedPieces joined = joinPieces(mesh, kCubeEnds, blocksOfCubes());
  EXPECT_EQ(joined.points, 0u);
  EXPECT_EQ(joined.blockPoints, 4u);
  EXPECT_EQ(joined.differing, (NumberPairs{{1, 2}}));
  EXPECT_EQ(mesh.points.size(), 16u);
  CellMesh pieces = twoBlocks(1, 8000);
  EXPECT_EQ(joinPieces(pieces, kCubeEnds).points, 4u) << "pieces of one mesh hang together";
}

TEST(JoinPieces, roundingMissingValuesAndIntegersKeepNothingApart) {
  for (const auto& [left, right, type] :
       {std::tuple{1.0, 1.0, "float64"}, std::tuple{1.0, kNan, "float32"},
        std::tuple{kNan, 1.0, "float64"}, std::tuple{1.0, 8000.0, "int32"}}) {
    CellMesh mesh = twoBlocks(left, right, type);
    EXPECT_EQ(joinPieces(mesh, kCubeEnds, blocksOfCubes()).points, 4u) << left << " " << right;
    EXPECT_EQ(mesh.fields[0].values[1], 1) << left << " " << right;
  }
  for (const auto& [difference, points] : {std::pair{0.9, 4u}, std::pair{1.1, 0u}}) {
    CellMesh mesh = twoBlocks(0, difference);
    mesh.fields[0].values[0] = 1000;  // so that the difference is about a thousandth of the range
    const JoinedPieces joined = joinPieces(mesh, kCubeEnds, blocksOfCubes());
    EXPECT_EQ(joined.points, points) << difference;
    EXPECT_EQ(joined.blockPoints, 4u - points) << difference;
  }
}

TEST(JoinPieces, globalIdsJoinNoValuesThatDiffer) {
  CellMesh mesh = twoBlocks(1, 8000);
  mesh.pointIds = {0, 1, 2, 3, 4, 5, 6, 7, 1, 11, 12, 2, 5, 15, 16, 6};
  const JoinedPieces joined = joinPieces(mesh, kCubeEnds, blocksOfCubes());
  EXPECT_TRUE(joined.byIds);
  EXPECT_EQ(joined.points, 0u);
  EXPECT_EQ(joined.blockPoints, 4u);
  EXPECT_EQ(joined.differing, (NumberPairs{{1, 2}}));
}

TEST(JoinPieces, blocksThatAgreedBeforeAreJoinedAndTheirDifferencesCounted) {
  CellMesh mesh = twoBlocks(1, 8000);
  const JoinedPieces joined = joinPieces(mesh, kCubeEnds, blocksOfCubes(NumberPairs{}));
  EXPECT_EQ(joined.points, 4u);
  EXPECT_EQ(joined.differingPoints, 4u);
  EXPECT_EQ(joined.differing, (NumberPairs{{1, 2}}));
}

TEST(JoinPieces, blocksThatAreKeptApartShareNoPointWhateverTheirValues) {
  CellMesh mesh = twoBlocks(1, 1);
  const JoinedPieces joined = joinPieces(mesh, kCubeEnds, blocksOfCubes(NumberPairs{{1, 2}}));
  EXPECT_EQ(joined.points, 0u);
  EXPECT_EQ(joined.blockPoints, 4u);
  EXPECT_TRUE(joined.blocksMeet);
  EXPECT_TRUE(joined.differing.empty());
}

// Three cubes that share an edge. The one without values agrees with both others, which differ.
TEST(JoinPieces, aBlockWithoutValuesJoinsNoTwoThatDiffer) {
  std::vector<double> values{kNan, 1, 8000};
  std::vector<std::size_t> order{0, 1, 2};
  do {
    for (const bool areNamed : {false, true}) {
      CellMesh mesh = twoBlocks(values[order[0]], values[order[1]]);
      addCube(mesh, {0, 1, 0});
      mesh.fields[0].values.resize(24, values[order[2]]);
      mesh.fields[1].values.resize(24, 0);
      BlocksOfPoints blocks = blocksOfCubes();
      blocks.block.resize(24, 3);
      if (areNamed) {
        NumberPairs apart;
        for (std::int32_t a = 1; a <= 3; ++a)
          for (std::int32_t b = a + 1; b <= 3; ++b)
            if (order[a - 1] != 0 && order[b - 1] != 0) apart.emplace(a, b);
        blocks.apart = apart;
      }
      joinPieces(mesh, std::vector<VertexId>{8, 16, 24}, blocks);
      std::multiset<double> atEdge;
      for (std::size_t v = 0; v < mesh.points.size(); ++v)
        if (mesh.points[v] == Position{1, 1, 0}) atEdge.insert(mesh.fields[0].values[v]);
      EXPECT_EQ(atEdge, (std::multiset<double>{1, 8000})) << order[0] << order[1] << order[2];
    }
  } while (std::ranges::next_permutation(order).found);
}

TEST(JoinPieces, whereThreeBlocksMeetThoseThatAgreeAreOne) {
  CellMesh mesh = twoBlocks(1, 8000);
  addCube(mesh, {0, 1, 0});  // shares points 2, 3, 6, 7 of the first, of which 2 and 6 are the
  mesh.fields[0].values.resize(24, 8000);  // second's, too
  mesh.fields[1].values.resize(24, 0);
  BlocksOfPoints blocks = blocksOfCubes();
  blocks.block.resize(24, 3);
  const JoinedPieces joined = joinPieces(mesh, std::vector<VertexId>{8, 16, 24}, blocks);
  EXPECT_EQ(joined.points, 2u) << "those of the second and the third";
  EXPECT_EQ(shared(mesh, 1, 2), 2u);
  EXPECT_EQ(shared(mesh, 0, 1), 0u);
}

}  // namespace
}  // namespace qtet
