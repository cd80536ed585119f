// The most that simplification may lose, on samples that the tool makes itself: committed figures,
// measured by tests/support/plain_error.h. The same bits everywhere, so a figure that gets worse is
// a decision that changed. Better figures: commit them.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

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
  return {100 * error.field, 100 * error.wall, 100 * error.hausdorff,
          testing::angleAt(level, 0.001), history->levels};
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
}

// A boundary that is where it was to a lattice step: 0.0009 % of the box's diagonal.
INSTANTIATE_TEST_SUITE_P(Samples, Quality,
                         ::testing::Values(Floor{"box", 50, {0.2198, 0.2896, 0.0009, 18.49, 9}},
                                           Floor{"box", 90, {1.4344, 1.6315, 0.0027, 8.44, 28}},
                                           Floor{"box", 99, {5.3749, 6.8398, 12.519, 4.30, 50}},
                                           Floor{"fin", 50, {0.03294, 0.03268, 0.0110, 2.59, 17}},
                                           Floor{"fin", 90, {0.30422, 0.51252, 0.1483, 1.36, 48}},
                                           Floor{"fin", 99, {1.45529, 3.23954, 0.8126, 0.478, 86}}),
                         [](const auto& floor) { return ::testing::PrintToString(floor.param); });

}  // namespace
}  // namespace qtet
