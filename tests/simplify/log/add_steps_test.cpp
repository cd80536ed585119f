// Instants that come to a log later: differences to each other and to the log's last one, and every
// level of them comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

#include "codec/log/field_blocks.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/log/manifest_field.h"
#include "codec/mesh/time_prediction.h"
#include "codec/refine/log_edit.h"
#include "codec/refine/log_file.h"
#include "codec/refine/log_history.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/log/add_fields.h"
#include "simplify/measure/measure_error.h"
#include "simplify/series/time_differences.h"
#include "tests/support/series_mesh.h"

namespace qtet {
namespace {

constexpr std::size_t kInstants = 16, kBefore = 3;

/// A log of the first instants of a series, and the mesh in floats with the later ones.
class AddSteps : public ::testing::Test {
 protected:
  AddSteps() : mesh_(testing::seriesMesh(5, 1, kInstants)) {
    LatticeMesh first = mesh_;
    first.fields.clear(), first.values.clear();
    for (std::size_t f = 0; f < mesh_.fields.size(); ++f)
      if (isCellField(mesh_.fields[f]) || timeOf(f) < 0.5 * kBefore)
        first.fields.push_back(mesh_.fields[f]), first.values.push_back(mesh_.values[f]);
    FusionHistory history = simplify(std::move(first), {}).value();
    LogWriterOptions writer;
    writer.chunkBytes = 400;
    writer.errors = measureLevels(history, {}).value();
    (void)predictInTime(history).value();
    toTimeDifferences(history);
    bytes_ = encodeLog(history, writer).value().bytes;
  }

  [[nodiscard]] double timeOf(std::size_t f) const { return mesh_.fields[f].name.instant()->time; }
  /// The instants of T from `first` to before `end` on points, in the lattice's own numbering.
  [[nodiscard]] TetMesh steps(std::size_t first, std::size_t end, double factor = 1) const {
    TetMesh out;
    for (const LatticePoint& p : mesh_.points) out.points.push_back(mesh_.lattice.position(p));
    out.tetrahedra = mesh_.tetrahedra;
    for (std::size_t f = 0; f < mesh_.fields.size(); ++f) {
      const FieldInfo& info = mesh_.fields[f];
      if (isCellField(info) || timeOf(f) < 0.5 * static_cast<double>(first) ||
          timeOf(f) >= 0.5 * static_cast<double>(end))
        continue;
      MeshField& field = out.fields.emplace_back(MeshField{info.name, 1, "float32", {}, "point"});
      for (const std::int32_t value : mesh_.values[f])
        field.values.push_back(factor * info.value(0, value));
    }
    std::ranges::sort(out.fields, {}, [](const MeshField& f) { return f.name.instant()->time; });
    return out;
  }
  [[nodiscard]] LogFile log() const { return LogFile::fromBytes(bytes_).value(); }

  static Bytes with(const LogFile& log, const AddedFields& added) {
    return withFields(log, added.kept, added.fields).value().together();
  }
  static std::size_t bytesOf(const AddedFields& added) {
    std::size_t out = 0;
    for (const NewField& field : added.fields)
      for (const Bytes& block : field.blocks) out += block.size();
    return out;
  }

  /// Expects every value of the series' instants below `end` at the last level.
  void expectAll(const LogFile& log, std::size_t end) const {
    ASSERT_TRUE(log.verifyChecksums());
    const LatticeMesh finest =
        meshAtLevel(log, log.chunks().back().lastLevel, std::nullopt).value();
    std::map<LatticePoint, std::size_t> places;
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) places[mesh_.points[i]] = i;
    std::size_t seen = 0;
    for (std::size_t f = 0; f < finest.fields.size(); ++f) {
      const auto at = std::ranges::find(mesh_.fields, finest.fields[f].name, &FieldInfo::name);
      ASSERT_NE(at, mesh_.fields.end()) << finest.fields[f].name;
      if (isCellField(*at)) continue;
      ++seen;
      const std::vector<std::int32_t>& expected =
          mesh_.values[static_cast<std::size_t>(at - mesh_.fields.begin())];
      for (std::size_t i = 0; i < finest.points.size(); ++i)
        ASSERT_NEAR(finest.fields[f].value(0, finest.values[f][i]),
                    at->value(0, expected[places.at(finest.points[i])]),
                    0.5 * finest.fields[f].step)
            << at->name << " " << i;
    }
    EXPECT_EQ(seen, end);
  }

