#include "server/stream/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "codec/log/log_manifest.h"
#include "proto/messages.h"
#include "server/store/packet_intervals.h"
#include "server/stream/client_blocks.h"
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
    ClientBlocks out(index, fields);
    for (const std::size_t column : {kStructurePart, kPositionsPart})
      out.add(HeldChunks{mesh}, column);
    for (std::size_t f = 0; f < fields.size(); ++f)
      out.add(HeldChunks{have[f]}, kFirstFieldPart + f);
    return out;
  }
  [[nodiscard]] std::vector<BlockRun> plan(const ClientBlocks& blocks,
                                           std::uint32_t payload = kEverything,
                                           const View& view = {}, const Target& target = {}) const {
    return planStream({index, manifest, intervals ? &*intervals : nullptr}, blocks, view,
                      chunksFor(target, manifest, index).value(), payload);
  }
  [[nodiscard]] std::vector<std::uint32_t> chunks(const View& view,
                                                  const Target& target = {}) const {
    return chunks(blocks({0}, 0, {0}), view, target);
  }
  [[nodiscard]] std::vector<std::uint32_t> chunks(const ClientBlocks& blocks, const View& view,
                                                  const Target& target = {}) const {
    std::vector<std::uint32_t> out;
    for (const BlockRun& run : plan(blocks, kEverything, view, target))
      if (out.empty() || out.back() != run.chunk) out.push_back(run.chunk);
    return out;
  }

  LogIndex index;
  Manifest manifest;
  std::optional<PacketIntervals> intervals{};
};

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> chunks) {
  std::ranges::sort(chunks);
  return chunks;
}

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

/// Tries every state of a client of a small log. The blocks that it has and those that it gets make
/// the whole log, each block once, and no field runs ahead.
void expectExactlyWhatIsMissing(const Planned& log, const ClientBlocks& before,
                                std::uint32_t payload, const View& view) {
  ClientBlocks blocks = before;
  for (const BlockRun& run : log.plan(before, payload, view)) {
    for (std::uint32_t part = run.firstPart; part < run.firstPart + std::uint32_t{run.parts};
         ++part) {
      EXPECT_FALSE(blocks.has(run.chunk, part)) << "sent twice";
      blocks.add(run.chunk, part);
      EXPECT_TRUE(part < kFirstFieldPart || blocks.hasMesh(run.chunk))
          << "a field ahead of its mesh";
    }
    const ChunkEntry& chunk = log.index.chunks[run.chunk];
    for (std::uint32_t d = 0; d < chunk.dependencyCount; ++d)
      EXPECT_TRUE(blocks.hasAll(log.index.dependencies[chunk.firstDependency + d]))
          << "chunk " << run.chunk << " before what it depends on";
  }
  for (std::uint32_t c = 0; c < log.index.chunks.size(); ++c) EXPECT_TRUE(blocks.hasAll(c)) << c;
}

TEST(Planner, whatIsPlannedIsExactlyWhatIsMissing) {
  const Planned log({.chunks = 4});
  for (std::uint32_t mesh = 0; mesh <= 4; ++mesh)
    for (std::uint32_t a = 0; a <= mesh; ++a)
      for (std::uint32_t b = 0; b <= mesh; ++b)
        for (const std::uint32_t payload : {1000u, kEverything})
          expectExactlyWhatIsMissing(log, log.blocks({0, 1}, mesh, {a, b}), payload, {});
}

TEST(Planner, packetsOfAnyStateComeBehindTheirParentsEachBlockOnce) {
  const Planned log({.chunks = 2, .bands = 3, .errors = true});
  ASSERT_EQ(log.index.chunks.size(), 16u);
  ASSERT_EQ(log.index.dependencies.size(), 15u);
  std::uint32_t state = 1;
  for (int round = 0; round < 300; ++round) {
    ClientBlocks blocks = log.blocks({0, 1}, 2, {2, 2});
    for (std::uint32_t c = 2; c < 16; ++c) {  // a set closed under dependencies, its fields too
      state = state * 1664525u + 1013904223u;
      const ChunkEntry& chunk = log.index.chunks[c];
      const std::uint32_t parent = log.index.dependencies[chunk.firstDependency];
      if (!blocks.hasMesh(parent) || (state >> 30) == 0) continue;
      blocks.add(c, kStructurePart), blocks.add(c, kPositionsPart);
      if (blocks.has(parent, 2) && (state >> 29 & 1) != 0) blocks.add(c, 2);
      if (blocks.has(parent, 3) && (state >> 28 & 1) != 0) blocks.add(c, 3);
    }
    const double x = (state >> 8 & 0xFF) * 256.0;
    expectExactlyWhatIsMissing(log, blocks, round % 2 == 0 ? 1000u : kEverything,
                               {.box = std::array<double, 6>{x, 0, 0, x, 65536, 65536}});
  }
}

