#include "simplify/pipeline/series_pipeline.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "codec/log/log_manifest.h"
#include "codec/refine/log_edit.h"
#include "codec/refine/log_file.h"
#include "proto/field_name.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/log/add_fields.h"
#include "simplify/series/series.h"
#include "simplify/series/time_statistics.h"

namespace qtet {
namespace {

/// The time that the log opens at, if that is not its series' first.
std::optional<double> laterOpening(const Manifest& manifest) {
  for (const Series& series : manifest.series) {
    const auto shown = std::ranges::min_element(series.fields) - series.fields.begin();
    if (shown != 0) return series.times[static_cast<std::size_t>(shown)];
  }
  return std::nullopt;
}

/// The log's fields that are no instants, or such of the time.
std::vector<std::uint32_t> fieldsThatStay(const Manifest& manifest, std::optional<double> time) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t f = 0; f < manifest.fields.size(); ++f) {
    const auto instant = manifest.fields[f].name.instant();
    if (!instant || instant->time == time) out.push_back(f);
  }
  return out;
}

AddFieldsOptions addingOptions(const PipelineOptions& options) {
  AddFieldsOptions out;
  out.fieldBits = options.quantise.fieldBits;
  if (options.measure) out.effort = options.measure->effort;
  out.threads = options.fusion.threads;
  out.scalesOfOthers = true;
  return out;
}

/// The fields of all steps: a series that has every instant of the sample has every step.
std::size_t fieldsOfAll(std::span<const MeshField> sample, std::size_t steps) {
  std::size_t out = sample.size();
  const std::size_t sampled = sampledSteps(steps).size();
  for (const Series& series : seriesOf(sample))
    if (series.fields.size() == sampled) out += steps - sampled;
  return out;
}

Result<TetMesh> readSteps(const InstantsReader& read, std::size_t begin, std::size_t end) {
  std::vector<std::size_t> window(end - begin);
  std::iota(window.begin(), window.end(), begin);
  return read(window);
}

/// Puts the statistics of all steps behind the fields of the sample.
Status addStatistics(std::size_t steps, const InstantsReader& read, const std::stop_token& stop,
                     std::vector<MeshField>& sample) {
  if (Status checked = checkTimeStatistics(sample, fieldsOfAll(sample, steps)); !checked)
    return checked;
  TimeStatistics statistics;
  for (std::size_t begin = 0; begin < steps; begin += kWindow) {
    if (stop.stop_requested()) return cancelled();
    const Result<TetMesh> mesh = readSteps(read, begin, std::min(begin + kWindow, steps));
    if (!mesh) return std::unexpected(mesh.error());
    if (Status added = statistics.add(mesh->fields); !added) return added;
  }
  // Series that the sample shows once, or not at all, have statistics as well.
  for (MeshField& made : statistics.take()) {
    if (std::ranges::find(sample, made.name, &MeshField::name) != sample.end())
      return fail(ErrorCode::kBadValue,
                  "two fields would have the name " + made.name +
                      ", one of them for the statistics over time; rename the input's field or "
                      "series, or leave out `time-statistics`");
    sample.push_back(std::move(made));
  }
  return {};
}

/// Adds all instants but those of the time `known`.
Status addAll(std::size_t steps, const InstantsReader& read, const PipelineOptions& options,
              std::optional<double> known, FieldAdder& adder) {
  // the first window has both of its ends; the others begin with the end of the one before
  for (std::size_t begin = 0, end = kWindow + 1; begin < steps; begin = end, end += kWindow) {
    if (options.stop.stop_requested()) return cancelled();
    if (options.progress)
      options.progress(Stage::kEncode, static_cast<double>(begin) / static_cast<double>(steps));
    Result<TetMesh> mesh = readSteps(read, begin, std::min(end, steps));
    if (!mesh) return std::unexpected(mesh.error());
    std::erase_if(mesh->fields, [&](const MeshField& field) {
      const auto instant = field.name.instant();
      return !instant || instant->time == known;
    });
    if (const auto cleaned = cleanMesh(*mesh, options.stop); !cleaned)
      return std::unexpected(cleaned.error());
    if (Status s = adder.add(*mesh); !s) return s;
  }
  return {};
}

