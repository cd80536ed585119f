#include "simplify/mesh/history_levels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::gridMesh;
using testing::meshOfHistory;

FusionHistory sample() {
  auto history = simplify(gridMesh(6, 3), {});
  EXPECT_TRUE(history);
  return *history;
}

std::size_t liveCells(const FusionHistory& history) {
  return static_cast<std::size_t>(std::ranges::count(history.live, 1));
}

TEST(HistoryLevels, everyLevelIsTheMeshThatTheLogWouldGive) {
  FusionHistory history = sample();
  const FusionHistory untouched = history;
  HistoryLevels levels(history);
  ASSERT_GT(levels.finest(), 5u);
  for (std::uint32_t level = 0; level <= levels.finest(); ++level) {
    levels.moveTo(level);
    const LatticeMesh expected = meshOfHistory(untouched, level), met = meshOfHistory(history, 0);
    EXPECT_EQ(met.points, expected.points) << "level " << level;
    EXPECT_EQ(met.tetrahedra, expected.tetrahedra) << "level " << level;
    EXPECT_EQ(met.boundary, expected.boundary) << "level " << level;
  }
}

TEST(HistoryLevels, thereAndBackIsTheSameHistory) {
  FusionHistory history = sample();
  const FusionHistory untouched = history;
  HistoryLevels levels(history);
  levels.moveTo(levels.finest());
  EXPECT_EQ(liveCells(history), history.cells.size());
  EXPECT_NE(history.cells, untouched.cells);
  levels.moveTo(0);
  EXPECT_EQ(history.cells, untouched.cells);
  EXPECT_EQ(history.live, untouched.live);
}

TEST(HistoryLevels, aStepTellsItsFusions) {
  FusionHistory history = sample();
  HistoryLevels levels(history);
  std::size_t told = 0;
  for (std::uint32_t level = 0; level < levels.finest(); ++level) {
    for (const Fusion& fusion : levels.fusionsInto(level))
      EXPECT_EQ(fusion.level, levels.finest() - 1 - level);
    told += levels.fusionsInto(level).size();
  }
  EXPECT_EQ(told, history.fusions.size());
}

TEST(HistoryLevels, whatIsCoarserCanBeForgotten) {
  FusionHistory history = sample();
  const FusionHistory untouched = history;
  HistoryLevels levels(history);
  levels.moveTo(3);
  levels.forgetCoarser();
  EXPECT_EQ(levels.level(), 0u);
  EXPECT_EQ(levels.finest(), untouched.levels - 3);
  EXPECT_EQ(history.levels, untouched.levels - 3);
  EXPECT_LT(history.fusions.size(), untouched.fusions.size());
  EXPECT_LT(history.deletedCells.size(), untouched.deletedCells.size());
  for (std::uint32_t level = 0; level <= levels.finest(); ++level)
    EXPECT_EQ(meshOfHistory(history, level).tetrahedra,
              meshOfHistory(untouched, level + 3).tetrahedra)
        << "level " << level;
}

TEST(HistoryLevels, everythingCanBeForgotten) {
  FusionHistory history = sample();
  HistoryLevels levels(history);
  levels.moveTo(levels.finest());
  levels.forgetCoarser();
  EXPECT_EQ(history.levels, 0u);
  EXPECT_TRUE(history.fusions.empty());
  EXPECT_TRUE(history.affectedCells.empty());
}

}  // namespace
}  // namespace qtet
