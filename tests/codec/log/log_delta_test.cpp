// Deltas between logs: applied they give the new log, cut anywhere, and a wrong one is refused.
#include "codec/log/log_delta.h"

#include <gtest/gtest.h>

#include <numeric>

#include "codec/log/log_index.h"
#include "codec/log/log_writer.h"
#include "codec/refine/log_edit.h"
#include "codec/refine/log_file.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/series/time_differences.h"
#include "tests/support/meshes.h"
#include "tests/support/series_mesh.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

struct Outcome {
  Bytes bytes;
  std::optional<ErrorCode> error;
  bool isWhole = false;
};

/// Feeds the delta in pieces of `piece` bytes, and takes at most as many at a time.
Outcome apply(ByteView delta, ByteView base, std::uint64_t most, std::size_t piece) {
  Outcome out;
  DeltaReader reader(base, most);
  while (!delta.empty()) {
    const std::size_t n = std::min(piece, delta.size());
    reader.feed(delta.first(n));
    delta = delta.subspan(n);
    while (!reader.needsBytes()) {
      const Result<ByteView> next = reader.next(piece);
      if (!next) {
        out.error = next.error().code;
        return out;
      }
      EXPECT_LE(next->size(), piece);
      out.bytes.insert(out.bytes.end(), next->begin(), next->end());
    }
  }
  out.isWhole = reader.isWhole();
  return out;
}

Bytes instruction(std::uint64_t from, std::uint64_t copied, std::uint64_t literal,
                  std::size_t bytes) {
  ByteWriter out;
  out.write(from);
  out.write(copied);
  out.write(literal);
  out.append(Bytes(bytes, 7));
  return out.take();
}

class LogDelta : public ::testing::Test {
 protected:
  std::optional<Bytes> delta(std::uint64_t first = 0, std::uint64_t most = ~std::uint64_t{0}) {
    return makeDelta(old_.index(), new_.index(), new_.bytes(), first, most);
  }

  const LogFile new_ = *LogFile::fromBytes(testing::logBytes(testing::soundMesh(8, 5)));
  /// Without its last field.
  const LogFile old_ = *LogFile::fromBytes([&] {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t f = 0; f + 1 < new_.fields().size(); ++f) kept.push_back(f);
    return withFields(new_, kept, {})->together();
  }());
};

TEST_F(LogDelta, givesTheNewLogInPiecesOfAnySize) {
  const Bytes made = delta().value();
  EXPECT_LT(made.size(), new_.bytes().size() / 2);
  for (const std::size_t piece :
       {std::size_t{1}, std::size_t{25}, std::size_t{1000}, made.size()}) {
    const Outcome out = apply(made, old_.bytes(), new_.bytes().size(), piece);
    EXPECT_TRUE(out.isWhole && std::ranges::equal(out.bytes, new_.bytes())) << piece;
  }
}

TEST_F(LogDelta, givesTheRestFromAnyByteOn) {
  for (std::uint64_t first = 0; first <= new_.bytes().size(); first += 61) {
    const ByteView rest = new_.bytes().subspan(first);
    const Outcome out = apply(delta(first).value(), old_.bytes(), rest.size(), 4096);
    EXPECT_TRUE(std::ranges::equal(out.bytes, rest)) << first;
  }
}

TEST_F(LogDelta, ofTheSameLogIsItsHeadAlone) {
  const Bytes made = makeDelta(new_.index(), new_.index(), new_.bytes(), 0, 1 << 20).value();
  EXPECT_LT(made.size(), new_.headBytes() + 512);
}

/// A log of `steps` instants of a quantity that hardly changes, so that blocks are small.
LogFile logOfSteps(std::size_t steps) {
  FusionHistory history = simplify(testing::seriesMesh(5, 1, steps), {}).value();
  (void)predictInTime(history).value();
  toTimeDifferences(history);
  LogWriterOptions writer;
  writer.chunkBytes = 4000;
  return *LogFile::fromBytes(encodeLog(history, writer).value().bytes);
}

