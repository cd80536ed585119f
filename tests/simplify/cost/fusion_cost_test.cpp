#include "simplify/cost/fusion_cost.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::gridMesh;

TEST(Quadric, itsMinimumIsWhereThreePlanesMeet) {
  Quadric q;
  q.a.addOuter({1, 0, 0}, 4), q.a.addOuter({0, 1, 0}, 2);
  q.b = {-8, -6, 0};  // 4 (x - 2)^2 + 2 (y - 3)^2
  q.c = 4 * 4 + 2 * 9;
  EXPECT_DOUBLE_EQ(q.at({2, 3, 17}), 0);
  EXPECT_DOUBLE_EQ(q.at({3, 5, 0}), 4 + 2 * 4);
  EXPECT_FALSE(q.minimum({0, 0, 0}, 0))
      << "two planes meet in a line: equation 6 has no one answer";
  const auto pulled = q.minimum({2, 3, 5}, 1e-9);
  ASSERT_TRUE(pulled);
  EXPECT_NEAR((*pulled)[2], 5, 1e-6) << "the pull decides where the planes do not";
  q.a.addOuter({0, 0, 1}, 1);
  q.b[2] = -4;
  const auto p = q.minimum({0, 0, 0}, 0);
  ASSERT_TRUE(p);
  EXPECT_NEAR((*p)[0], 2, 1e-12);
  EXPECT_NEAR((*p)[1], 3, 1e-12);
  EXPECT_NEAR((*p)[2], 4, 1e-12);
}

/// Two tetrahedra on one base in the plane z = 0, of area 8.
LatticeMesh bipyramid() {
  LatticeMesh mesh;
  mesh.points = {{10, 10, 10}, {14, 10, 10}, {10, 14, 10}, {11, 11, 16}, {11, 11, 4}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.boundary = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}};
  return mesh;
}

TEST(FusionCost, withoutFieldsIsTheAreaWeightedSquaredDistanceOfEquationsOneToFive) {
  const LatticeMesh mesh = bipyramid();
  const FusionMesh live(mesh);
  const FusionCost cost(live, mesh, {});
  // Equation 4 and 5 worked out plane by plane: each face of each prey vertex once, boundary planes
  // 10 times their area.
  const Prey prey{2, {0, 1, 0, 0}};
  const Vector3 at{12, 11, 13};
  double expected = 0;
  const auto plane = [&](std::array<VertexId, 3> f, double factor) {
    const Vector3 a = toVector(mesh.points[f[0]]);
    const Vector3 n = cross(toVector(mesh.points[f[1]]) - a, toVector(mesh.points[f[2]]) - a);
    const double area = std::sqrt(dot(n, n)) / 2;
    const double distance = dot(n, at - a) / (2 * area);
    for (const VertexId v : f)
      if (v == 0 || v == 1) expected += area * area * factor * factor * distance * distance;
  };
  plane({0, 1, 2}, 1);
  for (const Triangle& t : mesh.boundary) plane(t, 10);
  expected = std::ldexp(expected, -3 * mesh.lattice.bits);  // in what keys are measured in
  EXPECT_NEAR(cost.of(prey).quadric.at(at - toVector(mesh.points[0])), expected, 1e-9 * expected);
}

TEST(FusionCost, isTheVolumeWeightedSquaredResidualOfTheField) {
  LatticeMesh mesh = bipyramid();
  mesh.fields = {{"s", 1, "float32", "point", 8, 0.5, {0}, {0, 100}}};
  mesh.values = {{20, 60, 40, 120, 7}};
  const FusionMesh live(mesh);
  CostOptions options;
  options.boundaryWeight = 0;
  const FusionCost cost(live, mesh, options);
  ASSERT_EQ(cost.components(), 1u);
  EXPECT_DOUBLE_EQ(cost.parts()[0].scale, 0.5 / 100);
  // At a vertex's own place and value its cells' residuals vanish. The cost of a prey is then that
  // of the other vertex's quadric alone.
  std::array<double, 1> value{};
  const Prey apexes{2, {3, 4, 0, 0}};
  const double both = cost.valuesAt(apexes, mesh.points[3], value);
  EXPECT_GT(both, 0);
  EXPECT_GE(value[0], 0);
  EXPECT_LE(value[0], 255 * cost.parts()[0].scale) << "values stay within the field's bits";
}

