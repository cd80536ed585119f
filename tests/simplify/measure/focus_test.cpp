// The box of small cells, on blocks that are stretched away from their middle.
#include "simplify/measure/focus.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

constexpr int kSide = 12;  // less than a tenth of the cells are in an outermost layer

/// A block in the lattice's span, with layers that grow by `growth` from its middle on.
LatticeMesh stretched(double growth, int bits = 16) {
  LatticeMesh mesh = testing::gridMesh(kSide, 1);
  double most = 0;
  for (const LatticePoint& p : mesh.points)
    for (const std::int32_t x : p) most = std::max(most, double(x));
  for (LatticePoint& p : mesh.points)
    for (std::int32_t& x : p) {
      const double side = 2 * x / most - 1;  // -1 .. 1
      const double far = std::copysign(std::pow(std::abs(side), growth), side);
      x = static_cast<std::int32_t>((far + 1) / 2 * (std::ldexp(1.0, bits) - 1));
    }
  mesh.lattice.bits = bits;
  return mesh;
}

TEST(Focus, isNoneWhereCellsAreSpreadOverTheMesh) { EXPECT_FALSE(focusOf(stretched(1))); }

TEST(Focus, isABoxRoundTheSmallCellsWhateverTheLattice) {
  for (const int bits : {12, 16, 28}) {
    const std::optional<Focus> focus = focusOf(stretched(8, bits));
    ASSERT_TRUE(focus) << bits;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_LT((*focus)[axis], 1 << 15) << bits;
      EXPECT_GE((*focus)[axis + 3], 1 << 15) << bits;
      EXPECT_LT((*focus)[axis + 3] - (*focus)[axis], 1 << 14) << bits;
    }
  }
}

TEST(Focus, isNoneWhereAllCellsAreInOnePlace) {
  LatticeMesh mesh = stretched(1);
  for (LatticePoint& p : mesh.points) p = {7, 7, 7};
  EXPECT_FALSE(focusOf(mesh));
}

}  // namespace
}  // namespace qtet
