// The decoder trusts nothing: every truncation, every flipped bit, every count that lies.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "codec/coding/draco_block.h"
#include "codec/record/base_coder.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "proto/limits.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

Bytes readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

Status decodeAll(const LogFile& log) {
  if (Status s = log.verifyChecksums(); !s) return s;
  Refiner refiner(log.index());
  std::vector<std::uint32_t> fields;
  for (std::uint32_t f = 0; f < log.index().fields.size(); ++f) fields.push_back(f);
  for (std::uint32_t c = 0; c < log.index().chunks.size(); ++c)
    if (Status s = applyChunk(log, refiner, c, fields); !s) return s;
  return {};
}

class HostileLog : public ::testing::Test {
 protected:
  HostileLog()
      : folder_(testing::freshFolder("hostile")),
        bytes_(readFile(testing::writeSampleLog(folder_, "good", 3, 1, 200))) {
    index_ = *LogIndex::parse(bytes_);
  }

  Result<LogFile> open(ByteView bytes) {
    const auto path = folder_ / "bad.qtet";
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return LogFile::open(path);
  }

  /// The log with a changed table, every checksum right.
  Bytes forged(const std::function<void(LogIndex&)>& change) {
    LogIndex index = index_;
    change(index);
    return testing::withFront(bytes_, index);
  }

  void expectRefused(ErrorCode code, const std::function<void(LogIndex&)>& change) {
    const auto log = open(forged(change));
    const Status status = log ? decodeAll(*log) : Status(std::unexpected(log.error()));
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, code) << status.error().text();
  }

  std::filesystem::path folder_;
  Bytes bytes_;
  LogIndex index_;
};

TEST_F(HostileLog, theUntouchedLogIsFine) {
  const auto log = open(bytes_);
  ASSERT_TRUE(log) << log.error().text();
  EXPECT_TRUE(decodeAll(*log));
  ASSERT_GT(index_.chunks.size(), 2u);
}

TEST_F(HostileLog, aLogOfAnotherVersionIsRefusedWithWhatToDo) {
  constexpr std::size_t kMajorAt = 8;
  ASSERT_EQ(bytes_[kMajorAt], LogIndex::kVersionMajor);
  for (const auto& [major, advice] : {std::pair{LogIndex::kVersionMajor - 1, "make the log again"},
                                      std::pair{LogIndex::kVersionMajor + 1, "use a newer qtet"}}) {
    Bytes other = bytes_;
    other[kMajorAt] = static_cast<std::uint8_t>(major);
    const auto log = open(other);
    ASSERT_FALSE(log);
    EXPECT_EQ(log.error().code, ErrorCode::kBadVersion);
    EXPECT_NE(log.error().message.find(advice), std::string::npos) << log.error().message;
  }
}

TEST_F(HostileLog, everyTruncationIsNoticed) {
  for (std::size_t n = 0; n < bytes_.size(); ++n) {
    const auto log = open(ByteView(bytes_).first(n));
    ASSERT_FALSE(log) << n << " bytes were accepted";
    ASSERT_EQ(log.error().code, ErrorCode::kTruncated) << n << ": " << log.error().text();
  }
}

TEST_F(HostileLog, bytesBeyondTheEndAreNoticed) {
  Bytes longer = bytes_;
  longer.push_back(0);
  EXPECT_FALSE(open(longer));
}

TEST_F(HostileLog, everyFlippedBitIsNoticed) {
  for (std::size_t i = 0; i < bytes_.size(); ++i)
    for (int bit = 0; bit < 8; bit += i < index_.headBytes() ? 1 : 3) {
      Bytes bad = bytes_;
      bad[i] ^= static_cast<std::uint8_t>(1 << bit);
      const auto log = open(bad);
      ASSERT_TRUE(!log || !log->verifyChecksums()) << "byte " << i << " bit " << bit;
    }
}

TEST_F(HostileLog, damageBelowTheChecksumsNeverCrashesTheRefiner) {
  std::vector<std::vector<std::int32_t>> positions;
  for (std::uint32_t c = 0; c < index_.chunks.size(); ++c)
    positions.push_back(*decodeDracoBlock(
        ByteView(bytes_).subspan(index_.block(c, 1).offset, index_.block(c, 1).size), 3,
        index_.tuples(c, kPositionsPart)));
  std::size_t refused = 0;
  std::size_t tried = 0;
  for (std::uint32_t bad = 0; bad < index_.chunks.size(); ++bad) {
    const BlockEntry& b = index_.block(bad, kStructurePart);
    for (std::size_t i = 0; i < b.size; ++i) {
      Bytes bytes = bytes_;
      bytes[b.offset + i] ^= static_cast<std::uint8_t>(1 << (i % 8));
      Refiner refiner(index_);
      Status status;
      for (std::uint32_t c = 0; c < index_.chunks.size() && status; ++c)
        status = refiner.apply(
            c, ByteView(bytes).subspan(index_.block(c, 0).offset, index_.block(c, 0).size),
            positions[c]);
      refused += !status;
      ++tried;
      for (const Tetrahedron& t : refiner.tetrahedra())
        for (const VertexId v : t) ASSERT_LT(v, refiner.points().size());
    }
  }
  // what slips through has the right counts and decodes: only the checksum knows
  EXPECT_GT(refused, tried * 3 / 4);
}

