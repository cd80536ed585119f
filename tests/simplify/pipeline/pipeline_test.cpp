#include "simplify/pipeline/pipeline.h"

#include <gtest/gtest.h>

#include <limits>

#include "codec/refine/log_file.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/pipeline/field_meshes.h"

namespace qtet {
namespace {

PipelineOptions usual() {
  PipelineOptions options;
  options.source = "mesh.vtu";
  return options;
}

TEST(Pipeline, theReportIsOfTheBytes) {
  TetMesh mesh = testing::boxWithFields();
  mesh.points.push_back({9, 9, 9});  // of no cell
  for (MeshField& field : mesh.fields)
    if (!isCellField(field)) field.values.resize(mesh.points.size() * field.components);
  ASSERT_TRUE(checkArrays(mesh));
  PipelineOptions options = usual();
  options.keep.exact = true;
  const Result<PipelineOutput> made = simplifyToLog(std::move(mesh), options);
  ASSERT_TRUE(made) << made.error().text();
  const PipelineReport& report = made->report;
  EXPECT_EQ(report.tetrahedraIn, kBoxCells);
  EXPECT_EQ(report.manifest.levels.back().tetrahedra, kBoxCells);
  EXPECT_NEAR(report.manifest.levels.front().tetrahedra, kBoxCells / 4.0, 0.06 * kBoxCells / 4)
      << "what fields are worth, or a level less";
  EXPECT_TRUE(report.manifest.levels.front().error.has_value());
  EXPECT_EQ(report.manifest.source, "mesh.vtu");
  EXPECT_EQ(report.statistics.fileBytes > 0, true);
  EXPECT_EQ(report.index.fileBytes, made->log.size());
  EXPECT_EQ(report.index.closing.size(), 4u);  // positions and the three fields of floats
  EXPECT_EQ(report.clean.unusedPoints.count, 1u);
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_EQ(report.notes[0], "points of no cell, dropped: 1 (point 729)");
  EXPECT_TRUE(report.boundaryWeight.has_value());
  EXPECT_FALSE(report.paper.has_value());
  std::vector<Stage> stages;
  for (const auto& [stage, seconds] : report.seconds) {
    stages.push_back(stage);
    EXPECT_GE(seconds, 0);
  }
  EXPECT_EQ(stages, (std::vector{Stage::kClean, Stage::kQuantise, Stage::kSimplify, Stage::kMeasure,
                                 Stage::kEncode, Stage::kKeep}));
}

TEST(Pipeline, aReducedMeshHasTheErrorsOfTheSameFusionsInOneGo) {
  PipelineOptions options = usual();
  options.exactCoarse = true;
  options.fusion.baseCells = 1500;
  const Result<PipelineOutput> whole = simplifyToLog(testing::boxWithFields(), options);
  options.fusion.baseCells = 600;
  options.finest = 1500;
  const Result<PipelineOutput> reduced = simplifyToLog(testing::boxWithFields(), options);
  ASSERT_TRUE(whole && reduced);
  const Manifest& manifest = reduced->report.manifest;
  EXPECT_EQ(manifest.original, (OriginalSize{kBoxCells, 729}));
  EXPECT_FALSE(whole->report.manifest.original);
  const ManifestLevel &last = manifest.levels.back(), &base = whole->report.manifest.levels.front();
  EXPECT_EQ(last.tetrahedra, base.tetrahedra);
  EXPECT_EQ(last.vertices, base.vertices);
  ASSERT_TRUE(last.error && base.error);
  EXPECT_GT(last.error->fields[0].rms, 0);
  for (std::size_t f = 0; f < last.error->fields.size(); ++f) {
    EXPECT_NEAR(last.error->fields[f].rms, base.error->fields[f].rms,
                0.01 * base.error->fields[f].rms)
        << f;
    EXPECT_NEAR(last.error->fields[f].max, base.error->fields[f].max,
                0.01 * base.error->fields[f].max)
        << f;
  }
  EXPECT_NEAR(last.error->toLevel.mean, base.error->toLevel.mean, 0.02 * base.error->toLevel.mean);
  EXPECT_GE(last.error->boundaryDistance(), base.error->boundaryDistance());
  EXPECT_NEAR(last.error->volumeLost, base.error->volumeLost, 1e-3);
  EXPECT_GT(manifest.levels.front().error->fields[0].rms, last.error->fields[0].rms);
  EXPECT_EQ(reduced->report.seconds[2].first, Stage::kReduce);
  EXPECT_EQ(reduced->report.seconds[3].first, Stage::kSimplify);
}

TEST(Pipeline, aMeshOfNoMoreCellsThanTheFinestStaysAsItIs) {
  PipelineOptions options = usual();
  const Result<PipelineOutput> whole = simplifyToLog(testing::boxWithFields(), options);
  options.finest = kBoxCells;
  const Result<PipelineOutput> same = simplifyToLog(testing::boxWithFields(), options);
  ASSERT_TRUE(whole && same);
  EXPECT_EQ(whole->log.bytes().value(), same->log.bytes().value());
  options.finest = kBoxCells - 1;
  const Result<PipelineOutput> less = simplifyToLog(testing::boxWithFields(), options);
  ASSERT_TRUE(less);
  EXPECT_TRUE(less->report.manifest.original);
  options.keep.exact = true;
  const Result<PipelineOutput> none = simplifyToLog(testing::boxWithFields(), options);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kBadValue);
}

TEST(Pipeline, progressBeginsEachStageWithZeroAndGoesOnToOne) {
  std::vector<std::pair<Stage, double>> told;
  PipelineOptions options = usual();
  options.progress = [&](Stage stage, double fraction) { told.emplace_back(stage, fraction); };
  ASSERT_TRUE(simplifyToLog(testing::boxWithFields(), options));
  std::optional<Stage> stage;
  double last = 0;
  for (const auto& [now, fraction] : told) {
    if (now != stage) {
      EXPECT_EQ(fraction, 0);
      EXPECT_TRUE(!stage || *stage < now);
      last = 0;
    }
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    stage = now, last = fraction;
  }
  EXPECT_EQ(stage, Stage::kEncode);
  EXPECT_GT(last, 0.5);
  EXPECT_GT(told.size(), 50u);
}

TEST(Pipeline, aStopAtAnyStageIsAnErrorOfItsOwn) {
  for (const Stage at : {Stage::kClean, Stage::kQuantise, Stage::kSimplify, Stage::kMeasure,
                         Stage::kEncode, Stage::kKeep}) {
    std::stop_source stop;
    PipelineOptions options = usual();
    options.keep = {true, true};
    options.stop = stop.get_token();
    options.progress = [&](Stage stage, double) {
      EXPECT_LE(stage, at) << "a stage begins after the stop";
      if (stage == at) stop.request_stop();
    };
    const Result<PipelineOutput> made = simplifyToLog(testing::boxWithFields(), options);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::kCancelled);
    EXPECT_STREQ(errorCodeName(made.error().code), "cancelled");
  }
}

