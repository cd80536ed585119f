// Tables and packets of the layout `regions` that lie: each lie is refused with its code, and none
// reaches beyond memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "codec/log/log_writer.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::takeApart;
using testing::TakenApart;

Bytes sampleBytes(std::size_t cellsPerPacket) {
  FusionOptions options;
  options.targetRatio = 0;
  options.bands = {cellsPerPacket, 2, 1, 1};
  const auto history = simplify(testing::gridMesh(7, 3), options);
  EXPECT_TRUE(history);
  LogWriterOptions writer;
  writer.chunkBytes = 2000;
  auto log = encodeLog(*history, writer);
  EXPECT_TRUE(log) << log.error().text();
  return std::move(log->bytes);
}

class HostileRegions : public ::testing::Test {
 protected:
  HostileRegions() : bytes_(sampleBytes(250)), honest_(takeApart(bytes_)) {
    head_ = honest_.index.headChunks();
    second_ = head_ + (1u << honest_.index.firstDepth());
    last_ = static_cast<std::uint32_t>(honest_.index.chunks.size()) - 1;
  }

  void expectRefused(ErrorCode code, const std::function<void(TakenApart&)>& lie,
                     const char* what) const {
    TakenApart log = honest_;
    lie(log);
    const auto parsed = LogIndex::parse(log.together());
    ASSERT_FALSE(parsed) << what;
    EXPECT_EQ(parsed.error().code, code) << what << ": " << parsed.error().text();
  }
  /// Without a row, and what follows it moved up.
  static void drop(TakenApart& log, std::uint32_t chunk) {
    log.index.chunks.erase(log.index.chunks.begin() + chunk);
    log.blocks.erase(log.blocks.begin() + chunk);
    log.index.dependencies.pop_back();
  }

  Bytes bytes_;
  TakenApart honest_;
  // the first packets of the first two bands, the last packet
  std::uint32_t head_ = 0, second_ = 0, last_ = 0;
};

TEST_F(HostileRegions, theHonestLogIsAccepted) {
  ASSERT_TRUE(LogIndex::parse(honest_.together()));
  ASSERT_GE(honest_.index.firstDepth(), 1u);
  ASSERT_GT(honest_.index.lastDepth(), honest_.index.firstDepth());
  ASSERT_GT(head_, 1u);
}

TEST_F(HostileRegions, dependenciesFollowFromTheNodes) {
  const LogIndex index = LogIndex::parse(honest_.together()).value();
  for (std::uint32_t i = 1; i <= last_; ++i) {
    const std::uint32_t expected =
        i < head_     ? i - 1
        : i < second_ ? head_ - 1
                      : index.headChunks() + index.chunks[i].node / 2 - (1u << index.firstDepth());
    ASSERT_EQ(index.chunks[i].dependencyCount, 1u);
    EXPECT_EQ(index.dependencies[index.chunks[i].firstDependency], expected) << "chunk " << i;
  }
  expectRefused(
      ErrorCode::kBadValue, [](TakenApart& l) { l.index.dependencies.push_back(0); },
      "a dependency too many");
}

TEST_F(HostileRegions, nodesFollowOneAnother) {
  const std::uint32_t last = last_, second = second_, head = head_;
  expectRefused(
      ErrorCode::kBadValue,
      [=](TakenApart& l) {
        std::swap(l.index.chunks[second + 1].node, l.index.chunks[second + 2].node);
      },
      "two in each other's places");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { --l.index.chunks[last].node; }, "one twice");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { l.index.chunks[last].node = 0xFFFFFFFF; },
      "one whose parent is nowhere");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { l.index.chunks[head].node = 0; },
      "the first packet none");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { l.index.chunks[head - 1].node = 1; },
      "the head's last chunk the root");
  expectRefused(
      ErrorCode::kBadValue, [](TakenApart& l) { l.index.chunks[0].node = 1; },
      "the base mesh a packet");
}

