#include "simplify/legality/local_vertices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

namespace qtet {
namespace {

TEST(LocalVertices, areNumberedInTheOrderOfTheirFirstAppearanceStarAfterStar) {
  std::mt19937 random(11);
  const auto vertices = std::make_unique<LocalVertices>();
  for (int star = 0; star < 2000; ++star) {
    vertices->clear();
    EXPECT_TRUE(vertices->ids().empty());
    std::vector<VertexId> seen;
    for (auto i = random() % 300; i > 0; --i) {
      // Multiples of a power of two, which a hash is most likely to put in one place.
      const VertexId v =
          random() % 40 == 0 ? kGhost : static_cast<VertexId>(random() % 200) << (star % 20);
      const auto at = std::ranges::find(seen, v);
      const auto expected = static_cast<std::uint32_t>(at - seen.begin());
      if (at == seen.end()) seen.push_back(v);
      ASSERT_EQ(vertices->intern(v), expected);
    }
    ASSERT_TRUE(std::ranges::equal(vertices->ids(), seen));
  }
}

TEST(LocalVertices, thatAreAddedInOneGoAreNumberedOnFromThoseBefore) {
  const auto vertices = std::make_unique<LocalVertices>();
  EXPECT_EQ(vertices->intern(7), 0u);
  {
    LocalVertices::Adding adding(*vertices);
    EXPECT_EQ(adding.intern(9), 1u);
    EXPECT_EQ(adding.intern(7), 0u);
  }
  EXPECT_EQ(vertices->intern(9), 1u);
  EXPECT_EQ(vertices->ids().size(), 2u);
}

}  // namespace
}  // namespace qtet
