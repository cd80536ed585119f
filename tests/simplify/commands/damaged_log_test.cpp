// `qtet verify` finds every damage: any bit, any length, and lies whose checksums are right.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <functional>

#include "codec/coding/draco_block.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/refine/log_file.h"
#include "codec/refine/verify_log.h"
#include "proto/checksum.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/log/opened_log.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitizer.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::TakenApart;

/// Checks a log as `qtet verify` does; the tool prints the error and ends with 1.
Status verify(const fs::path& path) {
  const Result<OpenedLog> log = openLog(path);
  if (!log) return std::unexpected(log.error());
  const Result<Refiner> decoded = decodeVerified(log->file, log->manifest);
  return decoded ? Status() : Status(std::unexpected(decoded.error()));
}

std::string textOf(const Status& status) { return status ? "accepted" : status.error().text(); }

/// The digests of every level and of the finest level's fields: what a viewer would show. Empty
/// where the log does not decode.
std::vector<std::string> meaningOf(const fs::path& path) {
  const Result<LogFile> log = LogFile::open(path);
  if (!log) return {};
  std::vector<std::uint32_t> fields;
  for (std::uint32_t f = 0; f < log->index().fields.size(); ++f) fields.push_back(f);
  std::vector<std::string> out;
  for (std::uint32_t level = 0; level <= log->index().chunks.back().lastLevel; ++level) {
    Refiner refiner(log->index());
    refiner.stopAtLevel(level);
    for (std::uint32_t chunk = 0;
         chunk < log->index().chunks.size() && (chunk == 0 || refiner.level() < level); ++chunk)
      if (!applyChunk(*log, refiner, chunk, fields)) return {};
    out.push_back(toHex(refiner.digest()));
    for (const std::uint32_t f : fields) {
      ByteWriter values;
      for (const std::int32_t value : refiner.fieldValues(f))
        values.write(static_cast<std::uint32_t>(value));
      out.push_back(sha256Hex(values.bytes()));
    }
  }
  return out;
}

/// A log of a few kilobytes in several chunks, some of them within one level, with a point field
/// and cell fields.
Bytes smallLog() {
  LatticeMesh mesh = testing::gridMesh(3, 1);
  mesh.fields.pop_back();  // its values go below 0
  mesh.values.pop_back();
  testing::addCellFields(mesh);
  LogWriterOptions options;
  options.source = "small.vtu";
  options.generator = "qtet test";
  options.chunkBytes = 40;
  return encodeLog(simplify(mesh, {}).value(), options).value().bytes;
}

const Bytes& goodLog() {
  static const Bytes log = smallLog();
  return log;
}

class DamagedLog : public ::testing::Test {
 protected:
  DamagedLog() { put(goodLog()); }