// The lattice of a synthetic log has 16 bits, a step of 1 and its origin at 0: 65536 a side. Two
// chunks of head, then nodes 2..15 are chunks 2..15.

TEST(Planner, aBoxBringsItsPacketsWithTheirAncestorsFirst) {
  const Planned log({.chunks = 2, .bands = 3, .errors = true});
  const View corner{.box = std::array<double, 6>{0, 0, 0, 100, 100, 100}};
  const auto order = log.chunks(corner);
  EXPECT_EQ(order.size(), 16u);
  EXPECT_EQ(std::vector(order.begin(), order.begin() + 5),
            (std::vector<std::uint32_t>{0, 1, 2, 4, 8}));
  EXPECT_EQ(log.chunks(corner, LevelTarget{4}), (std::vector<std::uint32_t>{0, 1, 2, 4, 8}))
      << "a level is wanted of what is looked at alone";
  EXPECT_EQ(log.chunks(corner, LevelTarget{3}), (std::vector<std::uint32_t>{0, 1, 2, 4}));
}

TEST(Planner, aClipPlaneWantsWhatItCutsAndAFrustumWhatItSees) {
  const Planned log({.chunks = 2, .bands = 3, .errors = true});
  const View cut{.planes = {{1, 0, 0, -60000}}};  // x = 60000: the second half of x, node 3
  EXPECT_EQ(sorted(log.chunks(cut, LevelTarget{4})),
            (std::vector<std::uint32_t>{0, 1, 3, 6, 7, 12, 13, 14, 15}));
  // x <= 30000, on y = 60000
  const View seen{.frustum = {{-1, 0, 0, 30000}}, .planes = {{0, 1, 0, -60000}}};
  EXPECT_EQ(sorted(log.chunks(seen, LevelTarget{4})),
            (std::vector<std::uint32_t>{0, 1, 2, 5, 10, 11}));
  const auto order = log.chunks(seen);
  EXPECT_EQ(sorted({order.begin() + 6, order.begin() + 9}), (std::vector<std::uint32_t>{4, 8, 9}))
      << "then what is seen";
}

TEST(Planner, ofEqualPacketsTheNearerComesFirst) {
  const Planned log({.chunks = 1, .bands = 1, .errors = true});
  for (const double x : {1000.0, 64000.0}) {
    const auto order =
        log.chunks(log.blocks({}, 0, {}), View{.point = std::array<double, 3>{x, 1000, 1000}});
    EXPECT_EQ(order, x < 32768 ? (std::vector<std::uint32_t>{0, 1, 2})
                               : (std::vector<std::uint32_t>{0, 2, 1}));
  }
}

/// Both packets of a band take as much error away; the smaller one does so for less.
TEST(Planner, errorPerByteDecidesWithoutAViewRequest) {
  int seconds = 0;
  for (std::uint32_t seed = 1; seed <= 16; ++seed) {
    const Planned log({.chunks = 1, .seed = seed, .bands = 1, .errors = true});
    const ClientBlocks blocks = log.blocks({0}, 0, {0});
    ASSERT_NE(blocks.missingBytes(1), blocks.missingBytes(2));
    const auto smaller = blocks.missingBytes(1) < blocks.missingBytes(2) ? 1u : 2u;
    seconds += smaller == 2;
    EXPECT_EQ(log.chunks({}), (std::vector<std::uint32_t>{0, smaller, 3 - smaller})) << seed;
  }
  EXPECT_GT(seconds, 0) << "the file's order would do as well";
}

/// Gives a chunk `records` records, in `bytes` bytes with all its fields.
void setSize(Planned& log, std::uint32_t chunk, std::uint32_t records, std::uint32_t bytes) {
  ChunkEntry& entry = log.index.chunks[chunk];
  entry.records = records;
  for (BlockEntry& block : entry.blocks) block.size = 0;
  entry.blocks[kStructurePart].size = bytes;
}

/// A band's gain is divided among its packets by their records.
TEST(Planner, ofABandWhoHasMoreRecordsForAByteComesFirst) {
  Planned log({.chunks = 1, .bands = 1, .errors = true});
  const auto firstOf = [&](std::uint32_t records1, std::uint32_t bytes1, std::uint32_t records2,
                           std::uint32_t bytes2) {
    setSize(log, 1, records1, bytes1);
    setSize(log, 2, records2, bytes2);
    return log.chunks({}).at(1);
  };
  EXPECT_EQ(firstOf(10, 5000, 10, 5000), 1u) << "the file's order";
  EXPECT_EQ(firstOf(10, 5000, 11, 5000), 2u);
  EXPECT_EQ(firstOf(11, 5000, 10, 5000), 1u);
  EXPECT_EQ(firstOf(10, 5000, 30, 10000), 2u) << "three times the records for twice the bytes";
  EXPECT_EQ(firstOf(10, 5000, 30, 20000), 1u) << "three times the records for four times the bytes";
}

