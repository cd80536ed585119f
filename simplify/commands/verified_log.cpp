#include "simplify/commands/verified_log.h"

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "codec/refine/verify_log.h"
#include "proto/checksum.h"
#include "proto/rounding_error.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/verify.h"
#include "simplify/log/kept_input.h"
#include "simplify/log/opened_list.h"
#include "simplify/log/opened_log.h"
#include "simplify/log/whole_log.h"
#include "simplify/produce/closing_report.h"
#include "simplify/read/read_mesh.h"

namespace qtet {
namespace {

/// The input read as its options say, cleaned and put on the log's lattice, against what was
/// decoded; what was found in `out`.
Status compareWithInput(const OpenedLog& log, const Refiner& refiner, const ComparedInput& input,
                        Progress& progress, OrderedJson& out) {
  if (Status whole = checkWhole(log.manifest); !whole) return whole;
  progress.stage("reading " + input.path);
  std::vector<std::uint32_t> all(log.manifest.fields.size());
  std::iota(all.begin(), all.end(), 0u);
  const LatticeMesh decoded = latticeMesh(log.manifest, refiner, all);
  std::vector<std::string> names;
  for (const FieldInfo& field : decoded.fields)
    names.push_back(field.association + ":" + field.name);
  ReadOptions options = input.options;
  options.fields = names;
  options.originalIds = log.file.hasClosing(ClosingKind::kOriginalCells);
  Result<ReadMesh> read = readMesh(input.path, options);
  if (!read) return std::unexpected(read.error());
  const std::vector<Tetrahedron> asStored = read->mesh.tetrahedra;
  const Result<CleanReport> cleaned = cleanMesh(read->mesh);
  if (!cleaned) return std::unexpected(cleaned.error());
  const auto cells = options.originalIds ? takeOriginalCells(read->mesh) : std::nullopt;

  progress.stage("comparing");
  const Result<OnLattice> expected = putOnLattice(read->mesh, decoded.lattice, decoded.fields);
  if (!expected) return std::unexpected(expected.error());
  const Result<VerifyReport> same = sameMesh(decoded, expected->mesh);
  if (!same) return std::unexpected(same.error());
  const Result<OrderedJson> kept =
      compareKept(log.file, decoded, expected->mesh, asRead(read->mesh, asStored, *cleaned), cells);
  if (!kept) return std::unexpected(kept.error());
  OrderedJson fieldErrors = OrderedJson::object(), valueErrors = OrderedJson::object();
  for (std::size_t f = 0; f < names.size(); ++f) {
    fieldErrors[fieldKey(log.manifest, f)] = expected->largestFieldErrors[f];
    OrderedJson& values = valueErrors[fieldKey(log.manifest, f)];
    values = {{"largest", expected->largestValueErrors[f]},
              {"bound", largestRoundingError(log.manifest.fields[f])}};
    if (const auto unit = unitOf(log.manifest, log.manifest.fields[f].name); !unit.empty())
      values["unit"] = unit;
  }
  out = {{"input", input.path},
         {"sameMesh", true},
         {"largestPositionErrorSteps", expected->largestPositionError},
         {"largestFieldErrorSteps", fieldErrors},
         {"valueErrors", valueErrors},
         {"interchangeableVertices", same->interchangeable},
         {"droppedPoints", cleaned->unusedPoints.count},
         {"droppedCells", cleaned->repeatedVertexCells.count + cleaned->duplicateCells.count},
         {"kept", *kept}};
  return {};
}

Result<OrderedJson> verify(const OpenedLog& log, const std::optional<ComparedInput>& input,
                           Progress& progress) {
  progress.stage("decoding");
  const Result<Refiner> refiner = decodeVerified(
      log.file, log.manifest, [&](double fraction) { return progress.update(fraction), true; },
      input ? Verified::kFields : Verified::kMesh);
  if (!refiner) return std::unexpected(refiner.error());
  const ManifestLevel& finest = log.manifest.levels.back();
  OrderedJson report = {{"ok", true},
                        {"digest", log.file.digest()},
                        {"meshDigest", toHex(refiner->digest())},
                        {"bytes", log.file.bytes().size()},
                        {"chunks", log.file.chunks().size()},
                        {"levels", log.manifest.levels.size()},
                        {"tetrahedra", finest.tetrahedra},
                        {"vertices", finest.vertices},
                        {"boundaryTriangles", finest.boundaryTriangles}};
  if (!input) return report;
  OrderedJson against;
  if (Status s = compareWithInput(log, *refiner, *input, progress, against); !s)
    return std::unexpected(s.error());
  report["against"] = against;
  return report;
}

/// The times of the input's steps; none where it knows none, or cannot be read.
std::vector<double> timesOfInput(const ComparedInput& input) {
  ReadOptions options = input.options;
  options.time = "first";
  options.fields = std::vector<std::string>{};
  options.threshold.reset();
  const Result<ReadMesh> read = readMesh(input.path, options);
  return read ? read->report.times : std::vector<double>{};
}

/// Without --time an input of several steps is read at the instants that the log has.
void takeInstants(const Manifest& manifest, Progress& progress, ComparedInput& input) {
  if (input.options.time != ReadOptions().time) return;
  const std::vector<double> instants = instantTimes(manifest);
  if (instants.empty()) return;
  progress.stage("reading the times of " + input.path);
  if (timesOfInput(input).empty()) return;
  input.options.time = timesText(instants);
  input.options.namesTime = true;
}

}  // namespace

Result<OrderedJson> verifyLog(const std::string& path, std::optional<ComparedInput> input,
                              Progress& progress) {
  progress.stage("checking checksums");
  const Result<OpenedLog> log = openLog(path);
  if (!log) return std::unexpected(log.error());
  if (input) takeInstants(log->manifest, progress, *input);
  return verify(*log, input, progress);
}

Result<OrderedJson> verifyList(const std::string& path, std::optional<ComparedInput> input,
                               Progress& progress) {
  const Result<SegmentList> list = openList(path);
  if (!list) return std::unexpected(list.error());
  OrderedJson report = {{"ok", true}, {"segments", OrderedJson::array()}};
  for (const Segment& segment : list->segments) {
    if (input) input->options.time = timesText(segment.times), input->options.namesTime = true;
    progress.stage("checking checksums of " + segment.log);
    const Result<OpenedLog> log = openSegment(path, segment);
    if (!log) return std::unexpected(log.error());
    Result<OrderedJson> one = verify(*log, input, progress);
    if (!one) {
      one.error().message = path + ", " + segment.log + ": " + one.error().message;
      return one;
    }
    report["segments"].push_back(
        {{"log", segment.log}, {"times", segment.times}, {"verified", std::move(*one)}});
  }
  return report;
}

}  // namespace qtet
