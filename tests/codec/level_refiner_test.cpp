// Going back to coarser levels and on again: the same mesh, to the bit, as one that never went further.
#include <gtest/gtest.h>

#include <random>

#include "codec/level_refiner.h"
#include "codec/log_file.h"
#include "codec/log_writer.h"
#include "codec/value_block.h"
#include "proto/limits.h"
#include "simplify/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

struct Kind {
  const char* name;
  std::size_t cellsPerPacket;  // 0: the layout `stream`
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

/// Digest of the mesh, then the values of every field.
std::vector<std::int32_t> outcome(const Refiner& refiner) {
  std::vector<std::int32_t> out;
  for (const std::uint8_t byte : refiner.digest()) out.push_back(byte);
  for (std::uint32_t f = 0; f < refiner.index().fields.size(); ++f)
    out.insert(out.end(), refiner.fieldValues(f).begin(), refiner.fieldValues(f).end());
  return out;
}

class GoingBack : public ::testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    LatticeMesh mesh = testing::gridMesh(7, 3, [](int, int, int) { return true; });
    testing::addCellFields(mesh);
    FusionOptions options;
    options.targetRatio = 0;
    if (GetParam().cellsPerPacket > 0) options.bands.cellsPerPacket = GetParam().cellsPerPacket, options.bands.dearest = 1;
    const auto history = simplify(mesh, options);
    ASSERT_TRUE(history) << history.error().text();
    LogWriterOptions writer;
    writer.chunkBytes = 500;
    auto bytes = encodeLog(*history, writer);
    ASSERT_TRUE(bytes) << bytes.error().text();
    auto file = LogFile::fromBytes(std::move(bytes->bytes));
    ASSERT_TRUE(file) << file.error().text();
    log_.emplace(std::move(*file));
    ASSERT_GT(index().chunks.size(), 6u);
  }

  [[nodiscard]] const LogIndex& index() const { return log_->index(); }
  [[nodiscard]] std::uint32_t lastLevel() const { return index().chunks.back().lastLevel; }
  [[nodiscard]] std::vector<std::int32_t> values(std::uint32_t chunk, std::uint32_t part) const {
    auto v = decodeValueBlock(log_->block(chunk, part), index().components(part), index().tuples(chunk, part));
    EXPECT_TRUE(v) << v.error().text();
    return *v;
  }
  template <class AnyRefiner>
  Status give(AnyRefiner& refiner, std::uint32_t chunk) const {
    if (Status s = refiner.apply(chunk, log_->block(chunk, kStructurePart), values(chunk, kPositionsPart)); !s) return s;
    for (std::uint32_t f = 0; f < index().fields.size(); ++f)
      if (Status s = refiner.applyField(f, chunk, values(chunk, kFirstFieldPart + f)); !s) return s;
    return {};
  }
  /// What a refiner holds that stops at `level` and never was further, of the first `chunks` chunks.
  [[nodiscard]] std::vector<std::int32_t> straightTo(std::uint32_t level, std::uint32_t chunks) const {
    Refiner refiner(index());
    refiner.stopAtLevel(level);
    for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
      const Status s = give(refiner, chunk);
      EXPECT_TRUE(s || s.error().code == ErrorCode::kBadOrder);
    }
    return outcome(refiner);
  }

  std::optional<LogFile> log_;
};

TEST_P(GoingBack, anyLevelAfterAnyOtherIsWhatItWasOnTheWay) {
  const auto chunks = static_cast<std::uint32_t>(index().chunks.size());
  LevelRefiner refiner(index());
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) ASSERT_TRUE(give(refiner, chunk));
  const auto whole = outcome(refiner.refiner());
  std::mt19937 random(5);
  for (int step = 0; step < 12; ++step) {
    const std::uint32_t level = static_cast<std::uint32_t>(random()) % (lastLevel() + 1);
    ASSERT_TRUE(refiner.goTo(level));
    EXPECT_EQ(refiner.refiner().level(), level);
    EXPECT_EQ(outcome(refiner.refiner()), straightTo(level, chunks)) << "level " << level;
  }
  ASSERT_TRUE(refiner.goTo(kMaxLevels));
  EXPECT_EQ(outcome(refiner.refiner()), whole);
}

TEST_P(GoingBack, whatHasNotComeYetGoesOnFromTheFinestLevel) {
  const auto chunks = static_cast<std::uint32_t>(index().chunks.size());
  LevelRefiner refiner(index());
  for (std::uint32_t chunk = 0; chunk < chunks / 2; ++chunk) ASSERT_TRUE(give(refiner, chunk));
  const std::uint32_t finest = refiner.refiner().level();
  ASSERT_TRUE(refiner.goTo(finest / 2));
  const Status early = give(refiner, chunks / 2);
  ASSERT_FALSE(early) << "the refiner stands at a coarser level";
  EXPECT_EQ(early.error().code, ErrorCode::kBadOrder);
  ASSERT_TRUE(refiner.goTo(kMaxLevels));
  EXPECT_EQ(outcome(refiner.refiner()), straightTo(kMaxLevels, chunks / 2));
  for (std::uint32_t chunk = chunks / 2; chunk < chunks; ++chunk) ASSERT_TRUE(give(refiner, chunk));
  EXPECT_EQ(outcome(refiner.refiner()), straightTo(kMaxLevels, chunks));
}

TEST_P(GoingBack, whatIsForgottenIsFetchedAgain) {
  const auto chunks = static_cast<std::uint32_t>(index().chunks.size());
  LevelRefiner refiner(index());
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) ASSERT_TRUE(give(refiner, chunk));
  const std::size_t before = refiner.keptBytes();
  ASSERT_TRUE(refiner.goTo(lastLevel() / 2));
  EXPECT_EQ(refiner.keptBytes(), before) << "nothing is forgotten unasked";
  refiner.forgetBeyond();
  EXPECT_LT(refiner.keptBytes(), before);
  EXPECT_EQ(outcome(refiner.refiner()), straightTo(lastLevel() / 2, chunks));
  ASSERT_TRUE(refiner.goTo(kMaxLevels));
  std::uint32_t fetched = 0;
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk)
    if (!refiner.refiner().applied(chunk)) {
      ASSERT_TRUE(give(refiner, chunk));
      ++fetched;
    }
  EXPECT_GT(fetched, 0u);
  EXPECT_EQ(refiner.keptBytes(), before);
  EXPECT_EQ(outcome(refiner.refiner()), straightTo(kMaxLevels, chunks));
}

INSTANTIATE_TEST_SUITE_P(Layouts, GoingBack, ::testing::Values(Kind{"stream", 0}, Kind{"regions", 250}),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace qtet
