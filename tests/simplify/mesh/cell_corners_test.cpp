#include "simplify/mesh/cell_corners.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

TEST(CellCorners, areFoundWhicheverTheyAre) {
  const std::array<VertexId, 4> cell{5, 0, 0x80000000u, kGhost};
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_EQ(cornersThatAre(cell, cell[j]), 1u << j);
    EXPECT_EQ(onlyCorner(1u << j), j);
  }
  EXPECT_EQ(cornersThatAre(cell, 6), 0u);
}

TEST(CellCorners, theOthersOfTwoAndThreeAreGivenInTheirOrder) {
  EXPECT_EQ(kOtherCorners[0b0101].count, 2);
  EXPECT_EQ(kOtherCorners[0b0101].corner, (std::array<std::uint8_t, 2>{1, 3}));
  EXPECT_EQ(kOtherCorners[0b0111].count, 1);
  EXPECT_EQ(kOtherCorners[0b0111].corner[0], 3);
  EXPECT_EQ(kOtherCorners[0b1111].count, 0);
}

}  // namespace
}  // namespace qtet
