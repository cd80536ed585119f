// Meshes that move: no fusion flips a cell at an instant that is checked.
#include <gtest/gtest.h>

#include <cmath>

#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/quantise.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/mesh/moved_place.h"
#include "simplify/pipeline/moved_flips.h"
#include "simplify/samples/cube_grid.h"

namespace qtet {
namespace {

/// A strip of 48 x 4 x 6 cubes that is rolled up step by step, twice round, by point fields
/// Displacement@0 ... of instants.
LatticeMesh bentStrip(int instants) {
  constexpr CubeGrid kGrid{{48, 4, 6}};
  constexpr double kLength = 48, kHeight = 6;
  TetMesh mesh;
  kGrid.forEachPoint([&](const std::array<VertexId, 3>& at) {
    mesh.points.push_back({static_cast<double>(at[0]), static_cast<double>(at[1]),
                           static_cast<double>(at[2]) - kHeight / 2});
  });
  mesh.tetrahedra = kGrid.cells();
  for (int i = 0; i < instants; ++i) {
    const double angle = 14 * i / std::max(1.0, instants - 1.0);
    MeshField field{"Displacement@" + std::to_string(i), 3, "float64", {}};
    for (const Position& p : mesh.points) {
      const double radius = angle == 0 ? 0 : kLength / angle, turn = angle * p[0] / kLength;
      const double x = angle == 0 ? p[0] : (radius - p[2]) * std::sin(turn);
      const double z = angle == 0 ? p[2] : radius - (radius - p[2]) * std::cos(turn);
      field.values.insert(field.values.end(), {x - p[0], 0.0, z - p[2]});
    }
    mesh.fields.push_back(std::move(field));
  }
  EXPECT_TRUE(cleanMesh(mesh));
  const Result<QuantisedMesh> out = quantise(mesh);
  EXPECT_TRUE(out);
  return out->mesh;
}

FusionHistory fusedHistory(const LatticeMesh& mesh, std::size_t checkedInstants, int threads = 1) {
  FusionOptions options;
  options.baseCells = 60;
  options.threads = threads;
  options.checkedInstants = checkedInstants;
  Result<FusionHistory> history = simplify(mesh, options);
  EXPECT_TRUE(history);
  return std::move(*history);
}

bool areSame(const FusionHistory& a, const FusionHistory& b) {
  return a.points == b.points && a.cells == b.cells && a.live == b.live && a.values == b.values;
}

TEST(MovingMesh, aDisplacementIsRoundedToTheLatticeHalvesUp) {
  const Lattice lattice{16, 0.5, {}};
  FieldInfo field;
  field.step = 0.25;
  field.minimum = {-1, 0, 1e30};
  const std::array<std::int32_t, 3> integers{1, 3, 0};
  EXPECT_EQ(movedPoint(lattice, field, {5, 6, 7}, integers),
            (MovedPoint{5 - 1, 6 + 2, 7 + (std::int64_t{1} << 38)}))
      << "-0.75 and 0.75 are one and a half steps; what is too far is cut off";
}

TEST(MovingMesh, orientationsAreExactHoweverFarPointsLie) {
  const std::int64_t far = std::int64_t{1} << 38;
  EXPECT_EQ(movedOrientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(movedOrientation({-far, 0, 0}, {far, 1, 0}, {0, far, 1}, {0, far, 2}), 1);
  EXPECT_EQ(movedOrientation({-far, -far, -far}, {0, 0, 0}, {far, far, far}, {1, 2, 3}), 0);
  EXPECT_EQ(
      movedOrientation({-far, -far, -far}, {far, -far, -far}, {-far, -far, far}, {-far, far, -far}),
      -1);
}

TEST(MovingMesh, instantsAreSampledFromTheFirstThatMovesToTheLast) {
  LatticeMesh mesh = bentStrip(20);
  EXPECT_EQ(displacementFields(mesh.fields).size(), 20u);
  EXPECT_EQ(sampledDisplacements(mesh, 3), (std::vector<std::size_t>{1, 10, 19}))
      << "at 0 the mesh rests";
  EXPECT_EQ(sampledDisplacements(mesh, 19).size(), 19u);
  EXPECT_EQ(sampledDisplacements(mesh, 1), std::vector<std::size_t>{19});
  EXPECT_TRUE(sampledDisplacements(mesh, 0).empty());
  for (FieldInfo& field : mesh.fields) field.name = "Velocity";
  mesh.fields[4].name = "Displacement";
  EXPECT_EQ(sampledDisplacements(mesh, 8), std::vector<std::size_t>{4});
  mesh.fields[4].components = 1;
  EXPECT_TRUE(sampledDisplacements(mesh, 8).empty());
}

TEST(MovingMesh, noCellFlipsAtAnInstantThatIsChecked) {
  const LatticeMesh mesh = bentStrip(5);
  const MovedFlips without = movedFlips(fusedHistory(mesh, 0));
  EXPECT_EQ(without.instants, 5u);
  EXPECT_GT(without.cells, 0u) << "else this tests nothing";
  ASSERT_TRUE(without.warning());
  EXPECT_NE(without.warning()->find("at " + without.worst), std::string::npos);
  const FusionHistory checked = fusedHistory(mesh, 8);
  EXPECT_EQ(movedFlips(checked).flipped, 0u);
  EXPECT_FALSE(movedFlips(checked).warning());
  EXPECT_LT(movedFlips(fusedHistory(mesh, 1)).cells, without.cells) << "the last instant counts";
  EXPECT_TRUE(areSame(checked, fusedHistory(mesh, 8, 3))) << "threads change nothing";
}

TEST(MovingMesh, aFieldOfAnotherNameChangesNothing) {
  LatticeMesh mesh = bentStrip(2);
  for (FieldInfo& field : mesh.fields) field.name = "U" + field.name;
  EXPECT_TRUE(areSame(fusedHistory(mesh, 8), fusedHistory(mesh, 0)));
  EXPECT_EQ(movedFlips(fusedHistory(mesh, 8)).instants, 0u);
}

}  // namespace
}  // namespace qtet
