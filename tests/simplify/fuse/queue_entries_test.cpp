#include "simplify/fuse/queue_entries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace qtet {
namespace {

// The entries that a comparison of all with all would keep.
std::vector<QueueEntry> cheapestOf(std::vector<QueueEntry> entries, float limit) {
  std::erase_if(entries, [&](const QueueEntry& e) { return e.key > limit; });
  std::ranges::sort(entries, [](const QueueEntry& a, const QueueEntry& b) { return b < a; });
  return entries;
}

float quantileOf(const std::vector<QueueEntry>& entries, double quantile) {
  std::vector<float> keys;
  for (const QueueEntry& e : entries) keys.push_back(e.key);
  std::ranges::sort(keys);
  return keys[static_cast<std::size_t>(quantile * static_cast<double>(keys.size() - 1))];
}

TEST(EntrySorter, keepsWhatSortingKeepsInItsOrder) {
  std::mt19937 random(3);
  EntrySorter sorter;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<QueueEntry> entries(1 + random() % 400);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const float key = trial % 3 == 0   ? static_cast<float>(random() % 5)
                        : trial % 3 == 1 ? 1e-20f * static_cast<float>(random())
                                         : 1e-3f * static_cast<float>(random()) - 1e6f;
      entries[i] = {key, static_cast<VertexId>(3 * i)};
    }
    const double quantile = static_cast<double>(random() % 101) / 100;
    const float limit = quantileOf(entries, quantile);
    const auto expected = cheapestOf(entries, limit);
    EXPECT_EQ(sorter.keepCheapest(entries, quantile), limit);
    ASSERT_EQ(entries.size(), expected.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      ASSERT_EQ(entries[i].owner, expected[i].owner) << trial << ", " << i;
      ASSERT_EQ(entries[i].key, expected[i].key) << trial << ", " << i;
    }
  }
}

TEST(EntrySorter, bothZerosAreOneKey) {
  std::vector<QueueEntry> entries{{0.0f, 1}, {-0.0f, 2}, {1.0f, 3}, {0.0f, 4}};
  EXPECT_EQ(EntrySorter().keepCheapest(entries, 0), 0.0f);
  ASSERT_EQ(entries.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(entries[i].owner, (std::array<VertexId, 3>{1, 2, 4})[i]);
}

}  // namespace
}  // namespace qtet