  LatticeMesh mesh_;
  Bytes bytes_;
};

// The blocks that a writer made come out of the values that are read back.
TEST_F(AddSteps, theHistorysValuesAreThoseOfTheWriter) {
  const LogFile file = log();
  const LogHistory history = historyOf(file).value();
  const Manifest manifest = manifestOf(file.index()).value();
  std::vector<std::vector<std::int32_t>> values;
  std::size_t predicted = 0;
  for (std::uint32_t f = 0; f < file.fields().size(); ++f) {
    values.push_back(historyValues(file, history, f).value());
    const TimePrediction& prediction = file.fields()[f].prediction;
    predicted += !prediction.isNone();
    std::vector<std::int32_t> coded = values.back();
    for (std::size_t i = 0; !prediction.isNone() && i < coded.size(); ++i)
      coded[i] -= static_cast<std::int32_t>(
          predictInTime(prediction, [&](std::uint16_t p) { return values[p][i]; }, kMissing));
    FieldInfo info;
    info.components = manifest.fields[f].components;
    info.association = manifest.fields[f].association;
    const std::vector<Bytes> blocks =
        encodeFieldBlocks(history.order, info, coded, history.valueCodec).value();
    for (std::uint32_t chunk = 0; chunk < blocks.size(); ++chunk)
      ASSERT_TRUE(std::ranges::equal(blocks[chunk], file.block(chunk, kFirstFieldPart + f)))
          << f << " " << chunk;
  }
  EXPECT_GT(predicted, 1u);
}

TEST_F(AddSteps, aWindowIsCodedAsDifferences) {
  const LogFile file = log();
  const AddedFields added = addFields(file, steps(kBefore, 8)).value();
  EXPECT_TRUE(added.again.empty());
  EXPECT_EQ(
      std::ranges::count_if(added.fields, [](const NewField& f) { return f.prediction.isNone(); }),
      0);
  EXPECT_LT(added.fields.front().prediction.parents[0].field, file.fields().size());
  std::size_t alone = 0;
  for (std::size_t i = kBefore; i < 8; ++i) {
    TetMesh one = steps(i, i + 1);
    one.fields[0].name = "Alone";
    alone += bytesOf(addFields(file, one).value());
  }
  EXPECT_LT(bytesOf(added), alone - alone / 8) << "blocks of some ten bytes each";
  const Bytes all = with(file, added);
  const LogFile after = LogFile::fromBytes(all).value();
  expectAll(after, 8);
  for (std::uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk)
    for (std::uint32_t part = 0; part < kFirstFieldPart + file.fields().size(); ++part)
      ASSERT_TRUE(std::ranges::equal(file.block(chunk, part), after.block(chunk, part)));
  const Manifest manifest = manifestOf(after.index()).value();
  for (const ManifestLevel& level : manifest.levels)
    if (level.error) {
      EXPECT_EQ(level.error->fields.size(), manifest.fields.size());
    }
}

// As a simulation does that goes on: one call a step, and one log after the other.
TEST_F(AddSteps, aStepAtATimeKeepsRowsOfPredictionsShort) {
  Bytes bytes = bytes_;
  for (std::size_t i = kBefore; i < kInstants; ++i) {
    const LogFile file = LogFile::fromBytes(bytes).value();
    FieldAdder adder = FieldAdder::make(file, {}).value();
    EXPECT_EQ(adder.roomInWindow(), i <= 8 ? 9 - i : 17 - i);
    ASSERT_TRUE(adder.add(steps(i, i + 1)));
    const AddedFields added = adder.take();
    EXPECT_EQ(added.again.size(), i == 8 ? 7u : 0u) << i;
    EXPECT_EQ(added.kept.size() + added.again.size(), file.fields().size());
    bytes = with(file, added);
  }
  const LogFile after = LogFile::fromBytes(std::move(bytes)).value();
  expectAll(after, kInstants);
  std::size_t predicted = 0;
  for (std::uint32_t f = 0; f < after.fields().size(); ++f) {
    predicted += !after.fields()[f].prediction.isNone();
    EXPECT_LE(withParents(after.fields(), std::span(&f, 1)).size(), 3 + kAnchorsInARow) << f;
  }
  EXPECT_GT(predicted, (kInstants - kBefore) / 2);
}

TEST_F(AddSteps, severalWindowsOfOneAdderAreOneLog) {
  const LogFile file = log();
  FieldAdder adder = FieldAdder::make(file, {}).value();
  ASSERT_TRUE(adder.add(steps(kBefore, 9)));
  ASSERT_TRUE(adder.add(steps(9, kInstants)));
  const AddedFields added = adder.take();
  const std::size_t second = file.fields().size() + (9 - kBefore);
  std::size_t across = 0;
  for (const NewField& field : std::span(added.fields).subspan(9 - kBefore))
    for (const TimePrediction::Parent& parent : field.prediction.all())
      across += parent.field < second;
  EXPECT_GT(across, 0u) << "nothing is predicted across windows";
  expectAll(LogFile::fromBytes(with(file, added)).value(), kInstants);
}

TEST_F(AddSteps, valuesAboveTheSeriesScaleTakeMoreBitsAndThoseBelowAnotherMinimum) {
  const LogFile file = log();
  const AddedFields above = addFields(file, steps(kBefore, kBefore + 1, 3)).value();
  EXPECT_EQ(above.fields[0].info.step, 0.25);
  EXPECT_EQ(above.fields[0].info.bits, 13);
  const AddedFields below = addFields(file, steps(kBefore, kBefore + 1, -3)).value();
  ASSERT_EQ(below.fields.size(), 1u);
  EXPECT_TRUE(below.fields[0].prediction.isNone());
  EXPECT_EQ(below.fields[0].info.step, 0.25);
  EXPECT_LT(below.fields[0].info.minimum[0], -2000);
  const AddedFields within = addFields(file, steps(kBefore, kBefore + 1)).value();
  EXPECT_EQ(within.fields[0].info.step, 0.25);
}

// One scale goes on: a fallen minimum ends it once, and not with every instant that falls more.
TEST_F(AddSteps, aMinimumThatFallsGetsRoomOnce) {
  Bytes bytes = bytes_;
  std::vector<FieldInfo> infos;
  for (std::size_t i = kBefore; i < kBefore + 4; ++i) {
    const LogFile file = LogFile::fromBytes(bytes).value();
    TetMesh mesh = steps(i, i + 1);
    std::vector<double>& values = mesh.fields[0].values;
    const double fall = std::ranges::min(values) + 100.0 * static_cast<double>(i - 2);
    for (double& value : values) value -= fall;
    const AddedFields added = addFields(file, mesh).value();
    bytes = with(file, added);
    infos.push_back(fieldInfoOf(added.fields[0].info));
    EXPECT_TRUE(haveOneScale(infos.back(), infos.front())) << i;
    EXPECT_EQ(added.fields[0].prediction.isNone(), i == kBefore) << i;
    EXPECT_TRUE(added.warnings.empty());
  }
}

TEST_F(AddSteps, theRunGoesOnBehindADivergedStep) {
  LogFile file = log();
  const AddedFields far = addFields(file, steps(kBefore, kBefore + 1, 1e6)).value();
  ASSERT_EQ(far.warnings.size(), 1u);
  EXPECT_NE(far.warnings[0].find("its values at time 1.5 span"), std::string::npos);
  file = LogFile::fromBytes(with(file, far)).value();
  const AddedFields added = addFields(file, steps(kBefore + 1, kBefore + 2)).value();
  EXPECT_EQ(added.fields[0].info.step, 0.25);
  EXPECT_FALSE(added.fields[0].prediction.isNone()) << "it rests on the one before";
  EXPECT_TRUE(added.warnings.empty());
}

TEST_F(AddSteps, missingValuesStayMissingWhereAWindowIsCodedAgain) {
  Bytes bytes = bytes_;
  for (std::size_t i = kBefore; i < 9; ++i) {
    const LogFile file = LogFile::fromBytes(bytes).value();
    TetMesh mesh = steps(i, i + 1);
    mesh.fields[0].values[i] = std::nan("");
    bytes = with(file, addFields(file, mesh).value());
  }
  const LogFile after = LogFile::fromBytes(std::move(bytes)).value();
  const LatticeMesh finest =
      meshAtLevel(after, after.chunks().back().lastLevel, std::nullopt).value();
  for (std::size_t i = kBefore; i < 9; ++i) {
    const auto at =
        std::ranges::find(finest.fields, steps(i, i + 1).fields[0].name, &FieldInfo::name);
    const auto& values = finest.values[static_cast<std::size_t>(at - finest.fields.begin())];
    EXPECT_EQ(std::ranges::count(values, kMissing), 1) << i;
  }
}

}  // namespace
}  // namespace qtet