TEST_F(HostileLog, countsThatLieAreNoticed) {
  for (const auto member :
       {&ChunkEntry::newVertices, &ChunkEntry::newTetrahedra, &ChunkEntry::newBoundaryTriangles})
    for (const std::uint32_t chunk : {0u, 1u})
      for (const int by : {-1, 1}) {
        const auto log = open(forged(
            [&](LogIndex& i) { i.chunks[chunk].*member += static_cast<std::uint32_t>(by); }));
        EXPECT_FALSE(log && decodeAll(*log)) << "chunk " << chunk << " by " << by;
      }
  expectRefused(ErrorCode::kBadValue, [](LogIndex& i) { ++i.chunks[1].records; });
  expectRefused(ErrorCode::kLimitExceeded, [](LogIndex& i) { i.chunks[1].records = 0x7FFFFFFF; });
  expectRefused(ErrorCode::kLimitExceeded,
                [](LogIndex& i) { i.chunks[1].newTetrahedra = 0x7FFFFFFF; });
  expectRefused(ErrorCode::kLimitExceeded,
                [](LogIndex& i) { i.chunks[1].newVertices = 0xFFFFFFFF; });
}

TEST_F(HostileLog, countsMayReachWhatTheirBytesCanHoldAndNoMore) {
  const std::uint64_t steps =
      kMaxStepsPerByte * (index_.block(1, kStructurePart).size + kFreeCountBytes);
  const auto expectLimit = [&](std::uint32_t ChunkEntry::* member, std::uint64_t most) {
    for (const int by : {-1, 0, 1}) {
      const auto parsed = LogIndex::parse(forged([&](LogIndex& i) {
        i.chunks[1].*member = static_cast<std::uint32_t>(most) + static_cast<std::uint32_t>(by);
        i.chunks[1].newVertices = std::max(i.chunks[1].newVertices, i.chunks[1].records);
      }));
      ASSERT_EQ(parsed.has_value(), by <= 0) << most << " and " << by;
      if (!parsed) {
        EXPECT_EQ(parsed.error().code, ErrorCode::kLimitExceeded) << parsed.error().text();
      }
    }
  };
  expectLimit(&ChunkEntry::records, steps);
  expectLimit(&ChunkEntry::newVertices, 4 * steps);
  expectLimit(&ChunkEntry::newTetrahedra, 8 * steps);
  expectLimit(&ChunkEntry::newBoundaryTriangles, 8 * steps);
}

TEST_F(HostileLog, aTableThatContradictsItselfIsRefused) {
  expectRefused(ErrorCode::kBadValue, [](LogIndex& i) { ++i.fileBytes; });
  expectRefused(ErrorCode::kLimitExceeded,
                [](LogIndex& i) { i.chunks[2].lastLevel = i.chunks[2].firstLevel - 1; });
  expectRefused(ErrorCode::kLimitExceeded, [](LogIndex& i) { i.chunks.back().lastLevel = 5000; });
  expectRefused(ErrorCode::kBadCodec,
                [](LogIndex& i) { i.chunks[1].valueCodec = static_cast<CodecId>(9); });
  expectRefused(ErrorCode::kBadCodec,
                [](LogIndex& i) { i.chunks[1].structureCodec = CodecId::kDraco; });
  expectRefused(ErrorCode::kBadValue, [](LogIndex& i) { i.fields[0].components = 17; });
  expectRefused(ErrorCode::kBadValue, [](LogIndex& i) { i.positionBits = 29; });
}

TEST_F(HostileLog, aLatticeTooSmallForItsPointsIsRefused) {
  expectRefused(ErrorCode::kBadValue, [](LogIndex& i) { i.positionBits = 4; });
}

TEST_F(HostileLog, aBaseMeshWhosePositionsFailLeavesNoCellsBehind) {
  const BlockEntry& block = index_.block(0, kStructurePart);
  Refiner refiner(index_);
  const std::vector<std::int32_t> far(std::size_t{index_.tuples(0, kPositionsPart)} * 3, 1 << 20);
  ASSERT_FALSE(refiner.apply(0, ByteView(bytes_).subspan(block.offset, block.size), far));
  EXPECT_TRUE(refiner.tetrahedra().empty());
  EXPECT_TRUE(refiner.boundary().empty());
}