/// The first band takes .1875 of squared error away and the second .0625, whatever records they
/// have.
TEST(Planner, aPacketsShareIsThatOfItsOwnBand) {
  Planned log({.chunks = 1, .bands = 2, .errors = true});
  const auto orderFor = [&](std::uint32_t recordsOfNode3) {
    setSize(log, 1, 100 - recordsOfNode3, 5000);  // node 2
    setSize(log, 2, recordsOfNode3, 5000);        // node 3
    for (std::uint32_t chunk = 3; chunk < 7; ++chunk) setSize(log, chunk, 1000, 5000);
    return log.chunks({});
  };
  EXPECT_EQ(orderFor(40), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6}))
      << "40 % of .1875 is more than 25 % of .0625";
  EXPECT_EQ(orderFor(5), (std::vector<std::uint32_t>{0, 1, 3, 4, 2, 5, 6})) << "5 % is less";
}

TEST(Planner, fieldsOfWhatIsThereComeBeforeNewPacketsOfTheSameTier) {
  const Planned log({.chunks = 1, .bands = 2, .errors = true});
  ClientBlocks blocks = log.blocks({0}, 1, {0});
  for (const std::uint32_t c : {1u, 3u})
    blocks.add(c, kStructurePart), blocks.add(c, kPositionsPart);
  const auto order = log.chunks(blocks, {});
  EXPECT_EQ(std::vector(order.begin(), order.begin() + 3), (std::vector<std::uint32_t>{0, 1, 3}));
}

/// Nodes 8..15 of the last band hold the values 8..8.9, 9..9.9 and so on of "density", their
/// parents what they hold.
Planned withValues() {
  Planned out({.chunks = 2, .bands = 3, .errors = true});
  const std::size_t columns = PacketIntervals::columnsOf(out.manifest);
  std::vector<ValueInterval> values(out.index.chunks.size() * columns);
  for (std::uint32_t node = 15; node > 1; --node) {
    if (node >= 8) values[node * columns].add({double(node), node + 0.9});
    if (node >= 4) values[node / 2 * columns].add(values[node * columns]);
  }
  out.intervals.emplace(out.manifest, std::move(values));
  return out;
}

TEST(Planner, anIsovalueBringsThePacketsThatItsSurfaceMeetsFirst) {
  const Planned log = withValues();
  const View view{.isovalue = Isovalue{"density", {}, {12.5}}};
  const auto order = log.chunks(view);
  EXPECT_EQ(order.size(), 16u);
  EXPECT_EQ(std::vector(order.begin(), order.begin() + 5),
            (std::vector<std::uint32_t>{0, 1, 3, 6, 12}));
  EXPECT_EQ(log.chunks(view, LevelTarget{4}), (std::vector<std::uint32_t>{0, 1, 3, 6, 12}));
  EXPECT_EQ(sorted(log.chunks({.isovalue = Isovalue{"density", {}, {8, 15.9}}}, LevelTarget{4})),
            (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 7, 8, 15}));
  EXPECT_EQ(log.chunks({.isovalue = Isovalue{"density", {}, {8.95, 16}}}, LevelTarget{4}),
            (std::vector<std::uint32_t>{0, 1, 2, 4}))
      << "between two packets, and beyond the last";
}

TEST(Planner, aPlaneOrAnIsosurfaceWillDoButOnlyWhereItIsSeen) {
  const Planned log = withValues();
  const Isovalue eight{"density", {}, {8.5}};
  const View both{.planes = {{1, 0, 0, -60000}, {0, 1, 0, -60000}}, .isovalue = eight};
  const View planes{.planes = both.planes};
  auto expected = log.chunks(planes, LevelTarget{4});
  ASSERT_EQ(std::ranges::count(expected, 8u), 0);
  for (const std::uint32_t packet : {2u, 4u, 8u})
    if (std::ranges::count(expected, packet) == 0) expected.push_back(packet);
  EXPECT_EQ(sorted(log.chunks(both, LevelTarget{4})), sorted(expected));
  const View away{.frustum = {{1, 0, 0, -40000}}, .isovalue = eight};  // x >= 40000: node 3
  EXPECT_EQ(log.chunks(away, LevelTarget{4}), upTo(2));
}

