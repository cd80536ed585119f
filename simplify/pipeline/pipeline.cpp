#include "simplify/pipeline/pipeline.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "codec/log/log_manifest.h"
#include "proto/field_key.h"
#include "proto/version.h"
#include "simplify/blocks/original_figures.h"
#include "simplify/blocks/reduce_mesh.h"
#include "simplify/cost/cost_parts.h"
#include "simplify/cost/label_fields.h"
#include "simplify/cost/mesh_figures.h"
#include "simplify/log/lift_fields.h"
#include "simplify/measure/focus.h"
#include "simplify/measure/opening.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/mesh/moved_place.h"
#include "simplify/pieces/cleaned_pieces.h"
#include "simplify/pieces/cut_pieces.h"
#include "simplify/pipeline/fusion_choice.h"
#include "simplify/pipeline/loss_warnings.h"
#include "simplify/pipeline/moved_flips.h"
#include "simplify/series/series.h"
#include "simplify/series/time_differences.h"
#include "simplify/series/time_statistics.h"

namespace qtet {
namespace {

/// The stage in hand: reports it to the caller, and notes how long it took.
class Stages {
 public:
  Stages(const PipelineOptions& options, PipelineReport& report)
      : options_(options), report_(report) {}

  /// Begins a stage; the one before it is over. Errors: cancelled.
  Status begin(Stage stage) {
    end();
    if (options_.stop.stop_requested()) return cancelled();
    stage_ = stage;
    tell(0);
    return {};
  }

  void end() {
    const Clock::time_point now = Clock::now();
    if (stage_)
      report_.seconds.emplace_back(*stage_, std::chrono::duration<double>(now - start_).count());
    stage_.reset();
    start_ = now;
  }

  /// For the stage's own options: work that is the share from `from` to `to` of the stage.
  [[nodiscard]] std::function<void(double)> progress(double from = 0, double to = 1) {
    return [this, from, to](double fraction) { tell(from + (to - from) * fraction); };
  }

 private:
  using Clock = std::chrono::steady_clock;

  void tell(double fraction) {
    if (options_.progress) options_.progress(*stage_, fraction);
  }

  const PipelineOptions& options_;
  PipelineReport& report_;
  Clock::time_point start_ = Clock::now();
  std::optional<Stage> stage_;
};

/// The state of a run from its first stage to its last.
struct Run {
  const PipelineOptions& options;
  PipelineReport report{};
  Stages stages{options, report};
  KeptInput kept{};                  ///< empty where nothing of the input is kept
  double wallThickness = 0;          ///< of the mesh before the first fusion
  std::optional<Focus> focus{};      ///< the same
  std::optional<Opening> opening{};  ///< the same
  FieldReplay replay{};              ///< where the levels were measured
  MovedFlips flips{};                ///< of the base mesh
  Units units{};
  Labels labels{};  ///< for the manifest
  std::vector<std::uint32_t> labelFields{};
  std::optional<ReducedMesh> reduced{};  ///< without its mesh, once that is simplified