TEST_F(HostileLog, chunksGoInInTheirOrderAndOnce) {
  const auto log = open(bytes_);
  ASSERT_TRUE(log);
  Refiner refiner(log->index());
  EXPECT_EQ(applyChunk(*log, refiner, 1, {}).error().code, ErrorCode::kBadOrder);
  Refiner again(log->index());
  ASSERT_TRUE(applyChunk(*log, again, 0, {}));
  EXPECT_EQ(applyChunk(*log, again, 0, {}).error().code, ErrorCode::kBadOrder);
  EXPECT_EQ(again.applyField(0, 1, ByteView{}).error().code, ErrorCode::kBadOrder);
  EXPECT_EQ(again.applyField(7, 0, ByteView{}).error().code, ErrorCode::kNotFound);
}

TEST(Refiner, aLinkOfTwoSpheresIsRefused) {
  // Two tetrahedra that share one vertex: its link closes, but is two spheres. Whatever a record
  // says of it, no id may leave its range.
  RangeEncoder encoder;
  const std::vector<Tetrahedron> cells{{0, 1, 2, 3}, {0, 5, 4, 6}};
  BaseTruth truth(cells);
  BaseCoder<RangeEncoder> base(encoder, 7, 2);
  ASSERT_TRUE(base.run(&truth, [] { return false; }));
  const Bytes structure = encoder.finish();
  LogIndex index;
  index.positionBits = 10;
  index.chunks.resize(2);
  index.chunks[0].newVertices = 7;
  index.chunks[0].newTetrahedra = 2;
  index.chunks[0].newBoundaryTriangles = 8;
  index.chunks[1].firstLevel = index.chunks[1].lastLevel = 1;
  index.chunks[1].newVertices = index.chunks[1].newTetrahedra = index.chunks[1].records = 3;
  for (std::uint8_t seed = 0; seed < 64; ++seed) {
    Refiner refiner(index);
    std::vector<std::int32_t> positions(21);
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = i < 3 ? 100 : 1;
    ASSERT_TRUE(refiner.apply(0, structure, positions));
    EXPECT_FALSE(refiner.apply(1, Bytes(64, static_cast<std::uint8_t>(seed * 37)),
                               std::vector<std::int32_t>(9, 1)));
    for (const Tetrahedron& t : refiner.tetrahedra())
      for (const VertexId v : t) ASSERT_LT(v, refiner.points().size());
  }
}

TEST(LogFile, saysWhatIsWrongWithTheFile) {
  const auto folder = testing::freshFolder("log-file");
  EXPECT_EQ(LogFile::open(folder / "none.qtet").error().code, ErrorCode::kIo);
  EXPECT_EQ(LogFile::open(folder).error().code, ErrorCode::kIo);
  std::ofstream(folder / "empty.qtet").flush();
  EXPECT_EQ(LogFile::open(folder / "empty.qtet").error().code, ErrorCode::kTruncated);
  std::ofstream(folder / "text.qtet") << std::string(200, 'x');
  EXPECT_EQ(LogFile::open(folder / "text.qtet").error().code, ErrorCode::kBadMagic);
}

TEST(DracoBlock, refusesWhatDracoWouldLose) {
  const std::vector<std::int32_t> large{1, (1 << 30) + 1};
  EXPECT_EQ(encodeDracoBlock(large, 1).error().code, ErrorCode::kLimitExceeded);
  const std::vector<std::int32_t> edge{1 << 28, -(1 << 28), 0, 5, 6, -7};
  const auto bytes = encodeDracoBlock(edge, 3);
  ASSERT_TRUE(bytes) << bytes.error().text();
  EXPECT_EQ(*decodeDracoBlock(*bytes, 3, 2), edge);
  EXPECT_EQ(decodeDracoBlock(*bytes, 3, 3).error().code, ErrorCode::kBadValue);
  EXPECT_EQ(decodeDracoBlock(*bytes, 2, 3).error().code, ErrorCode::kBadValue);
  EXPECT_EQ(decodeDracoBlock(Bytes{1, 2, 3}, 3, 2).error().code, ErrorCode::kBadCodec);
  Bytes bomb = *encodeDracoBlock(std::vector<std::int32_t>(3000, 0), 3);
  bomb[13] = 0x7F;  // eight million points and more, in a few bytes
  EXPECT_EQ(decodeDracoBlock(bomb, 3, 1000).error().code, ErrorCode::kBadValue);
}

}  // namespace
}  // namespace qtet