TEST(Planner, anIsovalueWhoseIntervalsAreUnknownCountsForNothing) {
  Planned log = withValues();
  for (const Isovalue& unknown : {Isovalue{"pressure", {}, {12.5}}, Isovalue{"density", 1, {12.5}},
                                  Isovalue{"velocity", 3, {0}}})
    EXPECT_EQ(log.chunks({.isovalue = unknown}), log.chunks({})) << unknown.field;
  EXPECT_EQ(log.chunks({.isovalue = Isovalue{"density", 0, {12.5}}}, LevelTarget{4}).size(), 5u)
      << "the only component";
  EXPECT_EQ(log.chunks({.isovalue = Isovalue{"velocity", 2, {0}}}, LevelTarget{4}), upTo(2))
      << "known to be nowhere";
  log.intervals.emplace();
  EXPECT_EQ(log.chunks({.isovalue = Isovalue{"density", {}, {12.5}}}), log.chunks({}));
  log.intervals.reset();
  EXPECT_EQ(log.chunks({.isovalue = Isovalue{"density", {}, {12.5}}}), log.chunks({}));
}

TEST(Planner, inAStreamTheViewChoosesNothing) {
  const Planned log({.chunks = 8});
  const View corner{.planes = {{1, 0, 0, 0}}, .box = std::array<double, 6>{0, 0, 0, 1, 1, 1}};
  EXPECT_EQ(log.chunks(corner), upTo(8));
  EXPECT_EQ(log.chunks(corner, LevelTarget{3}), upTo(4));
}

TEST(Planner, aTargetEndsAStream) {
  const Planned log({.chunks = 8, .errors = true});
  EXPECT_EQ(log.chunks({}, LevelTarget{0}), upTo(1));
  EXPECT_EQ(log.chunks({}, LevelTarget{99}), upTo(8));
  EXPECT_EQ(log.chunks({}, TetrahedraTarget{139}), upTo(4));
  EXPECT_EQ(log.chunks({}, TetrahedraTarget{140}), upTo(5));
  EXPECT_EQ(log.chunks({}, TetrahedraTarget{0}), upTo(1));
  const std::uint64_t five = log.index.chunks[5].offset;
  EXPECT_EQ(log.chunks({}, BytesTarget{five}), upTo(5));
  EXPECT_EQ(log.chunks({}, BytesTarget{five - 1}), upTo(4));
  EXPECT_EQ(log.chunks({}, BytesTarget{0}), upTo(1));
  EXPECT_EQ(log.chunks({}, FieldErrorTarget{0.126, "density"}), upTo(3));
  EXPECT_EQ(log.chunks({}, BoundaryErrorTarget{0.0626}), upTo(4));
  EXPECT_EQ(log.chunks({}, BoundaryErrorTarget{0}), upTo(8));
}

TEST(Planner, whereErrorsAreNotToldOnlyTheLastLevelIsKnownToBeGoodEnough) {
  EXPECT_EQ(Planned({.chunks = 8}).chunks({}, FieldErrorTarget{0.5, "density"}), upTo(8));
}

TEST(Planner, inRegionsBytesAndCellsCountWhatTheClientHas) {
  const Planned log({.chunks = 2, .bands = 3, .errors = true});
  const auto whole = log.chunks({});
  for (const std::size_t n : {1u, 2u, 5u, 15u}) {
    std::uint64_t bytes = log.index.headBytes();
    ClientBlocks blocks = log.blocks({0}, 0, {0});
    for (std::size_t i = 0; i < n; ++i) bytes += blocks.missingBytes(whole[i]);
    const std::vector expected(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_EQ(log.chunks({}, BytesTarget{bytes}), expected);
    EXPECT_EQ(log.chunks({}, TetrahedraTarget{10 * n}), expected);
    for (std::size_t column = 0; column < 3; ++column) blocks.add(0, column);
    EXPECT_EQ(log.chunks(blocks, {}, BytesTarget{bytes}),
              std::vector(expected.begin() + 1, expected.end()));
    EXPECT_EQ(log.chunks(blocks, {}, TetrahedraTarget{10 * n}),
              std::vector(expected.begin() + 1, expected.end()));
  }
}

TEST(Planner, theSliceOfTheHeadEndsWhereTheFirstBlockStarts) {
  const Planned log = threeChunks();
  const BlockRun head{0, FrameHeader::kHead, 0};
  EXPECT_EQ(sliceOf(log.index, head).offset, 0u);
  EXPECT_EQ(sliceOf(log.index, head).size, log.index.chunks[0].offset);
}

}  // namespace
}  // namespace qtet
