// simplify/api/qtet_simplify.h: options, the work, and what it made.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "codec/api/c_api_handle.h"
#include "codec/files/atomic_file.h"
#include "codec/refine/refiner.h"
#include "simplify/api/input_arrays.h"
#include "simplify/api/reported_work.h"
#include "simplify/mesh/workers.h"

struct qtet_simplified : qtet::Failure {
  static constexpr const char* kShortOfMemory =
      "out-of-memory: there is not enough memory for the mesh";

  qtet::Bytes log;
  std::string notes;
};

using qtet::ErrorCode;
using qtet::fail;
using qtet::guarded;
using qtet::PipelineOptions;
using qtet::PipelineOutput;
using qtet::Result;
using qtet::Status;

namespace {

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

/// Bytes of the structs of the first version: to the end of the member that was its last.
constexpr std::size_t kFirstMeshBytes =
    offsetof(qtet_input_mesh, fieldBytes) + sizeof(qtet_input_mesh::fieldBytes);
constexpr std::size_t kFirstOptionsBytes =
    offsetof(qtet_simplify_options, user) + sizeof(qtet_simplify_options::user);

qtet_simplify_options defaults() {
  const PipelineOptions usual;
  qtet_simplify_options out{};
  out.targetRatio = kUnset;
  out.boundaryWeight = kUnset;
  out.shapeWeight = usual.fusion.shapeWeight;
  out.envelopeTolerance = kUnset;
  out.positionBits = static_cast<std::uint32_t>(usual.quantise.positionBits);
  out.fieldBits = static_cast<std::uint32_t>(usual.quantise.fieldBits);
  out.measure = QTET_MEASURE_LEVELS;
  out.threads = 1;
  out.maxBoundaryError = kUnset;
  out.baseError = kUnset;
  return out;
}

/// The caller's struct of `bytes` bytes in the shape of this version: what he does not have stays
/// as it is.
template <class Struct>
void take(Struct& out, const Struct& given, std::size_t bytes) {
  std::memcpy(static_cast<void*>(&out), &given, std::min(bytes, sizeof(Struct)));
}

/// Errors: bad-value, with the first member that names none of its choices.
Status checkChoices(const qtet_simplify_options& options) {
  struct Choice {
    std::uint32_t number, last;
    const char* member;
  };
  for (const Choice& choice : {Choice{options.algorithm, QTET_ALGORITHM_PAPER, "algorithm"},
                               {options.placement, QTET_PLACEMENT_VERTEX, "placement"},
                               {options.measure, QTET_MEASURE_ALL, "measure"},
                               {options.valueCodec, QTET_CODEC_ADAPTIVE, "valueCodec"},
                               {options.keepOrder, 1, "keepOrder"},
                               {options.lossless, 1, "lossless"},
                               {options.originalIds, 1, "originalIds"},
                               {options.timeStatistics, 1, "timeStatistics"},
                               {options.exactCoarse, 1, "exactCoarse"}})
    if (choice.number > choice.last)
      return fail(ErrorCode::kBadValue, std::string(choice.member) + " is " +
                                            std::to_string(choice.number) + "; the last is " +
                                            std::to_string(choice.last));
  return {};
}

using NamedNumbers = std::vector<std::pair<std::string, double>>;

Result<NamedNumbers> namedNumbers(const qtet_named_number* from, std::uint32_t count,
                                  const std::string& member) {
  if (count > 0 && from == nullptr) return fail(ErrorCode::kBadValue, member + " is null");
  NamedNumbers out;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (from[i].name == nullptr || !(from[i].value >= 0) || std::isinf(from[i].value))
      return fail(ErrorCode::kBadValue,
                  member + "[" + std::to_string(i) +
                      "] has no name, or a value that is negative or not finite");
    out.emplace_back(from[i].name, from[i].value);
  }
  return out;
}

/// Values and units are checked with the fields (checkValueBounds).
Result<qtet::ValueBounds> valueBoundsOf(const qtet_simplify_options& from) {
  if (from.errorCount > 0 && from.errors == nullptr)
    return fail(ErrorCode::kBadValue, "errors is null");
  qtet::ValueBounds out;
  for (std::uint32_t i = 0; i < from.errorCount; ++i) {
    const qtet_error_bound& bound = from.errors[i];
    if (bound.name == nullptr)
      return fail(ErrorCode::kBadValue, "errors[" + std::to_string(i) + "] has no name");
    out.emplace_back(bound.name,
                     qtet::ValueBound{bound.value, bound.unit != nullptr ? bound.unit : ""});
  }
  return out;
}

