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