// The stages themselves, which ask again and again: one that did not would go on to its end.
TEST(Pipeline, everyStageAsksWhetherToStop) {
  std::stop_source stopped;
  stopped.request_stop();
  const std::stop_token stop = stopped.get_token();
  const auto isCancelled = [](const auto& result) {
    return !result && result.error().code == ErrorCode::kCancelled;
  };
  TetMesh mesh = testing::boxWithFields();
  TetMesh another = mesh;
  EXPECT_TRUE(isCancelled(cleanMesh(another, stop)));
  ASSERT_TRUE(cleanMesh(mesh));
  EXPECT_TRUE(isCancelled(quantise(mesh, {}, stop)));
  const Result<QuantisedMesh> quantised = quantise(mesh);
  ASSERT_TRUE(quantised);
  for (const int threads : {1, 3}) {
    FusionOptions fusion;
    fusion.threads = threads;
    Result<FusionHistory> history = simplify(quantised->mesh, fusion);
    ASSERT_TRUE(history);
    fusion.stop = stop;
    EXPECT_TRUE(isCancelled(simplify(quantised->mesh, fusion)));
    EXPECT_TRUE(isCancelled(simplifyAsThePaper(quantised->mesh, fusion)));
    MeasureOptions measure;
    measure.threads = threads;
    LogWriterOptions encode;
    encode.stop = stop;
    EXPECT_TRUE(isCancelled(encodeLog(*history, encode)));
    const KeptInput kept{{true, true}, mesh};
    LogWriterOptions keep;
    keep.closing = [&](const FinestMesh& finest, const ClosingSink& give) {
      return giveInput(*history, finest, kept, stop, give);
    };
    EXPECT_TRUE(isCancelled(encodeLog(*history, keep)));
    measure.stop = stop;
    EXPECT_TRUE(isCancelled(measureLevels(*history, measure)));
  }
}

