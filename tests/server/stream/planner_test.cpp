#include "server/stream/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "codec/log/log_manifest.h"
#include "codec/log/target_choice.h"
#include "proto/limits.h"
#include "proto/messages.h"
#include "server/stream/client_blocks.h"
#include "server/stream/stream_limits.h"
#include "tests/server/store/synthetic_log.h"

namespace qtet {
namespace {

constexpr std::uint32_t kEverything = 0xFFFFFFFFu;

/// The index of a log as a server has it, and what a plan needs beside.
struct Planned {
  explicit Planned(const test::SyntheticLog& options)
      : index(test::makeIndex(options)), manifest(manifestOf(index).value()) {}

  [[nodiscard]] ClientBlocks blocks(const std::vector<std::uint32_t>& fields, std::uint32_t mesh,
                                    const std::vector<std::uint32_t>& have) const {
    ClientBlocks out(index, {fields});
    for (const std::size_t column : {kStructurePart, kPositionsPart}) out.addLeading(mesh, column);
    for (std::size_t f = 0; f < fields.size(); ++f) out.addLeading(have[f], kFirstFieldPart + f);
    return out;
  }
  [[nodiscard]] std::vector<BlockRun> plan(const ClientBlocks& blocks,
                                           std::uint32_t payload = kEverything,
                                           const Target& target = {}) const {
    StreamPlan plan(index, lastChunkFor(target, manifest, index).value(), payload);
    std::vector<BlockRun> out;
    while (const auto run = plan.next(blocks)) out.push_back(*run);
    return out;
  }
  [[nodiscard]] std::vector<std::uint32_t> chunks(const Target& target) const {
    std::vector<std::uint32_t> out;
    for (const BlockRun& run : plan(blocks({0}, 0, {0}), kEverything, target))
      if (out.empty() || out.back() != run.chunk) out.push_back(run.chunk);
    return out;
  }