/// Puts the new log in the place of that of the sample.
Status replaceLog(const EditedLog& edited, const PipelineOptions& options, PipelineOutput& out) {
  Result<std::unique_ptr<ByteSpool>> spool =
      options.spool ? options.spool() : std::make_unique<MemorySpool>();
  if (!spool) return std::unexpected(spool.error());
  if (Status s = edited.writeBlocksTo([&](ByteView block) { return (*spool)->append(block); }); !s)
    return s;
  out.log = {edited.head(), std::move(*spool), edited.later()};
  return readBack(out.log, out.report);
}

/// The figures of the mesh are those of the sample's log. Those of the fields are counted again.
void countFields(PipelineOutput& out) {
  PipelineReport& report = out.report;
  LogStatistics& statistics = report.statistics;
  statistics.headBytes = report.index.headBytes() + out.log.later.size();
  statistics.fileBytes = report.index.fileBytes;
  statistics.fieldBytes.assign(report.index.fields.size(), 0);
  for (const ChunkEntry& chunk : report.index.chunks)
    for (std::size_t f = 0; f < statistics.fieldBytes.size(); ++f)
      statistics.fieldBytes[f] += chunk.blocks[kFirstFieldPart + f].size;
  statistics.baseBytes = report.index.chunks.front().size();
}

}  // namespace

std::vector<std::size_t> sampledSteps(std::size_t steps) {
  const std::size_t count = std::min(steps, kSampledInstants);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(count == 1 ? 0 : i * (steps - 1) / (count - 1));
  return out;
}

Result<PipelineOutput> simplifySeries(TetMesh&& sample, std::size_t steps,
                                      const InstantsReader& read, const PipelineOptions& options) {
  if (options.keep.exact)
    return fail(ErrorCode::kBadValue,
                "`lossless` keeps the values of all instants in memory, which are too many; leave "
                "it out, or choose fewer with `time`");
  if (options.finest)
    return fail(ErrorCode::kBadValue,
                "`finest` takes all instants at once, which are too many for the memory; choose "
                "fewer with `time`, or leave it out");
  PipelineOptions ofSample = options;
  if (std::exchange(ofSample.timeStatistics, false))
    if (Status added = addStatistics(steps, read, options.stop, sample.fields); !added)
      return std::unexpected(added.error());
  ValueBounds bounds = withRanges(sample.fields, options.quantise.errors);
  Result<PipelineOutput> out = simplifyToLog(std::move(sample), ofSample);
  if (!out) return out;
  const auto start = std::chrono::steady_clock::now();
  Result<Bytes> bytes = out->log.bytes();
  if (!bytes) return std::unexpected(bytes.error());
  out->log = {};
  const Result<LogFile> log = LogFile::fromBytes(std::move(*bytes));
  if (!log) return std::unexpected(log.error());
  AddFieldsOptions adding = addingOptions(options);
  adding.errors = std::move(bounds);
  const std::optional<double> opening = laterOpening(out->report.manifest);
  adding.kept = fieldsThatStay(out->report.manifest, opening);
  Result<FieldAdder> adder = FieldAdder::make(*log, adding);
  if (!adder) return std::unexpected(adder.error());
  if (Status s = addAll(steps, read, options, opening, *adder); !s)
    return std::unexpected(s.error());
  const AddedFields added = adder->take();
  const Result<EditedLog> edited = withFields(*log, added.kept, added.fields);
  if (!edited) return std::unexpected(edited.error());
  PipelineReport& report = out->report;
  std::erase(report.notes, differencesNote(report.index));
  if (Status s = replaceLog(*edited, options, *out); !s) return std::unexpected(s.error());
  countFields(*out);
  if (report.index.hasSeries()) report.notes.push_back(differencesNote(report.index));
  report.notes.push_back(std::to_string(steps) + " instants are coded in windows of " +
                         std::to_string(kWindow) + "; the base mesh is that of " +
                         std::to_string(sampledSteps(steps).size()) + " of them");
  report.notes.insert(report.notes.end(), added.notes.begin(), added.notes.end());
  // those of the sample's instants alone give way to those of all
  const std::vector<std::string> narrower = std::exchange(report.quantise.warnings, {});
  const auto place = std::ranges::search(report.warnings, narrower);
  report.warnings.erase(place.begin(), place.end());
  report.warnings.insert(report.warnings.end(), added.warnings.begin(), added.warnings.end());
  report.seconds.emplace_back(
      Stage::kEncode,
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return out;
}

}  // namespace qtet