// A run that goes on: each push sends a step, whatever came before.
TEST(LogDeltaOfSeries, sendsAStepAndNotTheListOfAll) {
  const LogFile log = logOfSteps(400);
  const auto fields = static_cast<std::uint32_t>(log.fields().size());
  std::vector<std::uint32_t> kept(fields - 1);
  std::iota(kept.begin(), kept.end(), 0U);
  const Bytes before = withFields(log, kept, {})->together();
  const LogFile old = *LogFile::fromBytes(before);
  std::uint64_t step = 0;
  for (const ChunkEntry& chunk : log.chunks()) step += chunk.blocks.back().size;
  const Bytes made = makeDelta(old.index(), log.index(), log.bytes(), 0, 1 << 30).value();
  EXPECT_LT(made.size(), step + log.headBytes() + 200 + 120 * log.chunks().size());
  EXPECT_GT(log.index().encodeLater().size(), 20'000u);
  const Outcome out = apply(made, old.bytes(), log.bytes().size(), 4096);
  EXPECT_TRUE(out.isWhole && std::ranges::equal(out.bytes, log.bytes()));
}

TEST(LogDeltaOfSeries, isRightWhateverInstantsAreLeftOut) {
  const LogFile log = logOfSteps(60);
  for (std::uint32_t every = 2; every < 6; ++every) {
    std::vector<std::uint32_t> kept;  // those that nothing that stays rests on
    for (std::uint32_t f = 0; f < log.fields().size(); ++f)
      if (f % every != 0 || f == 0) kept.push_back(f);
    kept = withParents(log.fields(), kept);
    if (kept.size() == log.fields().size()) kept.pop_back();
    const LogFile fewer = *LogFile::fromBytes(withFields(log, kept, {})->together());
    for (const auto& [from, to] : {std::pair{&log, &fewer}, std::pair{&fewer, &log}}) {
      const Bytes made = makeDelta(from->index(), to->index(), to->bytes(), 0, 1 << 30).value();
      const Outcome out = apply(made, from->bytes(), to->bytes().size(), 4096);
      EXPECT_TRUE(out.isWhole && std::ranges::equal(out.bytes, to->bytes())) << every;
      EXPECT_LT(made.size(), to->bytes().size());
    }
  }
}

TEST_F(LogDelta, isMadeUpToTheLimit) {
  const std::uint64_t bytes = delta()->size();
  EXPECT_TRUE(delta(0, bytes + DeltaReader::kHeadBytes));
  EXPECT_TRUE(delta(0, bytes));
  EXPECT_FALSE(delta(0, bytes - 1));
}

TEST_F(LogDelta, thatEndsWithinAnInstructionIsNotWhole) {
  const Bytes made = delta().value();
  for (const std::size_t bytes : {std::size_t{1}, DeltaReader::kHeadBytes, made.size() - 1})
    EXPECT_FALSE(apply(ByteView(made).first(bytes), old_.bytes(), new_.bytes().size(), 100).isWhole)
        << bytes;
}

TEST(DeltaReader, refusesPiecesOutsideTheOldLogOrBackwards) {
  const Bytes base(100, 1);
  const auto errorOf = [&](const Bytes& delta) { return apply(delta, base, 1000, 64).error; };
  EXPECT_EQ(errorOf(instruction(0, 100, 0, 0)), std::nullopt);
  EXPECT_EQ(errorOf(instruction(0, 0, 0, 0)), ErrorCode::kBadValue);
  EXPECT_EQ(errorOf(instruction(0, 101, 0, 0)), ErrorCode::kBadValue);
  EXPECT_EQ(errorOf(instruction(100, 1, 0, 0)), ErrorCode::kBadValue);
  EXPECT_EQ(errorOf(instruction(~std::uint64_t{0}, 2, 0, 0)), ErrorCode::kBadValue);
  for (const std::uint64_t second : {49u, 50u, 51u}) {
    Bytes two = instruction(0, 50, 0, 0);
    const Bytes more = instruction(second, 10, 0, 0);
    two.insert(two.end(), more.begin(), more.end());
    EXPECT_EQ(errorOf(two).has_value(), second < 50) << second;
  }
}

TEST(DeltaReader, givesNoMoreThanWasPromised) {
  const Bytes base(100, 1);
  const std::optional<ErrorCode> tooMuch = ErrorCode::kBadValue, none;
  Bytes two = instruction(0, 20, 0, 0);
  const Bytes more = instruction(20, 10, 0, 0);
  two.insert(two.end(), more.begin(), more.end());
  for (const std::uint64_t most : {29u, 30u, 31u})
    for (const Bytes& delta :
         {instruction(0, 30, 0, 0), instruction(0, 20, 10, 10), instruction(0, 0, 30, 30), two})
      EXPECT_EQ(apply(delta, base, most, 64).error, most < 30 ? tooMuch : none) << most;
  EXPECT_EQ(apply(instruction(0, 20, ~std::uint64_t{0}, 10), base, 1000, 64).error,
            ErrorCode::kBadValue);
}

}  // namespace
}  // namespace qtet
