#include "simplify/cost/cost_basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simplify/fuse/qtetfusion.h"
#include "simplify/mesh/vector3.h"
#include "tests/support/meshes.h"
#include "tests/support/plain_error.h"

namespace qtet {
namespace {

using testing::gridMesh;

constexpr int kBits = 12;
constexpr double kMax = 4095;

/// A cube with `count` scalar fields of floats, `valueOf(p, f)` from 0 to 1 at p in [0, 1]^3.
template <class ValueOf>
LatticeMesh cubeWith(int n, std::size_t count, const ValueOf& valueOf) {
  LatticeMesh mesh = gridMesh(n, 1);
  std::int32_t side = 1;
  for (const LatticePoint& p : mesh.points) side = std::max(side, p[0]);
  mesh.fields.clear(), mesh.values.clear();
  for (std::size_t f = 0; f < count; ++f) {
    mesh.fields.push_back(
        {"s" + std::to_string(f), 1, "float32", "point", kBits, 1, {0}, {0, kMax}});
    std::vector<std::int32_t>& values = mesh.values.emplace_back();
    for (const LatticePoint& p : mesh.points) {
      const Vector3 at = (1.0 / side) * toVector(p);
      values.push_back(static_cast<std::int32_t>(std::lround(kMax * valueOf(at, f))));
    }
  }
  return mesh;
}

CostBasis basisOf(const LatticeMesh& mesh) { return CostBasis(mesh, costPartsOf(mesh, {})); }

/// A bump that wanders from one corner of the cube to the opposite one.
double wanderingBump(const Vector3& at, std::size_t step, std::size_t steps) {
  const double t = static_cast<double>(step) / static_cast<double>(steps - 1);
  const Vector3 d = at - Vector3{t, t, t};
  return std::exp(-dot(d, d) / 0.08);
}

TEST(CostBasis, upToThirtyTwoComponentsStandForThemselves) {
  const auto valueOf = [](const Vector3& at, std::size_t f) { return at[f % 3]; };
  const CostBasis basis = basisOf(cubeWith(3, kMaxCostComponents, valueOf));
  EXPECT_TRUE(basis.isDirect());
  EXPECT_EQ(basis.components(), kMaxCostComponents);
  CostValues values{};
  basis.add(7, 0.25, std::span(values).first(basis.components()));
  EXPECT_EQ(values[7], 0.25);
  EXPECT_EQ(std::ranges::count(values, 0), kMaxCostComponents - 1);
  EXPECT_FALSE(basisOf(cubeWith(3, kMaxCostComponents + 1, valueOf)).isDirect());
}

TEST(CostBasis, manyMixturesOfThreePatternsAreThreeComponentsThatGiveThemAllBack) {
  constexpr std::size_t kFields = 50;
  const LatticeMesh mesh = cubeWith(5, kFields, [](const Vector3& at, std::size_t f) {
    const double u = static_cast<double>(f % 7) / 14, v = static_cast<double>(f % 11) / 22;
    return u * at[0] + v * at[1] * at[1] + (1 - u - v) * at[2];
  });
  const std::vector<CostPart> parts = costPartsOf(mesh, {});
  const CostBasis basis(mesh, parts);
  ASSERT_FALSE(basis.isDirect());
  EXPECT_LE(basis.components(), 3u);
  EXPECT_GT(basis.varianceKept(), 0.99);
  // The difference of two vertices goes into the basis and comes back.
  const std::size_t last = mesh.points.size() - 1;
  CostValues values{};
  const auto own = std::span(values).first(basis.components());
  for (std::size_t f = 0; f < kFields; ++f)
    basis.add(f, parts[f].scale * (mesh.values[f][last] - mesh.values[f][0]), own);
  for (std::size_t f = 0; f < kFields; ++f)
    EXPECT_NEAR(basis.changeOf(f, own) / parts[f].scale, mesh.values[f][last] - mesh.values[f][0],
                0.1 * kMax)
        << f;
}

TEST(CostBasis, whatHardlyVariesTakesNoComponent) {
  const LatticeMesh mesh = cubeWith(
      4, 40, [](const Vector3& at, std::size_t f) { return f == 17 ? at[0] : 0.5 + 1e-3 * at[1]; });
  EXPECT_EQ(basisOf(mesh).components(), 1u);
}

TEST(CostBasis, theSameMeshGivesTheSameBasis) {
  const auto valueOf = [](const Vector3& at, std::size_t f) { return wanderingBump(at, f, 48); };
  const LatticeMesh mesh = cubeWith(6, 48, valueOf);
  const CostBasis a = basisOf(mesh), b = basisOf(mesh);
  ASSERT_EQ(a.components(), b.components());
  const std::vector<double> unit(a.components(), 1);
  for (std::size_t i = 0; i < 48; ++i) EXPECT_EQ(a.changeOf(i, unit), b.changeOf(i, unit));
}

/// A field's rms error at the base mesh, over its range.
double errorOf(const LatticeMesh& mesh, const LatticeMesh& base, std::size_t f) {
  LatticeMesh one = mesh, left = base;
  one.fields = {mesh.fields[f]}, one.values = {mesh.values[f]};
  left.fields = {base.fields[f]}, left.values = {base.values[f]};
  return testing::plainError(one, left, 3000).field;
}

TEST(CostBasis, noStepOfALongSeriesIsSimplifiedBlindly) {
  constexpr std::size_t kSteps = 60;
  const LatticeMesh mesh = cubeWith(
      12, kSteps, [](const Vector3& at, std::size_t f) { return wanderingBump(at, f, kSteps); });
  FusionOptions options;
  options.targetRatio = 0.05;
  const auto history = simplify(LatticeMesh(mesh), options);
  ASSERT_TRUE(history);
  const LatticeMesh base = testing::meshOfHistory(*history, 0);
  double least = 1, most = 0;
  for (std::size_t f = 0; f < kSteps; f += 3) {
    const double error = errorOf(mesh, base, f);
    least = std::min(least, error), most = std::max(most, error);
  }
  EXPECT_LT(most, 0.06);
  EXPECT_LT(most, 3 * least);
}

}  // namespace
}  // namespace qtet