  LogIndex index;
  Manifest manifest;
};

std::vector<std::uint32_t> upTo(std::uint32_t end) {
  std::vector<std::uint32_t> out(end);
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

Planned threeChunks() { return Planned({.chunks = 3}); }

TEST(Planner, aNewClientGetsEveryChunkWithItsFields) {
  const Planned log = threeChunks();
  EXPECT_EQ(log.plan(log.blocks({0, 1}, 0, {0, 0})),
            (std::vector<BlockRun>{{0, 0, 4}, {1, 0, 4}, {2, 0, 4}}));
}

TEST(Planner, fieldsThatNobodyAskedForSplitTheRuns) {
  const Planned log = threeChunks();
  EXPECT_EQ(
      log.plan(log.blocks({1}, 0, {0})),
      (std::vector<BlockRun>{{0, 0, 2}, {0, 3, 1}, {1, 0, 2}, {1, 3, 1}, {2, 0, 2}, {2, 3, 1}}));
}

TEST(Planner, aTurnEndsBeforeTheNextBegins) {
  const Planned log = threeChunks();
  ClientBlocks blocks(log.index, {{1}, {0}});
  EXPECT_EQ(log.plan(blocks), (std::vector<BlockRun>{{0, 0, 2},
                                                     {0, 3, 1},
                                                     {1, 0, 2},
                                                     {1, 3, 1},
                                                     {2, 0, 2},
                                                     {2, 3, 1},
                                                     {0, 2, 1},
                                                     {1, 2, 1},
                                                     {2, 2, 1}}));
}

TEST(Planner, aClientThatComesBackGetsOnlyTheRest) {
  const Planned log = threeChunks();
  EXPECT_EQ(log.plan(log.blocks({0}, 2, {2})), (std::vector<BlockRun>{{2, 0, 3}}));
}

TEST(Planner, aFieldThatLagsCatchesUpBeforeTheMeshGoesOn) {
  const Planned log = threeChunks();
  EXPECT_EQ(log.plan(log.blocks({0, 1}, 2, {1, 0})),
            (std::vector<BlockRun>{{0, 3, 1}, {1, 2, 2}, {2, 0, 4}}));
}

TEST(Planner, nothingIsPlannedForAClientThatHasEverything) {
  const Planned log = threeChunks();
  EXPECT_TRUE(log.plan(log.blocks({0, 1}, 3, {3, 3})).empty());
  EXPECT_TRUE(log.plan(log.blocks({}, 3, {})).empty());
}

TEST(Planner, aRunStaysWithinThePayloadOrIsOneBlock) {
  const Planned log({.chunks = 40});
  for (const std::uint32_t payload : {0u, 1u, 700u, 3000u, 20000u}) {
    for (const BlockRun& run : log.plan(log.blocks({0, 1}, 0, {0, 0}), payload)) {
      std::uint64_t bytes = 0;
      for (std::uint32_t part = run.firstPart; part < run.firstPart + std::uint32_t{run.parts};
           ++part)
        bytes += log.index.block(run.chunk, part).size;
      EXPECT_TRUE(bytes <= payload || run.parts == 1)
          << bytes << " bytes in " << run.parts << " parts at a payload of " << payload;
      EXPECT_EQ(sliceOf(log.index, run).size, bytes);
    }
  }
}

/// The blocks that a client has and those that it gets make the whole log. Each comes once and in
/// the file's order, so no field runs ahead.
void expectExactlyWhatIsMissing(const Planned& log, const ClientBlocks& before,
                                std::uint32_t payload) {
  ClientBlocks blocks = before;
  std::uint64_t end = 0;
  for (const BlockRun& run : log.plan(before, payload)) {
    EXPECT_GE(sliceOf(log.index, run).offset, end);
    end = sliceOf(log.index, run).offset + sliceOf(log.index, run).size;
    for (std::uint32_t part = run.firstPart; part < run.firstPart + std::uint32_t{run.parts};
         ++part) {
      EXPECT_FALSE(blocks.has(run.chunk, part)) << "sent twice";
      blocks.add(run.chunk, part);
    }
  }
  for (std::uint32_t c = 0; c < log.index.chunks.size(); ++c)
    for (std::size_t column = 0; column < blocks.columns(); ++column)
      EXPECT_TRUE(blocks.has(c, column)) << c << " " << column;
}

TEST(Planner, whatIsPlannedIsExactlyWhatIsMissing) {
  const Planned log({.chunks = 4});
  for (std::uint32_t mesh = 0; mesh <= 4; ++mesh)
    for (std::uint32_t a = 0; a <= mesh; ++a)
      for (std::uint32_t b = 0; b <= mesh; ++b)
        for (const std::uint32_t payload : {1000u, kEverything})
          expectExactlyWhatIsMissing(log, log.blocks({0, 1}, mesh, {a, b}), payload);
}

TEST(Planner, theBytesThatAreLackingAreThoseOfAllRuns) {
  const Planned log({.chunks = 4});
  for (std::uint32_t last = 0; last < 4; ++last) {
    const ClientBlocks blocks = log.blocks({0, 1}, 2, {1, 0});
    std::uint64_t bytes = 0;
    for (const BlockRun& run : log.plan(blocks, 1000, LevelTarget{last}))
      bytes += sliceOf(log.index, run).size;
    EXPECT_EQ(lackingBytes(log.index, blocks, last), bytes) << last;
  }
}

/// A frame each: as a list they would take 2.5 MB, and 80 MB in a log of 10,000 chunks.
TEST(Planner, aPlanOfTheMostFieldsKeepsNoFrames) {
  std::vector<std::string> names{"p", "velocity"};
  FieldTurns turns{{}};
  for (std::uint32_t f = 2; f < kMaxRequestFields + 2; ++f) {
    names.push_back("T@" + std::to_string(f));
    turns.push_back({f});
  }
  const test::SyntheticLog options{.chunks = 300, .fields = names, .largestBlock = 2};
  const LogIndex index = test::makeIndex(options);
  const ClientBlocks blocks(index, turns);
  StreamPlan plan(index, 299, limits::kFramePayload);
  std::size_t count = 0, bytes = 0;
  for (; plan.next(blocks); ++count) bytes = std::max(bytes, plan.bytes());
  EXPECT_EQ(count, 300 * (kMaxRequestFields + 1));
  EXPECT_LE(bytes, 2 * sizeof(std::size_t));
}

TEST(Planner, aTargetEndsAStream) {
  const Planned log({.chunks = 8, .errors = true});
  EXPECT_EQ(log.chunks(LevelTarget{0}), upTo(1));
  EXPECT_EQ(log.chunks(LevelTarget{99}), upTo(8));
  EXPECT_EQ(log.chunks(TetrahedraTarget{139}), upTo(4));
  EXPECT_EQ(log.chunks(TetrahedraTarget{140}), upTo(5));
  EXPECT_EQ(log.chunks(TetrahedraTarget{0}), upTo(1));
  const std::uint64_t five = log.index.chunks[5].offset;
  EXPECT_EQ(log.chunks(BytesTarget{five}), upTo(5));
  EXPECT_EQ(log.chunks(BytesTarget{five - 1}), upTo(4));
  EXPECT_EQ(log.chunks(BytesTarget{0}), upTo(1));
  EXPECT_EQ(log.chunks(FieldErrorTarget{0.126, "density"}), upTo(3));
  EXPECT_EQ(log.chunks(BoundaryErrorTarget{0.0626}), upTo(4));
  EXPECT_EQ(log.chunks(BoundaryErrorTarget{0}), upTo(8));
}

TEST(Planner, whereErrorsAreNotToldOnlyTheLastLevelIsKnownToBeGoodEnough) {
  EXPECT_EQ(Planned({.chunks = 8}).chunks(FieldErrorTarget{0.5, "density"}), upTo(8));
}

TEST(Planner, theSliceOfTheHeadEndsWhereTheFirstBlockStarts) {
  const Planned log = threeChunks();
  const BlockRun head{0, FrameHeader::kHead, 0};
  EXPECT_EQ(sliceOf(log.index, head).offset, 0u);
  EXPECT_EQ(sliceOf(log.index, head).size, log.index.chunks[0].offset);
}

}  // namespace
}  // namespace qtet
