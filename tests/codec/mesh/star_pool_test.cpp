#include <gtest/gtest.h>

#include <map>
#include <random>

#include "codec/mesh/star_pool.h"

namespace qtet {
namespace {

TEST(StarPool, aRunHasOneCellMoreThanAskedForAtLeast) {
  for (std::uint32_t cells = 0; cells < 100; ++cells) {
    const std::uint32_t room = StarPool::unitsFor(cells) * StarPool::kUnit;
    EXPECT_GT(room, cells);
    EXPECT_LE(room, cells + StarPool::kUnit);
  }
}

TEST(StarPool, runsNeverOverlapAndAreUsedAgain) {
  StarPool pool;
  std::map<std::uint32_t, std::uint32_t> taken;  // first unit -> units
  std::mt19937 random(1);
  std::uint32_t end = 0;
  for (int step = 0; step < 20'000; ++step) {
    if (taken.size() < 50) {
      const std::uint32_t units = 1 + static_cast<std::uint32_t>(random() % 6);
      const std::uint32_t first = pool.take(units);
      const auto after = taken.lower_bound(first);
      if (after != taken.end()) {
        ASSERT_LE(first + units, after->first);
      }
      if (after != taken.begin()) {
        ASSERT_GE(first, std::prev(after)->first + std::prev(after)->second);
      }
      for (std::uint32_t i = 0; i < units * StarPool::kUnit; ++i) pool.at(first)[i] = first;
      taken[first] = units;
      end = std::max(end, first + units);
    } else {
      const auto one =
          std::next(taken.begin(), static_cast<std::ptrdiff_t>(random() % taken.size()));
      for (std::uint32_t i = 0; i < one->second * StarPool::kUnit; ++i)
        ASSERT_EQ(pool.at(one->first)[i], one->first) << "somebody else wrote here";
      pool.give(one->first, one->second);
      taken.erase(one);
    }
  }
  EXPECT_LE(end, 2u * 50 * 6) << "10,000 runs were taken, 50 at a time";
}

}  // namespace
}  // namespace qtet