/// NaN: not set.
std::optional<double> setNumber(double given) {
  return std::isnan(given) ? std::nullopt : std::optional(given);
}

Result<std::optional<qtet::MeasureOptions>> measureOptionsOf(const qtet_simplify_options& from) {
  Result<NamedNumbers> fields =
      namedNumbers(from.maxFieldErrors, from.maxFieldErrorCount, "maxFieldErrors");
  if (!fields) return std::unexpected(fields.error());
  qtet::MeasureOptions out;
  out.effort = from.measure == QTET_MEASURE_ALL ? qtet::Effort::kAll : qtet::Effort::kLevels;
  out.bounds = {setNumber(from.maxBoundaryError), std::move(*fields)};
  if (const auto error = setNumber(from.baseError)) {
    if (!(*error >= 0) || std::isinf(*error))
      return fail(ErrorCode::kBadValue, "baseError is negative or not finite");
    out.base = {.error = *error};
  }
  if (from.measure != QTET_MEASURE_NONE) return out;
  if (out.bounds.any() || out.base)
    return fail(ErrorCode::kBadValue, "an error bound needs measuring; see measure");
  return std::nullopt;
}

qtet::FusionOptions fusionOptionsOf(const qtet_simplify_options& from) {
  constexpr std::array kPlacements{qtet::PlacementRule::kAuto, qtet::PlacementRule::kOptimal,
                                   qtet::PlacementRule::kVertex};
  qtet::FusionOptions out;
  out.targetRatio = setNumber(from.targetRatio);
  if (from.baseCells != 0) out.baseCells = from.baseCells;
  out.cost.boundaryWeight = setNumber(from.boundaryWeight);
  out.envelopeTolerance = setNumber(from.envelopeTolerance);
  out.shapeWeight = from.shapeWeight;
  out.placement = kPlacements[from.placement];
  out.threads = qtet::threadsAtOnce(static_cast<int>(std::clamp(from.threads, 1u, 1024u)));
  return out;
}

Result<PipelineOptions> optionsOf(const qtet_simplify_options& from) {
  if (Status checked = checkChoices(from); !checked) return std::unexpected(checked.error());
  Result<NamedNumbers> weights =
      namedNumbers(from.fieldWeights, from.fieldWeightCount, "fieldWeights");
  if (!weights) return std::unexpected(weights.error());
  Result<NamedNumbers> labels =
      namedNumbers(from.labelWeights, from.labelWeightCount, "labelWeights");
  if (!labels) return std::unexpected(labels.error());
  Result<qtet::ValueBounds> errors = valueBoundsOf(from);
  if (!errors) return std::unexpected(errors.error());
  Result<std::optional<qtet::MeasureOptions>> measure = measureOptionsOf(from);
  if (!measure) return std::unexpected(measure.error());
  PipelineOptions out;
  out.source = from.source != nullptr ? from.source : "";
  out.algorithm =
      from.algorithm == QTET_ALGORITHM_PAPER ? qtet::Algorithm::kPaper : qtet::Algorithm::kQtet;
  // beyond any limit as well as these numbers
  out.quantise = {static_cast<int>(std::min(from.positionBits, 1000u)),
                  static_cast<int>(std::min(from.fieldBits, 1000u)), std::move(*errors)};
  out.fusion = fusionOptionsOf(from);
  out.fieldWeights = std::move(*weights);
  out.labelWeights = std::move(*labels);
  if (from.regions != nullptr) out.regions = from.regions;
  out.measure = std::move(*measure);
  out.valueCodec = from.valueCodec == QTET_CODEC_LIFTED  ? qtet::CodecId::kLifted
                   : from.valueCodec == QTET_CODEC_DRACO ? qtet::CodecId::kDraco
                                                         : qtet::CodecId::kAdaptive;
  out.keep = {from.keepOrder != 0, from.lossless != 0, from.originalIds != 0};
  out.timeStatistics = from.timeStatistics != 0;
  out.exactCoarse = from.exactCoarse != 0;
  if (from.finest != 0) out.finest = from.finest;
  return out;
}

