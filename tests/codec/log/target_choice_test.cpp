#include "codec/log/target_choice.h"

#include <gtest/gtest.h>

#include "codec/log/log_index.h"
#include "codec/log/log_levels.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

/// A log whose levels have the errors 1, 1/2, 1/3 ... of the boundary and a tenth of them of the
/// fields, or none.
class TargetChoice : public ::testing::Test {
 protected:
  void encode(bool isMeasured) {
    const FusionHistory history = *simplify(testing::gridMesh(5, 2), {});
    LogWriterOptions options;
    options.chunkBytes = 1024;
    for (std::uint32_t i = 0; isMeasured && i <= history.levels; ++i) {
      const double e = 1.0 / (i + 1);
      options.errors.push_back(
          LevelError{{e / 2, e}, {e / 2, e}, 0, 0, {{e / 10, e}, {e / 10, e}}});
    }
    index_ = *LogIndex::parse(encodeLog(history, options)->bytes);
    manifest_ = *manifestOf(index_);
  }
  std::uint32_t level(const Target& target) const {
    return levelFor(target, manifest_, index_).value();
  }
  std::uint32_t lastChunk(const Target& target) const {
    return lastChunkFor(target, manifest_, index_).value();
  }

  LogIndex index_;
  Manifest manifest_;
};

TEST_F(TargetChoice, aBoundIsMetExactlyWhereItIsGiven) {
  encode(true);
  const auto last = static_cast<std::uint32_t>(manifest_.levels.size() - 1);
  ASSERT_GT(last, 6u);
  const std::uint32_t cells = manifest_.levels[5].tetrahedra;
  EXPECT_EQ(level(TetrahedraTarget{cells - 1}), 4u);
  EXPECT_EQ(level(TetrahedraTarget{cells}), 5u);
  const std::uint64_t bytes = prefixBytes(manifest_, index_, last);
  EXPECT_LT(level(BytesTarget{bytes - 1}), last);
  EXPECT_EQ(level(BytesTarget{bytes}), last);
  const double boundary = manifest_.levels[5].error->boundaryDistance(),
               field = manifest_.levels[5].error->fields[0].rms;
  const std::string key = fieldKey(manifest_, 0);
  EXPECT_EQ(level(BoundaryErrorTarget{boundary}), 5u);
  EXPECT_EQ(level(BoundaryErrorTarget{0.999 * boundary}), 6u);
  EXPECT_EQ(level(FieldErrorTarget{field, key}), 5u);
  EXPECT_EQ(level(FieldErrorTarget{0.999 * field, key}), 6u);
}

TEST_F(TargetChoice, whatNoLevelMeetsIsTheBaseMeshOrTheLastOne) {
  encode(true);
  const auto last = static_cast<std::uint32_t>(manifest_.levels.size() - 1);
  EXPECT_EQ(level(TetrahedraTarget{0}), 0u);
  EXPECT_EQ(level(BytesTarget{0}), 0u);
  EXPECT_EQ(level(BoundaryErrorTarget{0}), last);
  EXPECT_EQ(level(LevelTarget{last + 1}), last);
  EXPECT_EQ(level(EverythingTarget{}), last);
}

TEST_F(TargetChoice, theChunksHoldTheLevel) {
  encode(true);
  for (const ManifestLevel& l : manifest_.levels) {
    EXPECT_EQ(lastChunk(LevelTarget{l.level}), l.chunk);
    EXPECT_EQ(lastChunk(TetrahedraTarget{l.tetrahedra}), l.chunk);
    EXPECT_EQ(lastChunk(BoundaryErrorTarget{l.error->boundaryDistance()}), l.chunk);
  }
  for (std::uint32_t chunk = 1; chunk < index_.chunks.size(); ++chunk) {
    const std::uint64_t end = index_.chunks[chunk].offset + index_.chunks[chunk].size();
    EXPECT_EQ(lastChunk(BytesTarget{end}), chunk);
    EXPECT_EQ(lastChunk(BytesTarget{end - 1}), chunk - 1);
  }
}

TEST_F(TargetChoice, withoutKnownErrorsALevelIsRefusedAndAStreamGoesToTheEnd) {
  encode(false);
  const Target boundary = BoundaryErrorTarget{0.1};
  EXPECT_EQ(levelFor(boundary, manifest_, index_).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(lastChunk(boundary), manifest_.levels.back().chunk);
}

TEST_F(TargetChoice, aFieldThatIsNotThereIsRefusedWithThoseThatAre) {
  for (const bool isMeasured : {false, true}) {
    encode(isMeasured);
    const Target target = FieldErrorTarget{0.1, "heat"};
    const auto chunks = lastChunkFor(target, manifest_, index_);
    ASSERT_FALSE(chunks);
    EXPECT_EQ(chunks.error().code, ErrorCode::kNotFound);
    EXPECT_NE(chunks.error().message.find(fieldKey(manifest_, 0)), std::string::npos);
    EXPECT_FALSE(levelFor(target, manifest_, index_));
  }
}

}  // namespace
}  // namespace qtet