TEST(FusionCost, countsDoNotChangeWithUnits) {
  LatticeMesh mesh = gridMesh(4, 1);
  LatticeMesh other = mesh;
  for (FieldInfo& f : other.fields) {
    f.step *= 1e6;
    for (double& r : f.range) r *= 1e6;
  }
  const FusionMesh live(mesh);
  const FusionCost a(live, mesh, {}), b(live, other, {});
  const Prey prey{2, {mesh.tetrahedra[0][0], mesh.tetrahedra[0][1], 0, 0}};
  EXPECT_DOUBLE_EQ(a.of(prey).quadric.at({3, 2, 1}), b.of(prey).quadric.at({3, 2, 1}));
}

TEST(FusionCost, leavesOutConstantFieldsAndThoseOfNoWeight) {
  LatticeMesh mesh = gridMesh(3, 1);
  const FusionMesh live(mesh);
  EXPECT_EQ(FusionCost(live, mesh, {}).components(), 4u);
  CostOptions options;
  options.fieldWeights = {0, 2};
  const FusionCost swirl(live, mesh, options);
  ASSERT_EQ(swirl.parts().size(), 1u);
  EXPECT_EQ(swirl.parts()[0].field, 1u);
  EXPECT_EQ(swirl.components(), 3u);
  std::ranges::fill(mesh.values[0], 7);
  EXPECT_EQ(FusionCost(live, mesh, {}).components(), 3u) << "a constant field says nothing";
}

// Edges have a kernel of their own, which takes components two at a time; valuesAt sums one vertex
// after the other.
TEST(FusionCost, anEdgesQuadricIsTheSumOfItsVertices) {
  const LatticeMesh mesh = gridMesh(4, 5);
  const FusionMesh live(mesh);
  for (const std::vector<double>& weights : {std::vector<double>{1, 0}, {0, 1}, {1, 1}, {0, 0}}) {
    CostOptions options;
    options.fieldWeights = weights;
    const FusionCost cost(live, mesh, options);
    std::vector<double> values(cost.components());
    std::size_t same = 0;
    for (const Tetrahedron& t : mesh.tetrahedra) {
      const Prey edge{2, {t[0], t[1], 0, 0}};
      const LatticePoint p = middle(std::array{mesh.points[t[0]], mesh.points[t[1]]});
      const double whole = cost.valuesAt(edge, p, values);
      const double ofEdge = cost.of(edge).quadric.at(toVector(p) - toVector(mesh.points[t[0]]));
      ASSERT_LE(ofEdge, whole * (1 + 1e-9)) << "values that the fields cannot hold cost more";
      same += std::abs(ofEdge - whole) <= 1e-9 * whole;
    }
    EXPECT_GT(10 * same, 7 * mesh.tetrahedra.size()) << cost.components() << " components";
  }
}

// Whatever the order in which quadrics are moved and summed, they are those of the union (Eq. 4).
TEST(FusionCost, aFusedVertexCarriesThePreysQuadrics) {
  const LatticeMesh mesh = gridMesh(4, 3);
  FusionMesh live(mesh);
  FusionCost cost(live, mesh, {});
  const Tetrahedron& t = mesh.tetrahedra[100];
  const Prey all{4, t}, edge{2, {t[0], t[1], 0, 0}};
  const LatticePoint p = mesh.points[t[2]];
  std::vector<double> values(cost.components());
  const double whole = cost.valuesAt(all, p, values);

  std::vector<double> atEdge(cost.components());
  const LatticePoint middle = mesh.points[t[0]];
  cost.valuesAt(edge, middle, atEdge);
  const std::vector<std::int32_t> integers(4, 0);
  const VertexId fused = live.fuse(edge, {middle, integers}, {}, 0);
  cost.makeRoom(live.vertexSlots());
  cost.fuse(edge, fused, middle, atEdge);
  const Prey rest{3, {fused, t[2], t[3], 0}};
  std::vector<double> again(cost.components());
  EXPECT_NEAR(cost.valuesAt(rest, p, again), whole, 1e-9 * whole);
  for (std::size_t f = 0; f < values.size(); ++f) EXPECT_NEAR(again[f], values[f], 1e-9);
}

}  // namespace
}  // namespace qtet