static_assert(static_cast<int>(qtet::Stage::kClean) == QTET_STAGE_CLEAN &&
              static_cast<int>(qtet::Stage::kMeasure) == QTET_STAGE_MEASURE &&
              static_cast<int>(qtet::Stage::kKeep) == QTET_STAGE_KEEP &&
              static_cast<int>(qtet::Stage::kReduce) == QTET_STAGE_REDUCE);

Result<PipelineOutput> make(const qtet_input_mesh& arrays, const qtet_simplify_options& given) {
  const Result<PipelineOptions> options = optionsOf(given);
  if (!options) return std::unexpected(options.error());
  Result<qtet::TetMesh> mesh = qtet::meshOfArrays(arrays);
  if (!mesh) return std::unexpected(mesh.error());
  if (Status checked = checkArrays(*mesh); !checked) return std::unexpected(checked.error());
  if (given.progress == nullptr) return simplifyToLog(std::move(*mesh), *options);
  return simplifyAndReport(std::move(*mesh), *options, [&](qtet::Stage stage, double fraction) {
    return given.progress(given.user, static_cast<std::uint32_t>(stage), fraction) == 0;
  });
}

qtet_status tooShort(qtet_simplified* made, const char* what, std::size_t bytes,
                     std::size_t needed) {
  return made->refuse(QTET_BAD_ARGUMENT, std::string(what) + " has " + std::to_string(bytes) +
                                             " bytes, it needs " + std::to_string(needed) +
                                             "; pass sizeof");
}

}  // namespace

qtet_status qtet_simplify_defaults(size_t optionsBytes, qtet_simplify_options* options) {
  if (options == nullptr || optionsBytes < kFirstOptionsBytes) return QTET_BAD_ARGUMENT;
  const qtet_simplify_options usual = defaults();
  std::memset(static_cast<void*>(options), 0, optionsBytes);
  std::memcpy(options, &usual, std::min(optionsBytes, sizeof usual));
  return QTET_OK;
}

qtet_simplified* qtet_simplified_create() { return new (std::nothrow) qtet_simplified; }
void qtet_simplified_destroy(qtet_simplified* made) { delete made; }
const char* qtet_simplified_error(const qtet_simplified* made) {
  return made != nullptr ? made->text : "bad-argument: the place for the log is null";
}

qtet_status qtet_simplify(qtet_simplified* made, size_t meshBytes, const qtet_input_mesh* mesh,
                          size_t optionsBytes, const qtet_simplify_options* options) {
  return guarded(made, [&]() -> qtet_status {
    made->log = {};
    made->notes.clear();
    if (mesh == nullptr) return made->refuse(QTET_BAD_ARGUMENT, "the mesh is null");
    if (meshBytes < kFirstMeshBytes) return tooShort(made, "the mesh", meshBytes, kFirstMeshBytes);
    if (options != nullptr && optionsBytes < kFirstOptionsBytes)
      return tooShort(made, "options", optionsBytes, kFirstOptionsBytes);
    qtet_input_mesh arrays{};
    take(arrays, *mesh, meshBytes);
    qtet_simplify_options given = defaults();
    if (options != nullptr) take(given, *options, optionsBytes);
    Result<PipelineOutput> output = make(arrays, given);
    if (!output) return made->refuse(output.error());
    for (const std::string& note : output->report.notes) made->notes += note + "\n";
    for (const std::string& warning : output->report.warnings)
      made->notes += "warning: " + warning + "\n";
    Result<qtet::Bytes> log = output->log.bytes();
    if (!log) return made->refuse(log.error());
    made->log = std::move(*log);
    return QTET_OK;
  });
}

const void* qtet_simplified_log(const qtet_simplified* made, size_t* bytes) {
  const bool isThere = made != nullptr && !made->log.empty();
  if (bytes != nullptr) *bytes = isThere ? made->log.size() : 0;
  return isThere ? made->log.data() : nullptr;
}

qtet_status qtet_simplified_write(qtet_simplified* made, const char* path) {
  return guarded(made, [&]() -> qtet_status {
    if (path == nullptr) return made->refuse(QTET_BAD_ARGUMENT, "the path is null");
    if (made->log.empty()) return made->refuse(QTET_NO_LOG, "no log was made: qtet_simplify first");
    const Status written = qtet::writeFileAtomically(path, made->log);
    return written ? QTET_OK : made->refuse(written.error());
  });
}

const char* qtet_simplified_notes(const qtet_simplified* made) {
  return made != nullptr ? made->notes.c_str() : "";
}