TEST(Pipeline, optionsThatDoNotGoTogetherAreRefused) {
  const auto refused = [](void (*change)(PipelineOptions&), ErrorCode code,
                          const std::string& words) {
    PipelineOptions options = usual();
    change(options);
    const Result<PipelineOutput> made = simplifyToLog(testing::boxWithFields(), options);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, code) << made.error().text();
    EXPECT_NE(made.error().message.find(words), std::string::npos) << made.error().text();
  };
  refused([](PipelineOptions& o) { o.algorithm = Algorithm::kPaper, o.regions = "Label"; },
          ErrorCode::kBadValue, "paper knows no");
  refused([](PipelineOptions& o) { o.fieldWeights = {{"Scalar", -1}}; }, ErrorCode::kBadValue,
          "Scalar");
  refused([](PipelineOptions& o) { o.fieldWeights = {{"Label", 1}}; }, ErrorCode::kNotFound,
          "no point field 'Label'");
  refused([](PipelineOptions& o) { o.regions = "Scalar"; }, ErrorCode::kNotFound,
          "no cell field 'Scalar'");
  refused([](PipelineOptions& o) { o.regions = "Height"; }, ErrorCode::kBadInput, "Height");
  refused([](PipelineOptions& o) { o.quantise.positionBits = 40; }, ErrorCode::kBadValue, "40");
  refused([](PipelineOptions& o) { o.fusion.targetRatio = 2; }, ErrorCode::kBadInput, "0..1");
}

TEST(Arrays, whatALogCannotHoldIsNamed) {
  const auto refused = [](const std::string& words, auto change,
                          ErrorCode code = ErrorCode::kBadInput) {
    TetMesh mesh = testing::boxWithFields();
    change(mesh);
    const Status checked = checkArrays(mesh);
    ASSERT_FALSE(checked) << words;
    EXPECT_EQ(checked.error().code, code) << checked.error().text();
    EXPECT_NE(checked.error().message.find(words), std::string::npos) << checked.error().text();
  };
  ASSERT_TRUE(checkArrays(testing::boxWithFields()));
  refused("no points", [](TetMesh& m) { m.points.clear(); });
  refused("no tetrahedra", [](TetMesh& m) { m.tetrahedra.clear(); });
  refused("point 3 has a coordinate", [](TetMesh& m) { m.points[3][1] = NAN; });
  refused("tetrahedron 7 names a point outside the 729",
          [](TetMesh& m) { m.tetrahedra[7][2] = 729; });
  refused("field 1 needs a name", [](TetMesh& m) { m.fields[1].name = ""; });
  refused("field 1 needs a name", [](TetMesh& m) { m.fields[1].name = "\xFF"; });
  refused("field 1 needs a name", [](TetMesh& m) { m.fields[1].name = std::string(257, 'n'); });
  refused("neither to points", [](TetMesh& m) { m.fields[1].association = "face"; });
  refused("unknown type half", [](TetMesh& m) { m.fields[1].type = "half"; });
  refused("0 components", [](TetMesh& m) { m.fields[1].components = 0; });
  refused("17 components", [](TetMesh& m) { m.fields[1].components = 17; });
  refused("field 3 (Height) has 3071 numbers, not 3072",
          [](TetMesh& m) { m.fields[3].values.pop_back(); });
  refused("2^53", [](TetMesh& m) { m.fields[2].values[5] = 9007199254740992.0; });
  refused("2^53",
          [](TetMesh& m) { m.fields[2].values[5] = std::numeric_limits<double>::quiet_NaN(); });
  refused("two point fields are called Swirl", [](TetMesh& m) { m.fields[0].name = "Swirl"; });
  refused(
      "more than 8192 fields", [](TetMesh& m) { m.fields.resize(kMaxFields + 1); },
      ErrorCode::kLimitExceeded);
}

TEST(CheckRoom, RefusesWhatAProgramHasNoAddressesFor) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 32;
  EXPECT_TRUE(checkRoom(kMost / kLeastBytesACell, kMost));
  const Status refused = checkRoom(kMost / kLeastBytesACell + 1, kMost);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kLimitExceeded);
  EXPECT_EQ(refused.error().message,
            "simplifying 17179870 tetrahedra takes over 4 GB, and this program has 4 GB at most; "
            "use the tool of the Python or Debian package");
}

}  // namespace
}  // namespace qtet
