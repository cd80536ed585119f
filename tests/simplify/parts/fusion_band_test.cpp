#include "simplify/parts/fusion_band.h"

#include <gtest/gtest.h>

#include "tests/simplify/parts/small_parts.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using Numbers = std::vector<std::vector<std::uint32_t>>;

TEST(FusionBand, levelsOfPartsComeByTheirKeys) {
  // 100 cells, so that a level of the whole ends at five
  const std::vector<std::vector<PartLevel>> parts{
      {{1, 1, 3}, {2, 1, 3}, {8, 1, 9}},
      {{1, 1, 3}, {4, 1, 3}, {3, 1, 5}},  // the last one is as dear as the one before it
      {}};
  EXPECT_EQ(levelsOfTheWhole(parts, 100), (Numbers{{0, 1, 3}, {0, 1, 2}, {}}));
}

TEST(FusionBand, aPartsLevelsNeverShareOneOfTheWhole) {
  const std::vector<std::vector<PartLevel>> parts{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
  EXPECT_EQ(levelsOfTheWhole(parts, 1000), (Numbers{{0, 1, 2}}));
}

/// The mesh of a part under simplification, and the whole whose other vertices are kept.
class PartAndWhole : public ::testing::Test {
 protected:
  PartAndWhole() {
    options_.envelopeTolerance = 0.02;
    options_.targetRatio = 0;
  }

  struct Whole {
    Whole(const LatticeMesh& mesh, const FusionOptions& options)
        : state(mesh, FusionMesh::kNoRegions, options.cost, workers), frame(mesh, state, options) {}
    Workers workers{1};
    FusionState state;
    FusionFrame frame;
    std::uint32_t levels = 0;

    CutMesh cut(std::uint32_t band, std::span<const std::uint8_t> old) {
      return cutMesh(state.mesh(), testing::compactParts, 900, band, old, workers);
    }
  };

  void expectTheSameOfEachPart(Whole& whole, const CutMesh& cut, std::uint32_t bandsBefore) {
    for (const std::vector<CellId>& cells : cut.parts) {
      const PartEnd end{.key = 1e6f, .leastShare = 0};
      PartNumbers numbers(whole.state.mesh().vertexSlots(), kGhost);
      const PartFusions alone =
          fusePart(whole.state, whole.frame, options_, cells, cut.isSeam, end, numbers);
      EXPECT_EQ(numbers, PartNumbers(numbers.size(), kGhost));
      Whole other(mesh_, options_);
      CutMesh again;
      for (std::uint32_t band = 0; band < bandsBefore; ++band) {
        again = other.cut(band, again.isSeam);
        other.levels =
            fuseBand(other.state, other.frame, options_, other.workers, again, 0, other.levels);
      }
      expectTheSame(alone, cells, cut, other);
    }
  }

  void expectTheSame(const PartFusions& alone, const std::vector<CellId>& cells, const CutMesh& cut,
                     Whole& other) {
    const auto slots = static_cast<VertexId>(other.state.mesh().vertexSlots());
    std::vector<std::uint8_t> isMine(slots, 0);
    for (const CellId c : cells)
      for (const VertexId v : other.state.mesh().cell(c)) isMine[v] = 1;
    std::vector<VertexId> others;
    for (VertexId v = 0; v < slots; ++v)
      if (other.state.mesh().alive(v) && (!isMine[v] || cut.isSeam[v])) others.push_back(v);
    other.state.keep(others);
    const std::size_t before = other.state.mesh().fusions();
    const PartLevels done = FusionLoop(other.state, other.frame, options_, other.workers)
                                .runPart({.key = 1e6f, .leastShare = 0}, {.isSeam = cut.isSeam});
    ASSERT_GT(alone.history.fusions.size(), 10u);
    EXPECT_EQ(alone.done.levels.size(), done.levels.size());
    const FusionHistory all =
        other.state.takeHistory(other.levels + static_cast<std::uint32_t>(done.levels.size()));
    std::vector<VertexId> numbers = alone.vertices;
    for (std::size_t i = 0; i < alone.history.fusions.size(); ++i) {
      ASSERT_LT(before + i, all.fusions.size());
      const Fusion &own = alone.history.fusions[i], &there = all.fusions[before + i];
      ASSERT_EQ(own.k, there.k) << i;
      for (std::size_t p = 0; p < own.k; ++p) ASSERT_EQ(numbers[own.prey[p]], there.prey[p]) << i;
      ASSERT_EQ(alone.history.points[own.fused], all.points[there.fused]) << i;
      numbers.push_back(there.fused);
    }
    EXPECT_EQ(before + alone.history.fusions.size(), all.fusions.size());
  }

  LatticeMesh mesh_ = testing::gridMesh(9, 3);
  FusionOptions options_;
};

TEST_F(PartAndWhole, aPartAloneHasTheFusionsThatItHasInTheWhole) {
  Whole whole(mesh_, options_);
  CutMesh cut = whole.cut(0, {});
  ASSERT_GT(cut.parts.size(), 4u);
  expectTheSameOfEachPart(whole, cut, 0);
  whole.levels = fuseBand(whole.state, whole.frame, options_, whole.workers, cut, 0, whole.levels);
  cut = whole.cut(1, cut.isSeam);
  ASSERT_GT(cut.parts.size(), 1u);
  expectTheSameOfEachPart(whole, cut, 1);
}

}  // namespace
}  // namespace qtet