  void note(const std::vector<std::string>& sentences) {
    report.notes.insert(report.notes.end(), sentences.begin(), sentences.end());
  }
};

/// Statistics have the unit of their series, unless they are given one. Errors: not-found (a unit
/// of no field).
template <class Field>
Status takeUnits(const std::vector<Field>& fields, Run& run) {
  const auto isThere = [&](std::string_view name) {
    return std::ranges::any_of(
        fields, [&](const Field& field) { return field.name.withoutTime() == name; });
  };
  run.units = run.options.units;
  for (const auto& [name, unit] : run.options.units) {
    if (name.empty()) continue;
    if (!isThere(name))
      return fail(ErrorCode::kNotFound, "`units`: the mesh carries no field '" + name + "'");
    for (const std::string& statistics : statisticsNames(name))
      if (isThere(statistics)) run.units.try_emplace(statistics, unit);
  }
  return {};
}

/// The instants of that time come before the others of their series.
void openAt(double time, TetMesh& mesh, QuantisedMesh& quantised) {
  const std::vector<std::size_t> order = seriesOrder(mesh.fields, time);
  putInOrder(order, mesh.fields);
  putInOrder(order, quantised.mesh.fields);
  putInOrder(order, quantised.mesh.values);
  putInOrder(order, quantised.missing);
  putInOrder(order, quantised.report.nonFiniteOf);
}

Result<QuantisedMesh> prepare(TetMesh&& given, Run& run) {
  TetMesh mesh = std::move(given);
  if (run.options.timeStatistics)
    if (Status added = addTimeStatistics(mesh.fields); !added)
      return std::unexpected(added.error());
  if (Status s = takeUnits(mesh.fields, run); !s) return std::unexpected(s.error());
  if (Status s = checkValueBounds(mesh.fields, run.options.quantise.errors, run.units); !s)
    return std::unexpected(s.error());
  putInOrder(seriesOrder(mesh.fields), mesh.fields);
  const bool keeps = run.options.keep.any();
  run.report.tetrahedraIn = mesh.tetrahedra.size();
  if (Status s = run.stages.begin(Stage::kClean); !s) return std::unexpected(s.error());
  const std::vector<Tetrahedron> asStored = keeps ? mesh.tetrahedra : std::vector<Tetrahedron>{};
  Result<CleanReport> cleaned = cleanMesh(mesh, run.options.stop);
  if (!cleaned) return std::unexpected(cleaned.error());
  run.report.clean = std::move(*cleaned);
  run.note(run.report.clean.sentences());
  if (run.options.keep.originalCells) run.kept.originalCells = takeOriginalCells(mesh);

  if (Status s = run.stages.begin(Stage::kQuantise); !s) return std::unexpected(s.error());
  Result<QuantisedMesh> out = quantise(mesh, run.options.quantise, run.options.stop,
                                       std::exchange(run.report.clean.boundary, {}));
  if (!out) return out;
  run.wallThickness = wallThicknessOf(out->mesh);
  run.focus = focusOf(out->mesh);
  if (!run.options.opensAtFirst)
    if (const auto time = openingTime(out->mesh, run.focus)) openAt(*time, mesh, *out);
  run.report.quantise = out->report;
  run.note(out->report.notes);
  run.opening = openingOf(out->mesh, run.focus);
  if (keeps) {
    run.kept.options = run.options.keep;
    run.kept.mesh = asRead(mesh, asStored, run.report.clean);
  }
  return out;
}

/// Simplifies by the algorithm asked for; the paper's leaves its figures in the report.
Result<FusionHistory> fuse(LatticeMesh&& mesh, const FusionOptions& options, Run& run) {
  const EarlierFusions* const earlier = run.reduced ? &run.reduced->fusions : nullptr;
  if (run.options.parts) {
    Result<PartsFusion> fused =
        simplifyInParts(std::move(mesh), options, *run.options.parts, earlier);
    if (!fused) return std::unexpected(fused.error());
    run.note(
        {fused->bands > 0
             ? "the mesh was simplified in parts, in " + std::to_string(fused->bands) + " bands"
             : "the mesh is too small for parts, and was simplified in one piece"});
    return std::move(fused->history);
  }
  if (run.options.algorithm != Algorithm::kPaper)
    return simplify(std::move(mesh), options, {}, earlier);
  Result<PaperFusion> fused = simplifyAsThePaper(mesh, options);
  if (!fused) return std::unexpected(fused.error());
  run.report.paper = fused->figures;
  return std::move(fused->history);
}

// Share of simplifying that goes into fusing, where a log has series.
constexpr double kFusingShare = 0.8;

/// Notes which labels count, for measuring and the manifest.
void takeLabels(const MeshFigures& mesh, const FusionOptions& options, Run& run) {
  for (const LabelCost& label : options.cost.labels) {
    const FieldInfo& info = mesh.fields()[label.field];
    const std::set<std::int32_t>& values = mesh.labels().valuesOf(label.field);
    run.labelFields.push_back(static_cast<std::uint32_t>(label.field));
    run.labels[std::string(info.name.withoutTime())].merge(
        namesOfValues(info, {values.begin(), values.end()}));
    if (run.report.boundaryWeight && label.weight > 0)
      run.report.labelWeights.emplace_back(info.name, label.weight);
  }
}

/// Chooses what counts when cells are fused.
Result<FusionOptions> choose(const MeshFigures& mesh, Run& run) {
  Result<FusionOptions> options = fusionOptionsFor(run.options, mesh, run.report.notes);
  if (!options) return options;
  options->stop = run.options.stop;
  if (run.options.algorithm != Algorithm::kPaper &&
      !costPartsOf(mesh.fields(), mesh.isOneValue(), options->cost.fieldWeights).empty())
    run.report.boundaryWeight = options->cost.boundaryWeight;
  takeLabels(mesh, *options, run);
  return options;
}

/// A mesh that is simplified from its first cell on, or what a reduction has left.
struct ReadyMesh {
  QuantisedMesh quantised;
  FusionOptions options;
};

Result<ReadyMesh> readyOf(TetMesh&& mesh, Run& run) {
  Result<QuantisedMesh> quantised = prepare(std::move(mesh), run);
  if (!quantised) return std::unexpected(quantised.error());
  if (Status s = run.stages.begin(Stage::kSimplify); !s) return std::unexpected(s.error());
  Result<FusionOptions> options = choose(LatticeFigures(quantised->mesh), run);
  if (!options) return std::unexpected(options.error());
  return ReadyMesh{std::move(*quantised), std::move(*options)};
}

/// Cleans the pieces and puts them on the lattice.
Result<CleanedPieces> prepare(InputPieces& pieces, Run& run) {
  if (Status s = run.stages.begin(Stage::kClean); !s) return std::unexpected(s.error());
  Result<CleanedPieces> out = CleanedPieces::of(pieces, {.quantise = run.options.quantise,
                                                         .units = run.options.units,
                                                         .spool = run.options.spool,
                                                         .stop = run.options.stop});
  if (!out) return out;
  run.report.tetrahedraIn = out->cellsOfInput();
  run.report.clean = out->cleanReport();
  run.report.quantise = out->quantiseReport();
  run.note(run.report.clean.sentences());
  run.note(out->notes());
  run.note(run.report.quantise.notes);
  if (Status s = takeUnits(out->fields(), run); !s) return std::unexpected(s.error());
  return out;
}

/// Reduces the pieces to the log's last level.
Result<ReadyMesh> readyOf(InputPieces& input, Run& run) {
  Result<CleanedPieces> pieces = prepare(input, run);
  if (!pieces) return std::unexpected(pieces.error());
  if (Status s = run.stages.begin(Stage::kQuantise); !s) return std::unexpected(s.error());
  Result<OriginalFigures> figures = OriginalFigures::of(*pieces);
  if (!figures) return std::unexpected(figures.error());
  if (Status s = run.stages.begin(Stage::kReduce); !s) return std::unexpected(s.error());
  run.wallThickness = figures->wallThickness();
  Result<FusionOptions> options = choose(*figures, run);
  if (!options) return std::unexpected(options.error());
  ReduceOptions own;
  own.cells = *run.options.finest;
  own.spool = run.options.spool;
  own.progress = run.stages.progress();
  if (run.options.measure) {
    const MeasuredPlaces places = placesFor(run.options.measure->effort, pieces->tetrahedra());
    own.samples = {places.volume, places.vertices};
    own.surfaceSamples = places.surface;
  }
  FusionOptions inBlocks = *options;
  if (run.options.memory) {
    const std::uint64_t blocks = std::max<std::uint64_t>(1, *run.options.memory / kBlockBytes);
    inBlocks.threads = static_cast<int>(
        std::min<std::uint64_t>(static_cast<std::uint64_t>(std::max(inBlocks.threads, 1)), blocks));
  }
  Result<ReducedMesh> out = reduceMesh(*pieces, *figures, inBlocks, own);
  if (!out) return std::unexpected(out.error());
  ReadyMesh ready{.quantised = {.mesh = std::move(out->mesh),
                                .report = run.report.quantise,
                                .missing = std::move(out->missing)},
                  .options = std::move(*options)};
  ready.options.envelopeTolerance = out->envelopeTolerance;
  run.note({"the log ends at " + std::to_string(ready.quantised.mesh.tetrahedra.size()) + " of " +
            std::to_string(out->tetrahedra) + " cells; the mesh was reduced to them in " +
            std::to_string(out->bands) + " bands of blocks"});
  run.reduced = std::move(*out);
  run.focus = focusOf(ready.quantised.mesh);
  run.opening = openingOf(ready.quantised.mesh, run.focus);
  if (Status s = run.stages.begin(Stage::kSimplify); !s) return std::unexpected(s.error());
  return ready;
}

/// The history, with predictions of instants from others in the order of seriesOrder.
Result<FusionHistory> simplify(ReadyMesh& ready, Run& run) {
  const bool hasSeries = !seriesOf(ready.quantised.mesh.fields).empty();
  ready.options.progress = run.stages.progress(0, hasSeries ? kFusingShare : 1);
  Result<FusionHistory> history = fuse(std::move(ready.quantised.mesh), ready.options, run);
  if (!history) return history;
  if (run.reduced) run.reduced->fusions.quadrics = {};
  const Result<std::size_t> predicted =
      predictInTime(*history, run.options.stop, run.stages.progress(kFusingShare, 1));
  if (!predicted) return std::unexpected(predicted.error());
  return history;
}

/// Where the base mesh is: by a rule, unless its size or the error of all levels was asked for.
std::optional<BaseRule> baseRuleOf(const PipelineOptions& options) {
  if (options.measure->base) return options.measure->base;
  if (options.fusion.targetRatio || options.fusion.baseCells || options.measure->bounds.boundary ||
      options.algorithm == Algorithm::kPaper)
    return std::nullopt;
  return BaseRule{kBaseError, kMaxBaseCells, kMaxBaseBytes};
}

/// Whether fused values may move once they are measured.
bool movesCoarse(const PipelineOptions& options) {
  return options.valueCodec == CodecId::kLifted && !options.exactCoarse;
}

/// The known error of each level; with bounds, the history ends where they would be passed.
Result<LevelErrors> measure(FusionHistory& history, Run& run) {
  if (!run.options.measure) return LevelErrors{};
  if (Status s = run.stages.begin(Stage::kMeasure); !s) return std::unexpected(s.error());
  MeasureOptions options = *run.options.measure;
  options.countsRounding = true;
  if (movesCoarse(run.options)) options.replay = &run.replay;
  options.labels = run.labelFields;
  if (run.reduced) options.before = &run.reduced->samples;
  options.base = baseRuleOf(run.options);
  options.threads = run.options.fusion.threads;
  options.progress = run.stages.progress();
  options.stop = run.options.stop;
  return measureLevels(history, options);
}

/// Says whether cells of the base mesh are inside out at some instant.
void lookForFlips(const FusionHistory& history, Run& run) {
  run.flips = movedFlips(history);
  if (run.flips.instants > 1 && run.flips.flipped == 0)
    run.note({"no cell of the base mesh is inside out at the " +
              std::to_string(run.flips.instants) + " instants of " + std::string(kDisplacement)});
}

/// The rules of the fields' levels; their values become what is coded.
Result<std::vector<LiftingRules>> toCodedValues(FusionHistory& history, const ValueOrder& order,
                                                const QuantisedMesh& quantised, LevelErrors& errors,
                                                Run& run) {
  std::vector<LiftingRules> rules;
  if (run.options.valueCodec == CodecId::kLifted) {
    LiftOptions options;
    options.missing = quantised.missing;
    options.stop = run.options.stop;
    if (run.options.measure)  // a bound was measured with the values that are there
      for (const auto& [name, bound] : run.options.measure->bounds.fields)
        if (const auto field = fieldOfKey(history.fields, name)) options.exact.push_back(*field);
    if (!errors.empty() && movesCoarse(run.options)) options.replay = &run.replay;
    Result<std::vector<LiftingRules>> lifted = liftFields(history, order, errors, options);
    if (!lifted) return std::unexpected(lifted.error());
    rules = std::move(*lifted);
  }
  lookForFlips(history, run);
  restoreMissing(history, quantised.missing);
  toTimeDifferences(history);
  return rules;
}

Result<MadeLog> encode(FusionHistory& history, const QuantisedMesh& quantised, LevelErrors errors,
                       Run& run) {
  if (Status s = run.stages.begin(Stage::kEncode); !s) return std::unexpected(s.error());
  Result<std::unique_ptr<ByteSpool>> spool =
      run.options.spool ? run.options.spool() : std::make_unique<MemorySpool>();
  if (!spool) return std::unexpected(spool.error());
  LogWriterOptions options;
  options.source = run.options.source;
  options.generator = "qtet " + version();
  options.progress = run.stages.progress();
  options.stop = run.options.stop;
  options.focus = run.focus;
  options.opening = run.opening;
  options.units = run.units;
  options.labels = run.labels;
  if (run.reduced) options.original = {run.reduced->tetrahedra, run.reduced->vertices};
  options.valueCodec = run.options.valueCodec;
  if (run.options.keep.any())
    options.closing = [&](const FinestMesh& finest, const ClosingSink& give) -> Status {
      if (Status s = run.stages.begin(Stage::kKeep); !s) return s;
      return giveInput(history, finest, run.kept, run.options.stop, give);
    };
  LogEncoder encoder(history, std::move(options));
  if (Status s = encoder.writeGeometry(); !s) return std::unexpected(s.error());
  Result<std::vector<LiftingRules>> rules =
      toCodedValues(history, encoder.order(), quantised, errors, run);
  if (!rules) return std::unexpected(rules.error());
  encoder.options().rules = std::move(*rules);
  encoder.options().errors = std::move(errors);
  Result<EncodedHead> encoded =
      encoder.finish([&](ByteView block) { return (*spool)->append(block); });
  if (!encoded) return std::unexpected(encoded.error());
  run.report.statistics = std::move(encoded->statistics);
  return MadeLog{std::move(encoded->head), std::move(*spool), std::move(encoded->later)};
}

void warn(Run& run) {
  const PipelineOptions& options = run.options;
  if (options.measure)
    run.report.warnings = lossWarnings(
        run.report.manifest,
        {run.report.clean, run.wallThickness, options.measure->bounds.boundary.value_or(0),
         options.fusion.targetRatio.has_value(), !options.measure->base && baseRuleOf(options)});
  if (const auto warning = run.flips.warning()) run.report.warnings.push_back(*warning);
  const std::vector<std::string>& outlying = run.report.quantise.warnings;
  run.report.warnings.insert(run.report.warnings.end(), outlying.begin(), outlying.end());
}

/// Simplifies, measures and encodes.
Result<PipelineOutput> logOf(Result<ReadyMesh> ready, Run& run) {
  if (!ready) return std::unexpected(ready.error());
  Result<FusionHistory> history = simplify(*ready, run);
  if (!history) return std::unexpected(history.error());
  Result<LevelErrors> errors = measure(*history, run);
  if (!errors) return std::unexpected(errors.error());
  Result<MadeLog> log = encode(*history, ready->quantised, std::move(*errors), run);
  if (!log) return std::unexpected(log.error());
  run.stages.end();
  if (Status read = readBack(*log, run.report); !read) return std::unexpected(read.error());
  if (run.report.index.hasSeries()) run.note({differencesNote(run.report.index)});
  warn(run);
  return PipelineOutput{std::move(*log), std::move(run.report)};
}

Status badValue(std::string what) { return fail(ErrorCode::kBadValue, std::move(what)); }

}  // namespace

Status readBack(const MadeLog& log, PipelineReport& report) {
  Result<LogIndex> index = LogIndex::parse(log.head, log.later);
  if (!index) return std::unexpected(index.error());
  report.index = std::move(*index);
  Result<Manifest> manifest = manifestOf(report.index);
  if (!manifest) return std::unexpected(manifest.error());
  report.manifest = std::move(*manifest);
  return {};
}

std::string differencesNote(const LogIndex& index) {
  const auto count = std::ranges::count_if(
      index.fields, [](const FieldShape& field) { return !field.prediction.isNone(); });
  return std::to_string(count) + " of " + std::to_string(index.fields.size()) +
         " fields are instants that are coded as differences in time";
}

Status checkOptions(const PipelineOptions& options) {
  const FusionOptions& fusion = options.fusion;
  const bool isPaper = options.algorithm == Algorithm::kPaper;
  if (isPaper && (options.regions || options.parts || fusion.envelopeTolerance.value_or(0) > 0 ||
                  !options.fieldWeights.empty() || !options.labelWeights.empty()))
    return badValue(
        "`algorithm` paper knows no `regions`, `parts`, `envelopeTolerance`, `fieldWeights` or "
        "`labelWeights`; leave them out");
  if (options.finest && (isPaper || options.keep.any()))
    return badValue(
        "`finest` reduces the mesh before, which `algorithm` paper does not, and no input is kept "
        "of it (`keepOrder`, `lossless`); leave one of them out");
  for (const auto& [weights, option] : {std::pair(&options.fieldWeights, "`fieldWeights`"),
                                        std::pair(&options.labelWeights, "`labelWeights`")})
    for (const auto& [name, weight] : *weights)
      if (!(weight >= 0) || std::isinf(weight))
        return badValue(std::string(option) + " of " + name + " is negative or not finite");
  return {};
}

Result<PipelineOutput> simplifyToLog(TetMesh&& mesh, const PipelineOptions& options) {
  if (Status checked = checkOptions(options); !checked) return std::unexpected(checked.error());
  constexpr std::uint64_t kAddresses = std::numeric_limits<std::size_t>::max();
  if (Status fits = checkRoom(mesh.tetrahedra.size(), kAddresses); !fits)
    return std::unexpected(fits.error());
  if (!options.finest || mesh.tetrahedra.size() <= *options.finest) {
    Run run{options};
    return logOf(readyOf(std::move(mesh), run), run);
  }
  if (options.timeStatistics)
    if (Status added = addTimeStatistics(mesh.fields); !added)
      return std::unexpected(added.error());
  putInOrder(seriesOrder(mesh.fields), mesh.fields);
  CutPieces pieces(std::move(mesh));
  return simplifyToLog(pieces, options);
}

Result<PipelineOutput> simplifyToLog(InputPieces& pieces, const PipelineOptions& options) {
  assert(options.finest);
  if (Status checked = checkOptions(options); !checked) return std::unexpected(checked.error());
  Run run{options};
  return logOf(readyOf(pieces, run), run);
}

}  // namespace qtet
