#include "server/planner.h"

#include <gtest/gtest.h>

#include "proto/messages.h"
#include "tests/server/synthetic_log.h"

namespace qtet {
namespace {

constexpr std::uint32_t kEverything = 0xFFFFFFFFu;
constexpr BlockRun kHeadRun{0, FrameHeader::kHead, 0};

LogIndex threeChunks() { return test::makeIndex({.chunks = 3}); }

TEST(Planner, aNewClientGetsTheHeadAndThenEveryChunkWithItsFields) {
  const auto plan = planStream(threeChunks(), {{0, 1}, 0, {0, 0}}, kEverything);
  EXPECT_EQ(plan, (std::vector<BlockRun>{kHeadRun, {0, 0, 4}, {1, 0, 4}, {2, 0, 4}}));
}

TEST(Planner, fieldsThatNobodyAskedForSplitTheRuns) {
  const auto plan = planStream(threeChunks(), {{1}, 0, {0}}, kEverything);
  EXPECT_EQ(plan, (std::vector<BlockRun>{kHeadRun, {0, 0, 2}, {0, 3, 1}, {1, 0, 2}, {1, 3, 1}, {2, 0, 2}, {2, 3, 1}}));
}

TEST(Planner, aClientThatComesBackGetsNoHeadAndOnlyTheRest) {
  const auto plan = planStream(threeChunks(), {{0}, 2, {2}}, kEverything);
  EXPECT_EQ(plan, (std::vector<BlockRun>{{2, 0, 3}}));
}

TEST(Planner, aFieldThatLagsCatchesUpBeforeTheMeshGoesOn) {
  const auto plan = planStream(threeChunks(), {{0, 1}, 2, {1, 0}}, kEverything);
  EXPECT_EQ(plan, (std::vector<BlockRun>{{0, 3, 1}, {1, 2, 2}, {2, 0, 4}}));
}

TEST(Planner, nothingIsPlannedForAClientThatHasEverything) {
  EXPECT_TRUE(planStream(threeChunks(), {{0, 1}, 3, {3, 3}}, kEverything).empty());
  EXPECT_TRUE(planStream(threeChunks(), {{}, 3, {}}, kEverything).empty());
}

TEST(Planner, aNewFieldOfACompleteMeshIsSentAlone) {
  const auto plan = planStream(threeChunks(), {{1}, 3, {0}}, kEverything);
  EXPECT_EQ(plan, (std::vector<BlockRun>{{0, 3, 1}, {1, 3, 1}, {2, 3, 1}}));
}

TEST(Planner, aRunStaysWithinThePayloadOrIsOneBlock) {
  const LogIndex index = test::makeIndex({.chunks = 40});
  for (const std::uint32_t payload : {0u, 1u, 700u, 3000u, 20000u}) {
    for (const BlockRun& run : planStream(index, {{0, 1}, 0, {0, 0}}, payload)) {
      if (run == kHeadRun) continue;
      std::uint64_t bytes = 0;
      for (std::uint32_t part = run.firstPart; part < run.firstPart + std::uint32_t{run.parts}; ++part)
        bytes += index.block(run.chunk, part).size;
      EXPECT_TRUE(bytes <= payload || run.parts == 1) << bytes << " bytes in " << run.parts << " parts at a payload of " << payload;
      EXPECT_EQ(sliceOf(index, run).size, bytes);
    }
  }
}

/// Every state that a client can be in, of a small log: what it has and what it gets make the whole, each block once.
TEST(Planner, whatIsPlannedIsExactlyWhatIsMissing) {
  const LogIndex index = test::makeIndex({.chunks = 4});
  for (std::uint32_t mesh = 0; mesh <= 4; ++mesh)
    for (std::uint32_t a = 0; a <= mesh; ++a)
      for (std::uint32_t b = 0; b <= mesh; ++b)
        for (const std::uint32_t payload : {1000u, kEverything}) {
          std::vector<std::vector<int>> blocks(4, std::vector<int>(4, 0));
          for (std::uint32_t c = 0; c < 4; ++c) blocks[c] = {c < mesh, c < mesh, c < a, c < b};
          std::uint32_t meshSent = mesh;
          for (const BlockRun& run : planStream(index, {{0, 1}, mesh, {a, b}}, payload)) {
            if (run == kHeadRun) continue;
            for (std::uint32_t part = run.firstPart; part < run.firstPart + std::uint32_t{run.parts}; ++part) {
              ++blocks[run.chunk][part];
              if (part == kPositionsPart) meshSent = run.chunk + 1;
              EXPECT_LT(run.chunk, meshSent + (part < kFirstFieldPart ? 1 : 0)) << "a field ahead of its mesh";
            }
          }
          EXPECT_EQ(blocks, std::vector(4, std::vector<int>(4, 1)));
        }
}

TEST(Planner, theSliceOfTheHeadEndsWhereTheFirstBlockStarts) {
  const LogIndex index = threeChunks();
  EXPECT_EQ(sliceOf(index, kHeadRun).offset, 0u);
  EXPECT_EQ(sliceOf(index, kHeadRun).size, index.chunks[0].offset);
}

}  // namespace
}  // namespace qtet
