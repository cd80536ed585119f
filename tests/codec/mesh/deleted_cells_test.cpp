#include "codec/mesh/deleted_cells.h"

#include <gtest/gtest.h>

#include "tests/support/star_mesh.h"

namespace qtet {
namespace {

/// Without coder: no decision is asked where labels need no escape and no word has four letters.
struct Silent {
  [[maybe_unused]] static constexpr bool kEncoding = false;
  int bit(int, BitModel&) { return ADD_FAILURE() << "a decision is asked", 0; }
};

bool derives(testing::StarMesh& star, int k) {
  Silent coder;
  DeletedModels models;
  std::vector<LocalCell> out;
  return DeletedCells<Silent>(coder, models, star.link, k, {}, out).derive(false);
}

class EveryPrey : public ::testing::TestWithParam<int> {};

// A vertex without cells costs later levels time but no bytes: three hundred bytes more would give
// a million of them.
TEST_P(EveryPrey, hasACell) {
  const int k = GetParam();
  for (int used = 1; used < (k == 4 ? 3 : k); ++used) {
    testing::StarMesh star = testing::starMesh({64, 64, 64}, {8, 8, 8}, 8);
    std::vector<std::uint8_t> labels(star.link.triangles().size());
    if (used == 2) labels.front() = 1;
    testing::labelAs(star, labels);
    EXPECT_FALSE(derives(star, k)) << used << " labels are used";
  }
}

TEST_P(EveryPrey, mayHaveItsOnlyCellsAmongTheDeleted) {
  testing::StarMesh star = testing::starMesh({64, 64, 64}, {8, 8, 8}, 8);
  const int k = GetParam();
  std::vector<std::uint8_t> labels(star.link.triangles().size());
  // One triangle and a neighbour have labels of their own, so the three labels meet at two
  // vertices. Behind one of them lies a fourth prey vertex of k = 4, which no triangle carries.
  labels.front() = 1;
  if (k > 2) labels[star.link.triangles().front().neighbour[0]] = 2;
  testing::labelAs(star, labels);
  EXPECT_TRUE(derives(star, k));
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryPrey, ::testing::Values(2, 3, 4));

}  // namespace
}  // namespace qtet
