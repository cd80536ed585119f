// The decisions of one chunk, one by one, against tests/golden/trace.txt. The range decoder is
// written here from FORMAT.md, so that the trace does not rest on RangeDecoder.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>

#include "codec/log/log_index.h"
#include "codec/log/value_block.h"
#include "codec/record/record_coder.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

/// Notes "number p bit low high" of each decision, low and high before they shift.
class TraceCoder {
 public:
  static constexpr bool kEncoding = false;

  explicit TraceCoder(ByteView bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
  }

  int bit(int /*unknown*/, BitModel& model) {
    const int value = likely(0, range::clamped(model));
    range::update(model, value);
    return value;
  }
  int likely(int /*unknown*/, std::uint32_t p) {
    const std::uint64_t middle = low_ + ((std::uint64_t{high_ - low_} * p) >> 16);
    const int value = code_ <= middle ? 1 : 0;
    (value != 0 ? high_ : low_) = static_cast<std::uint32_t>(middle + (value != 0 ? 0 : 1));
    lines.push_back(std::to_string(lines.size()) + " " + std::to_string(p) + " " +
                    std::to_string(value) + " " + std::to_string(low_) + " " +
                    std::to_string(high_));
    for (; low_ >> 24 == high_ >> 24; code_ = code_ << 8 | next())
      low_ <<= 8, high_ = high_ << 8 | 255;
    return value;
  }
  std::uint32_t raw(std::uint32_t /*unknown*/, int bits) {
    std::uint32_t value = 0;
    for (int i = 0; i < bits; ++i, ++back_)
      value |= (bytes_[bytes_.size() - 1 - back_ / 8] >> (back_ % 8) & 1u) << i;
    return value;
  }

  std::vector<std::string> lines;

 private:
  std::uint32_t next() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }

  ByteView bytes_;
  std::size_t at_ = 0, back_ = 0;  // bytes from the front, bits from the back
  std::uint32_t low_ = 0, high_ = 0xFFFFFFFF, code_ = 0;
};

std::vector<std::string> linesOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> out;
  for (std::string line; std::getline(file, line);)
    if (!line.starts_with("#")) out.push_back(line);
  return out;
}

TEST(DecisionTrace, isThatOfTheGoldenFile) {
  const std::filesystem::path folder = testing::kGoldenFolder;
  const LogFile log = LogFile::open(folder / "valid" / "dice-traced.qtet").value();
  Refiner refiner(log.index());
  ASSERT_TRUE(applyChunk(log, refiner, 0, {}));
  GrowingMesh mesh;
  mesh.points.assign(refiner.points().begin(), refiner.points().end());
  mesh.tetrahedra.assign(refiner.tetrahedra().begin(), refiner.tetrahedra().end());
  mesh.boundary.assign(refiner.boundary().begin(), refiner.boundary().end());
  mesh.start(log.index().positionBits);

  const auto told =
      decodeValueBlock(log.block(1, kPositionsPart), 3, log.index().tuples(1, kPositionsPart),
                       log.index().blockCodec(1, kPositionsPart));
  ASSERT_TRUE(told);
  TraceCoder coder(log.block(1, kStructurePart));
  RecordModels models;
  Link link;
  Values positions(*told);
  RecordCoder<TraceCoder> records(coder, models, mesh, link, positions);
  std::set<int> kinds;
  mesh.beginLevel(1);
  for (VertexId v = 0; v < std::min(mesh.levelVertices(), log.index().chunks[1].endSlot); ++v) {
    if (!mesh.maysplit(v) || !records.splits(v, 1, false)) continue;
    Split split;
    ASSERT_TRUE(mesh.enter(v, link));
    ASSERT_TRUE(records.code(v, {}, split)) << v;
    mesh.apply(v, link, split);
    kinds.insert(split.k);
  }
  EXPECT_EQ(kinds, (std::set<int>{2, 3, 4}));
  const std::vector<std::string> expected = linesOf(folder / "trace.txt");
  ASSERT_EQ(coder.lines.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(coder.lines[i], expected[i]);
}

}  // namespace
}  // namespace qtet