TEST_F(HostileRegions, bandsAreWholeAndInOrder) {
  const std::uint32_t last = last_, second = second_, head = head_;
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { drop(l, last); }, "without the last packet");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { drop(l, second); },
      "without the first of the second band");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { drop(l, head); }, "without the first packet");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { ++l.index.chunks[last].lastLevel; },
      "a level more than its band");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { l.index.chunks[last].endSlot = 5; },
      "ends within a level");
  expectRefused(
      ErrorCode::kBadValue, [=](TakenApart& l) { l.index.chunks[head - 1].endSlot = 5; },
      "the head ends within a level");
  expectRefused(
      ErrorCode::kLimitExceeded,
      [](TakenApart& l) {
        l.index.layout = Layout::kStream;
        for (ChunkEntry& e : l.index.chunks) e.node = 0;
      },
      "packets in a stream");
  expectRefused(
      ErrorCode::kBadValue,
      [=](TakenApart& l) {
        while (l.index.chunks.size() > head) drop(l, head);
      },
      "no packets");
  expectRefused(
      ErrorCode::kLimitExceeded,
      [=](TakenApart& l) {
        for (auto i = second; i <= last; ++i) l.index.chunks[i].lastLevel = 5000;
      },
      "levels");
}

TEST_F(HostileRegions, boxesLieWithinEachOther) {
  const std::uint32_t last = last_, head = head_;
  expectRefused(
      ErrorCode::kBadValue,
      [=](TakenApart& l) {
        std::swap(l.index.chunks[last].box.least, l.index.chunks[last].box.most);
      },
      "inside out");
  expectRefused(
      ErrorCode::kBadValue,
      [=](TakenApart& l) { l.index.chunks[head].box.most = l.index.chunks[head].box.least; },
      "smaller than its children's");
}

TEST_F(HostileRegions, countsBeyondTheBytesAreRefusedBeforeAllocating) {
  const std::uint32_t last = last_;
  for (const auto member :
       {&ChunkEntry::newVertices, &ChunkEntry::newTetrahedra, &ChunkEntry::newBoundaryTriangles})
    expectRefused(
        ErrorCode::kLimitExceeded, [=](TakenApart& l) { l.index.chunks[last].*member = 1u << 24; },
        "a count");
}

/// The status of the first chunk that is refused, all applied in file order.
Status decode(const Bytes& bytes) {
  const auto log = LogFile::fromBytes(bytes);
  if (!log) return std::unexpected(log.error());
  Refiner refiner(log->index());
  Status status;
  for (std::uint32_t chunk = 0; chunk < log->index().chunks.size() && status; ++chunk)
    status = applyChunk(*log, refiner, chunk, {});
  for (const Tetrahedron& t : refiner.tetrahedra())
    for (const VertexId v : t) EXPECT_LT(v, refiner.points().size());
  for (const Triangle& t : refiner.boundary())
    for (const VertexId v : t) EXPECT_LT(v, refiner.points().size());
  return status;
}

TEST_F(HostileRegions, countsThatThePacketDoesNotKeepAreRefused) {
  for (const auto member : {&ChunkEntry::newTetrahedra, &ChunkEntry::newBoundaryTriangles})
    for (const int by : {-1, 1}) {
      TakenApart log = honest_;
      log.index.chunks[second_].*member += static_cast<std::uint32_t>(by);
      const Status status = decode(log.together());
      ASSERT_FALSE(status);
      EXPECT_EQ(status.error().code, ErrorCode::kBadValue) << status.error().text();
    }
}

TEST_F(HostileRegions, packetsInEachOthersPlacesAreRefused) {
  TakenApart log = honest_;
  std::swap(log.blocks[head_], log.blocks[head_ + 1]);
  ASSERT_NE(log.index.chunks[head_].records, log.index.chunks[head_ + 1].records);
  EXPECT_FALSE(decode(log.together()));
}

TEST_F(HostileRegions, damagedPacketsAreRefusedOrStayInRange) {
  std::mt19937 random(5);
  std::size_t refused = 0;
  constexpr std::size_t kTrials = 400;
  for (std::size_t trial = 0; trial < kTrials; ++trial) {
    TakenApart log = honest_;
    const std::uint32_t chunk =
        head_ - 1 + static_cast<std::uint32_t>(random() % (last_ + 2 - head_));
    Bytes& block = log.blocks[chunk][kStructurePart];
    switch (random() % 3) {
      case 0:
        block[random() % block.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
        break;
      case 1: block.resize(random() % block.size()); break;
      default: block.push_back(static_cast<std::uint8_t>(random()));
    }
    refused += !decode(log.together());
  }
  EXPECT_GT(refused, kTrials * 9 / 10);
}

}  // namespace
}  // namespace qtet
