// The most that simplification may lose, on samples that the tool makes itself: committed figures,
// measured by tests/support/plain_error.h. The same bits everywhere, so a figure that gets worse is
// a decision that changed. Better figures: commit them.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "codec/mesh/predicates.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/quantise.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/samples/samples.h"
#include "tests/support/meshes.h"
#include "tests/support/plain_error.h"

namespace qtet {
namespace {

// How much worse than committed a figure may be.
constexpr double kMargin = 1.03;
constexpr std::size_t kSamples = 5000;

/// The figures are in per cent of the fields' ranges and of the diagonal; angles in degrees.
struct Figures {
  double field, wall, hausdorff;
  double thinAngle;  ///< a thousandth of all angles between faces is smaller
  std::uint32_t levels;
  double volume;  ///< per cent of the original's
};

struct Floor {
  const char* sample;
  int removed;  // per cent
  Figures committed;
};
std::ostream& operator<<(std::ostream& out, const Floor& floor) {
  return out << floor.sample << floor.removed;
}

class Quality : public ::testing::TestWithParam<Floor> {};

TEST(PlainError, isWhatAMeshWasChangedBy) {
  const LatticeMesh original = testing::gridMesh(6, 1);
  const testing::PlainError none = testing::plainError(original, original, 500);
  EXPECT_NEAR(none.field, 0, 1e-9);
  EXPECT_NEAR(none.wall, 0, 1e-9);
  EXPECT_EQ(none.hausdorff, 0);

  LatticeMesh raised = original;
  for (std::size_t f = 0; f < raised.fields.size(); ++f) {
    FieldInfo& field = raised.fields[f];
    const double tenth = 0.1 * (field.range[1] - field.range[0]) / field.step;
    for (std::int32_t& value : raised.values[f]) value += static_cast<std::int32_t>(tenth);
  }
  const testing::PlainError tenth = testing::plainError(original, raised, 500);
  EXPECT_NEAR(tenth.field, 0.1, 0.001);
  EXPECT_NEAR(tenth.wall, 0.1, 0.001);

  LatticeMesh moved = original;
  for (LatticePoint& p : moved.points) p[0] += 10;
  const double edge = 6 * 64;
  EXPECT_NEAR(testing::plainError(original, moved, 500).hausdorff, 10 / (std::sqrt(3.0) * edge),
              1e-9);
}

double sixVolumes(const LatticeMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    sum += static_cast<double>(
        volume6(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]));
  return sum;
}

Figures figuresOf(const Floor& floor) {
  Result<TetMesh> mesh = makeSample(floor.sample);
  EXPECT_TRUE(mesh && cleanMesh(*mesh));
  const Result<QuantisedMesh> quantised = quantise(*mesh);
  FusionOptions options;
  options.targetRatio = 1 - 0.01 * floor.removed;
  const Result<FusionHistory> history = simplify(quantised->mesh, options);
  const LatticeMesh level = testing::meshOfHistory(*history, 0);
  const double target =
      *options.targetRatio * static_cast<double>(quantised->mesh.tetrahedra.size());
  EXPECT_LE(static_cast<double>(level.tetrahedra.size()), std::ceil(target));
  const testing::PlainError error = testing::plainError(quantised->mesh, level, kSamples);
  return {100 * error.field,     100 * error.wall,
          100 * error.hausdorff, testing::angleAt(level, 0.001),
          history->levels,       100 * sixVolumes(level) / sixVolumes(quantised->mesh)};
}

TEST_P(Quality, isNoWorseThanCommitted) {
  const Figures now = figuresOf(GetParam()), &then = GetParam().committed;
  EXPECT_LE(now.field, kMargin * then.field) << "rms of the fields over the volume";
  EXPECT_LE(now.wall, kMargin * then.wall) << "rms of the fields on the boundary";
  EXPECT_LE(now.hausdorff, kMargin * then.hausdorff) << "Hausdorff distance of the boundary";
  EXPECT_GE(now.thinAngle, then.thinAngle / kMargin) << "thin cells";
  EXPECT_GE(static_cast<double>(now.levels), then.levels / kMargin)
      << "a level fuses what waits for cheaper fusions, or could";
  EXPECT_LE(static_cast<double>(now.levels), kMargin * then.levels) << "each takes a frame";
  EXPECT_NEAR(now.volume, then.volume, (kMargin - 1) * (100 - then.volume) + 0.01);
}

// A boundary that is where it was to a lattice step: 0.0009 % of the box's diagonal.
INSTANTIATE_TEST_SUITE_P(
    Samples, Quality,
    ::testing::Values(Floor{"box", 50, {0.2199, 0.2896, 0.0009, 18.49, 9, 100}},
                      Floor{"box", 90, {1.4344, 1.6315, 0.0009, 8.44, 28, 100}},
                      Floor{"box", 99, {5.1926, 5.6793, 0.3316, 8.46, 47, 99.896}},
                      Floor{"fin", 50, {0.03124, 0.03147, 0.0109, 2.55, 17, 100}},
                      Floor{"fin", 90, {0.30122, 0.39687, 0.1019, 1.356, 48, 99.994}},
                      Floor{"fin", 99, {1.52169, 3.15888, 0.4574, 0.685, 86, 99.866}}),
    [](const auto& floor) { return ::testing::PrintToString(floor.param); });

}  // namespace
}  // namespace qtet