  /// Over what is there: a file that is emptied first would be written to the disk at once.
  void put(const Bytes& bytes) {
    const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
    EXPECT_EQ(::pwrite(file, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    EXPECT_EQ(::ftruncate(file, static_cast<off_t>(bytes.size())), 0);
    ::close(file);
  }
  Status verdictOf(const Bytes& bytes) {
    put(bytes);
    return verify(path_);
  }
  void expectRefused(const Bytes& bytes, const std::string& word, const std::string& what) {
    const std::string verdict = textOf(verdictOf(bytes));
    EXPECT_NE(verdict, "accepted") << what;
    EXPECT_NE(verdict.find(word), std::string::npos) << what << ": " << verdict;
  }
  /// The good log with a change to what it was taken apart into.
  void expectRefused(const std::string& word, const std::string& what,
                     const std::function<void(TakenApart&)>& change) {
    TakenApart parts = testing::takeApart(goodLog());
    change(parts);
    expectRefused(parts.together(), word, what);
  }
  /// A change of the table alone, which the blocks then contradict.
  void expectTableRefused(const std::string& word, const std::string& what,
                          const std::function<void(LogIndex&)>& change) {
    LogIndex index = LogIndex::parse(goodLog()).value();
    change(index);
    expectRefused(testing::withFront(goodLog(), index), word, what);
  }
  void expectManifestRefused(const std::string& word, const std::string& what,
                             const std::function<void(Manifest&)>& change) {
    expectRefused(word, what, [&](TakenApart& parts) {
      Manifest manifest = manifestOf(parts.index).value();
      change(manifest);
      parts.index.manifest = manifestBlock(manifest).value();
    });
  }

  fs::path path_ =
      testing::freshFolder(std::string("damaged-") +
                           ::testing::UnitTest::GetInstance()->current_test_info()->name()) /
      "a.qtet";
  LogIndex index_ = LogIndex::parse(goodLog()).value();
};

TEST_F(DamagedLog, theGoodOneIsFineAndOfTheKindThatTheTestsNeed) {
  EXPECT_EQ(textOf(verify(path_)), "accepted");
  EXPECT_LT(goodLog().size(), 20'000u);
  EXPECT_GE(index_.chunks.size(), 6u);
  EXPECT_TRUE(std::ranges::any_of(index_.chunks, [](const ChunkEntry& e) {
    return e.endSlot != kLevelEnd;
  })) << "no level is cut";
  EXPECT_TRUE(index_.hasCellField());
  EXPECT_GE(meaningOf(path_).size(), 10u);
}

TEST_F(DamagedLog, everyFlippedBitIsFound) {
  const int file = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_GE(file, 0);
  for (std::size_t i = 0; i < 8 * goodLog().size(); i += testing::kStride) {
    const std::size_t at = i / 8, bit = i % 8;
    const auto flipped = static_cast<std::uint8_t>(goodLog()[at] ^ (1 << bit));
    ASSERT_EQ(::pwrite(file, &flipped, 1, static_cast<off_t>(at)), 1);
    const std::string verdict = textOf(verify(path_));
    ASSERT_NE(verdict, "accepted") << "byte " << at << ", bit " << bit;
    ASSERT_NE(verdict.find("at byte"), std::string::npos) << verdict;  // where it is
    ASSERT_EQ(::pwrite(file, &goodLog()[at], 1, static_cast<off_t>(at)), 1);
  }
  ::close(file);
  EXPECT_TRUE(verify(path_));
}

TEST_F(DamagedLog, everyOtherLengthIsFound) {
  for (std::size_t i = 1; i <= goodLog().size(); i += testing::kStride) {
    const std::size_t n = goodLog().size() - i;  // downwards, so that truncate() cuts
    ASSERT_EQ(::truncate(path_.c_str(), static_cast<off_t>(n)), 0);
    const Status verdict = verify(path_);
    ASSERT_FALSE(verdict) << n << " bytes";
    ASSERT_EQ(verdict.error().code, ErrorCode::kTruncated) << n << " bytes: " << textOf(verdict);
  }
  for (const std::size_t more :
       {std::size_t{1}, std::size_t{7}, std::size_t{4096}, goodLog().size()}) {
    Bytes longer = goodLog();
    for (std::size_t i = 0; i < more; ++i) longer.push_back(goodLog()[i % goodLog().size()]);
    expectRefused(longer, "its header says", std::to_string(more) + " bytes more");
  }
}

/// Every byte of header and table changed under right checksums: refused, or what the log shows is
/// the same.
TEST_F(DamagedLog, aLieInTheHeaderOrTheTableIsFoundOrChangesNothing) {
  const std::vector<std::string> meaning = meaningOf(path_);
  const std::size_t tableAt = LogIndex::kHeaderBytes + index_.manifest.size();
  std::size_t harmless = 0;
  for (std::size_t at = 0; at < index_.headBytes(); ++at) {
    if (at == LogIndex::kHeaderBytes) at = tableAt;
    // plus 1, minus 1, ...
    for (const std::uint8_t change : std::initializer_list<std::uint8_t>{1, 255, 0x80}) {
      Bytes bytes = goodLog();
      bytes[at] = static_cast<std::uint8_t>(bytes[at] + change);
      testing::mendChecksums(bytes);
      if (bytes == goodLog()) continue;  // a checksum of the header's own
      if (!verdictOf(bytes)) continue;
      ASSERT_EQ(meaningOf(path_), meaning) << "byte " << at << " + " << int{change};
      ++harmless;
    }
  }
  // the minor version, and the ends of chunks moved over slots that have no flag
  EXPECT_LT(harmless, 3 * index_.chunks.size());
}

TEST_F(DamagedLog, countsThatAreOffByOneAreFound) {
  using Member = std::uint32_t ChunkEntry::*;
  const std::vector<std::pair<const char*, Member>> members{
      {"records", &ChunkEntry::records},
      {"vertices", &ChunkEntry::newVertices},
      {"tetrahedra", &ChunkEntry::newTetrahedra},
      {"triangles", &ChunkEntry::newBoundaryTriangles},
      {"last level", &ChunkEntry::lastLevel}};
  for (const auto& [name, member] : members)
    for (std::size_t chunk = 0; chunk < index_.chunks.size(); ++chunk)
      for (const std::uint32_t by : {1u, ~0u})
        expectTableRefused("", std::string(name) + " of chunk " + std::to_string(chunk),
                           [&](LogIndex& i) { i.chunks[chunk].*member += by; });
}

TEST_F(DamagedLog, aCountMovedFromOneChunkToTheNextIsFound) {
  // The totals stay right, so only what each chunk brings can tell.
  for (const auto member : {&ChunkEntry::newVertices, &ChunkEntry::newTetrahedra,
                            &ChunkEntry::newBoundaryTriangles, &ChunkEntry::records})
    for (std::size_t chunk = 0; chunk + 1 < index_.chunks.size(); ++chunk)
      expectTableRefused("", "chunk " + std::to_string(chunk), [&](LogIndex& i) {
        --(i.chunks[chunk].*member), ++(i.chunks[chunk + 1].*member);
      });
}

TEST_F(DamagedLog, chunksInAnotherOrderAreFound) {
  for (std::size_t a = 0; a < index_.chunks.size(); ++a)
    for (std::size_t b = a + 1; b < index_.chunks.size(); ++b) {
      const std::string what = "chunks " + std::to_string(a) + " and " + std::to_string(b);
      expectRefused("", what + ", rows and all", [&](TakenApart& p) {
        std::swap(p.blocks[a], p.blocks[b]);
        std::swap(p.index.chunks[a], p.index.chunks[b]);
      });
      // The rows keep what makes them follow each other: nothing but the records' sense is wrong.
      expectRefused("", what + ", levels mended", [&](TakenApart& p) {
        std::swap(p.blocks[a], p.blocks[b]);
        std::swap(p.index.chunks[a], p.index.chunks[b]);
        for (const auto member :
             {&ChunkEntry::firstLevel, &ChunkEntry::lastLevel, &ChunkEntry::endSlot})
          std::swap(p.index.chunks[a].*member, p.index.chunks[b].*member);
      });
      expectRefused("", what + ", blocks alone",
                    [&](TakenApart& p) { std::swap(p.blocks[a], p.blocks[b]); });
    }
}

TEST_F(DamagedLog, aBlockOfAnotherChunkIsFound) {
  for (std::size_t a = 1; a + 1 < index_.chunks.size(); ++a)
    expectRefused("", "chunk " + std::to_string(a), [&](TakenApart& p) {
      p.blocks[a][kStructurePart] = p.blocks[a + 1][kStructurePart];
    });
}

TEST_F(DamagedLog, aChunkThatStandsTwiceIsFound) {
  for (std::uint32_t chunk = 0; chunk < index_.chunks.size(); ++chunk)
    for (const bool asNextLevel : {false, true})
      expectRefused("", "chunk " + std::to_string(chunk), [&](TakenApart& p) {
        p.blocks.insert(p.blocks.begin() + chunk, p.blocks[chunk]);
        p.index.chunks.insert(p.index.chunks.begin() + chunk, p.index.chunks[chunk]);
        for (std::uint32_t c = chunk + 1; asNextLevel && c < p.index.chunks.size(); ++c)
          ++p.index.chunks[c].firstLevel, ++p.index.chunks[c].lastLevel;
      });
}

TEST_F(DamagedLog, chunksThatAreLeftOutAreFound) {
  for (std::size_t keep = 1; keep < index_.chunks.size(); ++keep)
    expectRefused("", "the first " + std::to_string(keep) + " chunks", [&](TakenApart& p) {
      p.blocks.resize(keep);
      p.index.chunks.resize(keep);
    });
}

TEST_F(DamagedLog, offsetsAndSizesThatDoNotFitAreFound) {
  for (std::size_t chunk = 0; chunk < index_.chunks.size(); ++chunk) {
    for (std::size_t part = 0; part < index_.parts(); ++part)
      for (const std::uint32_t by : {1u, ~0u})
        expectTableRefused("", "block " + std::to_string(part),
                           [&](LogIndex& i) { i.chunks[chunk].blocks[part].size += by; });
  }
  // Two blocks whose border moves: sizes still add up.
  for (std::size_t part = 0; part + 1 < index_.parts(); ++part)
    for (const int by : {-1, 1})
      expectRefused("", "border " + std::to_string(part), [&](TakenApart& p) {
        Bytes& left = p.blocks[1][part];
        Bytes& right = p.blocks[1][part + 1];
        if (by > 0)
          left.push_back(right.front()), right.erase(right.begin());
        else
          right.insert(right.begin(), left.back()), left.pop_back();
      });
}

TEST_F(DamagedLog, absurdSizesAreRefusedBeforeAnythingBigIsAllocated) {
  const std::size_t usual = testing::peakBytesOf([&] { EXPECT_TRUE(verify(path_)); });
  EXPECT_GT(usual, goodLog().size());
  EXPECT_GE(testing::peakBytesOf([] { Bytes some(5'000'000); }), 5'000'000u);
  constexpr std::size_t kSlack = 1 << 20;
  std::size_t largest = 0, accepted = 0;
  const auto expectCheap = [&](const Bytes& bytes, const std::string& what) {
    put(bytes);
    Status verdict;
    const std::size_t peak = testing::peakBytesOf([&] { verdict = verify(path_); });
    EXPECT_LE(peak, usual + kSlack) << what << ": " << textOf(verdict);
    accepted += verdict.has_value();
    largest = std::max(largest, peak);
  };
  const std::size_t tableAt = LogIndex::kHeaderBytes + index_.manifest.size();
  // Every aligned u32 of header and table, whatever it means, and every pair of them as one u64.
  for (std::size_t at = 16; at + 4 <= index_.headBytes(); at += 4) {
    if (at == LogIndex::kHeaderBytes - 4) at = tableAt;
    for (const std::uint32_t value : {0xFFFFFFFFu, 0x80000000u, 0x20000000u})
      for (const std::size_t width : {4u, 8u}) {
        Bytes bytes = goodLog();
        for (std::size_t i = 0; i < width && at + i < index_.headBytes(); ++i)
          bytes[at + i] = static_cast<std::uint8_t>(width == 8 && i < 4 ? (value & 1 ? 255 : 0)
                                                                        : value >> (8 * (i % 4)));
        testing::mendChecksums(bytes);
        Bytes same = goodLog();
        testing::mendChecksums(same);
        if (bytes == same) continue;
        expectCheap(bytes, "at byte " + std::to_string(at) + " " + std::to_string(value) + ": ");
      }
  }
  // The end of a chunk that completes its level is 2^32 - 1 already, or any slot beyond its last.
  EXPECT_LE(accepted, 2 * index_.chunks.size());
  RecordProperty("largestPeakBytes", static_cast<int>(largest));
}

TEST_F(DamagedLog, aFewBytesOfDracoDoNotAllocateMuch) {
  // One byte of 255, or two in a row: other numbers of points, attributes, components and symbols,
  // of other types.
  const std::vector<std::int32_t> values(60'000, 7);
  const Bytes good = encodeDracoBlock(values, 1).value();
  std::size_t largest = 0;
  for (std::size_t at = 0; at < good.size(); ++at)
    for (const std::size_t width : {1u, 2u}) {
      Bytes bad = good;
      for (std::size_t i = at; i < std::min(at + width, bad.size()); ++i) bad[i] = 0xFF;
      largest =
          std::max(largest, testing::peakBytesOf([&] { (void)decodeDracoBlock(bad, 1, 60'000); }));
    }
  // Many attributes of many components, as many as Draco takes for possible.
  constexpr std::size_t kAttributesAt = 16;
  Bytes many(good.begin(), good.begin() + kAttributesAt);
  many.push_back(50);
  for (std::uint8_t i = 0; i < 50; ++i)
    for (const std::uint8_t byte : std::initializer_list<std::uint8_t>{4, 5, 255, 0, i})
      many.push_back(byte);
  many.resize(600, 1);
  largest =
      std::max(largest, testing::peakBytesOf([&] { (void)decodeDracoBlock(many, 1, 60'000); }));
  EXPECT_LT(largest, 4u << 20);  // 240 KB of values, a few times
}

TEST_F(DamagedLog, versionsAndFlagsOfTheFutureAreRefused) {
  const auto patched = [&](std::size_t at, std::uint8_t value) {
    Bytes bytes = goodLog();
    bytes[at] = value;
    testing::mendChecksums(bytes);
    return bytes;
  };
  for (const std::uint8_t major : std::initializer_list<std::uint8_t>{0, 1, 3, 5, 255})
    expectRefused(patched(8, major), "bad-version", "major " + std::to_string(major));
  expectRefused(patched(9, 1), "bad-version", "major 260");
  for (const std::size_t reserved : {14u, 15u})
    expectRefused(patched(reserved, 1), "reserved", "byte " + std::to_string(reserved));
  for (const std::size_t later : {56u, 57u, 58u, 59u})
    expectRefused(patched(later, 1), "bad-value", "byte " + std::to_string(later));
  for (const std::uint8_t layout : std::initializer_list<std::uint8_t>{1, 2, 255})
    expectRefused(patched(12, layout), "bad-version", "layout");
  for (std::size_t chunk = 0; chunk < index_.chunks.size(); ++chunk) {
    for (const std::uint8_t codec : std::initializer_list<std::uint8_t>{0, 2, 3, 7, 15})
      expectTableRefused("codec", "structure codec " + std::to_string(codec), [&](LogIndex& i) {
        i.chunks[chunk].structureCodec = static_cast<CodecId>(codec);
      });
    // A chunk in which nothing is split has no values: of that one, 0 is true.
    const ChunkEntry& entry = index_.chunks[chunk];
    const bool isWithoutValues = entry.size() == entry.blocks[kStructurePart].size;
    for (const std::uint8_t codec : std::initializer_list<std::uint8_t>{0, 1, 2, 3, 7, 15}) {
      if (codec == 0 && isWithoutValues) continue;
      expectTableRefused("codec", "value codec " + std::to_string(codec), [&](LogIndex& i) {
        i.chunks[chunk].valueCodec = static_cast<CodecId>(codec);
      });
    }
  }
}

TEST_F(DamagedLog, aManifestThatDoesNotTellOfThisLogIsFound) {
  for (std::size_t level = 0; level <= index_.chunks.back().lastLevel; ++level) {
    const std::string what = "level " + std::to_string(level);
    for (const auto count :
         {&ManifestLevel::tetrahedra, &ManifestLevel::vertices, &ManifestLevel::boundaryTriangles})
      for (const std::uint32_t by : {1u, ~0u})
        expectManifestRefused("", what, [&](Manifest& m) { m.levels[level].*count += by; });
    expectManifestRefused("", what + " left out", [&](Manifest& m) {
      m.levels.erase(m.levels.begin() + static_cast<std::ptrdiff_t>(level));
    });
  }
  expectManifestRefused("", "a field less",
                        [](Manifest& m) { m.fields.erase(m.fields.begin() + 1); });
  expectManifestRefused("", "components", [](Manifest& m) {
    m.fields[0].components = 2;
    m.fields[0].minimum = {0, 0};
  });
  expectManifestRefused("bits", "a field's bits", [](Manifest& m) { m.fields[0].bits = 5; });
}

TEST_F(DamagedLog, fieldsExchangedAreFound) {
  // Both cell fields have a tuple a cell, of one and of two components.
  expectRefused("", "the cell fields' blocks", [](TakenApart& p) {
    for (auto& blocks : p.blocks)
      std::swap(blocks[kFirstFieldPart + 1], blocks[kFirstFieldPart + 2]);
  });
  expectRefused("", "rows of one field's blocks", [](TakenApart& p) {
    std::swap(p.blocks[1][kFirstFieldPart], p.blocks[2][kFirstFieldPart]);
  });
}

}  // namespace
}  // namespace qtet
