// How often each vertex came is what a map says, also where all of them want one place in the
// table.
#include "simplify/fuse/vertex_counts.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace qtet {
namespace {

using Taken = std::vector<std::pair<VertexId, std::uint32_t>>;

Taken taken(VertexCounts& counts) {
  Taken out;
  counts.take([&](VertexId v, std::uint32_t count) { out.emplace_back(v, count); });
  return out;
}

TEST(VertexCounts, countsInOrderOfFirstAppearance) {
  VertexCounts counts;
  EXPECT_TRUE(counts.add(7));
  EXPECT_TRUE(counts.add(0));
  EXPECT_FALSE(counts.add(7));
  EXPECT_EQ(counts.size(), 2u);
  EXPECT_EQ(taken(counts), (Taken{{7, 2}, {0, 1}}));
  EXPECT_EQ(counts.size(), 0u);
  EXPECT_TRUE(counts.add(7)) << "what was taken is forgotten";
  EXPECT_EQ(taken(counts), (Taken{{7, 1}}));
}

TEST(VertexCounts, holdsAsManyAsItSaysWhereverTheyFall) {
  VertexCounts counts;
  for (const VertexId stride : {1u, 1024u, 4096u, 8388607u}) {
    std::map<VertexId, std::uint32_t> expected;
    for (VertexId i = 0; i < 3 * VertexCounts::kMax; ++i) {
      const VertexId v = stride * (i % VertexCounts::kMax);
      EXPECT_EQ(counts.add(v), expected[v]++ == 0);
    }
    std::map<VertexId, std::uint32_t> found;
    for (const auto& [v, count] : taken(counts)) found[v] = count;
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace qtet
