// The first field and cut, on a block whose fields are made for it.
#include "simplify/measure/opening.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

using ValueAt = std::function<std::int32_t(const LatticePoint& p, bool onBoundary)>;

constexpr int kCubes = 8;
constexpr std::int32_t kSpan = 64 * kCubes;  // lattice steps

/// A block of kCubes^3 cubes with point fields of one component, 0..1000 each.
LatticeMesh blockWith(const std::vector<ValueAt>& fields) {
  LatticeMesh mesh = testing::gridMesh(kCubes, 3);
  std::set<VertexId> boundary;
  for (const Triangle& t : mesh.boundary) boundary.insert(t.begin(), t.end());
  mesh.fields.clear(), mesh.values.clear();
  for (const ValueAt& at : fields) {
    FieldInfo& info = mesh.fields.emplace_back();
    info.name = "f" + std::to_string(mesh.fields.size());
    info.minimum = {0}, info.range = {0, 1000};
    std::vector<std::int32_t>& values = mesh.values.emplace_back();
    for (VertexId v = 0; v < mesh.points.size(); ++v)
      values.push_back(at(mesh.points[v], boundary.contains(v)));
  }
  return mesh;
}

std::int32_t constant(const LatticePoint&, bool) { return 7; }
/// Many values on each side of the block.
std::int32_t varied(const LatticePoint& p, bool) {
  return (5 * p[0] + 3 * p[1] + 7 * p[2]) * 60 / kSpan;
}
std::int32_t hidden(const LatticePoint& p, bool onBoundary) {
  return onBoundary ? 7 : (p[0] + p[2]) / 8 % 1000;
}

TEST(Opening, isTheFirstFieldWhereItShowsMost) {
  EXPECT_EQ(openingOf(blockWith({varied, constant, varied})), std::nullopt);
}

TEST(Opening, isTheFieldWithMostColoursOnTheBoundary) {
  EXPECT_EQ(openingOf(blockWith({constant, hidden, varied})), Opening{2});
}

TEST(Opening, isACutWhereTheBoundaryLooksUniform) {
  const std::optional<Opening> opening = openingOf(blockWith({constant, hidden}));
  ASSERT_TRUE(opening);
  EXPECT_EQ(opening->field, 1);
  EXPECT_TRUE(opening->cut);
}

TEST(Opening, isNoCutWhereNothingShowsInside) {
  EXPECT_EQ(openingOf(blockWith({constant})), std::nullopt);
  EXPECT_EQ(openingOf(blockWith({})), std::nullopt);
}

/// The same with fields called T@0, T@1 ...
LatticeMesh runOf(const std::vector<ValueAt>& instants) {
  LatticeMesh mesh = blockWith(instants);
  for (std::size_t i = 0; i < instants.size(); ++i) mesh.fields[i].name = "T@" + std::to_string(i);
  return mesh;
}

std::int32_t weakly(const LatticePoint& p, bool onBoundary) { return varied(p, onBoundary) / 20; }
std::int32_t nearly(const LatticePoint& p, bool onBoundary) {
  return varied(p, onBoundary) * 3 / 4;
}

TEST(Opening, isTheInstantThatShowsMostOfARunThatBeginsAtRest) {
  EXPECT_EQ(openingTime(runOf({constant, weakly, varied, weakly})), 2);
  EXPECT_EQ(openingTime(runOf({weakly, varied, varied})), 1) << "the first one of equals";
}

TEST(Opening, isTheFirstInstantWhereThatShowsTwoThirdsAsMuch) {
  EXPECT_EQ(openingTime(runOf({nearly, varied})), std::nullopt);
  EXPECT_EQ(openingTime(runOf({constant, constant})), std::nullopt);
  EXPECT_EQ(openingTime(blockWith({constant, varied})), std::nullopt) << "no series";
}

TEST(Opening, staysAtTheFirstInstantWhereAnotherFieldShowsAsMuch) {
  LatticeMesh mesh = runOf({constant, varied, varied});
  mesh.fields[2].name = "p";
  std::swap(mesh.fields[1], mesh.fields[2]);
  mesh.fields.push_back(mesh.fields[2]), mesh.values.push_back(mesh.values[2]);
  mesh.fields.back().name = "T@2";
  EXPECT_EQ(openingTime(mesh), std::nullopt);
}

TEST(Opening, comparesInstantsByTheColoursOfTheWholeSeries) {
  LatticeMesh mesh = runOf({weakly, varied});
  mesh.fields[0].range = {0, 50};  // its own colours would be as many
  EXPECT_EQ(openingTime(mesh), 1);
}

TEST(Opening, isNoOutlyingInstant) {
  LatticeMesh mesh = runOf({weakly, varied, varied});
  mesh.fields[2].step = 1e6;
  mesh.fields[2].range = {0, 1e9};
  EXPECT_EQ(openingTime(mesh), 1);
  mesh.fields[1] = mesh.fields[2];
  mesh.fields[1].name = "T@1";
  EXPECT_EQ(openingTime(mesh), std::nullopt);
}

TEST(Opening, looksAtTheEndsAndAtEqualDistances) {
  std::vector<ValueAt> instants(100, constant);
  instants[99] = varied;
  EXPECT_EQ(openingTime(runOf(instants)), 99);
  instants[14] = varied;
  EXPECT_EQ(openingTime(runOf(instants)), 14);
  instants[13] = varied;
  EXPECT_EQ(openingTime(runOf(instants)), 14) << "not at every one";
}

TEST(Opening, isAnInstantWithACutWhereItsBoundaryLooksUniform) {
  EXPECT_EQ(openingTime(runOf({constant, hidden})), 1);
}

TEST(Opening, ofACellFieldIsACutIfTheOuterCellsAreAlike) {
  LatticeMesh mesh = blockWith({constant});
  mesh.fields[0].association = "cell";
  mesh.values[0].clear();
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    std::int32_t nearest = kSpan;
    for (const VertexId v : cell)
      for (const std::int32_t x : mesh.points[v]) nearest = std::min({nearest, x, kSpan - x});
    mesh.values[0].push_back(nearest <= 0 ? 7 : mesh.points[cell[0]][1] / 8 % 1000);
  }
  EXPECT_TRUE(openingOf(mesh).value_or(Opening{}).cut);
}

}  // namespace
}  // namespace qtet
