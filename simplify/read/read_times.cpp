#include "simplify/read/read_times.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "proto/field_key.h"
#include "proto/number_text.h"
#include "simplify/read/options/select_fields.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/series_notes.h"

namespace qtet {

Result<ChosenTimes> chosenTimesOf(const std::filesystem::path& path, const ReadOptions& options) {
  ChosenTimes out;
  if (options.time != "all" && options.time.find_first_of(",:") == std::string::npos) return out;
  if (options.threshold) return out;
  ReadOptions first = options;
  // all chosen steps have the same cells, so the first time of the list is read for all of them
  first.time = options.time.contains(',') && !options.time.contains(':')
                   ? options.time.substr(0, options.time.find(','))
                   : "first";
  first.fields.reset();
  const Result<ReadMesh> read = readMesh(path, first);
  if (!read) return std::unexpected(read.error());
  const std::vector<double>& times = read->report.times;
  if (times.empty()) return out;
  const std::vector<MeshField>& all = read->mesh.fields;
  // a field of some steps only, as one named with its time, or displacements
  for (const std::string& name : options.fields.value_or(std::vector<std::string>{}))
    if (fieldsOfKey(all, name).empty()) return out;
  std::vector<std::string> notes;
  const auto steps = chosenSteps(times, options.time, path, notes);
  if (!steps) return std::unexpected(steps.error());
  for (const std::size_t step : *steps) out.times.push_back(times[step]);
  for (const MeshField& field : all)
    if (isMeant(options.fields, field.association, field.name))
      out.valuesOfAStep += field.values.size();
  if (all.empty()) out.valuesOfAStep = 3 * read->mesh.points.size();  // if the points move
  return out;
}

Result<ReadMesh> readTimes(const std::filesystem::path& path, const ReadOptions& options,
                           std::span<const double> times, std::optional<double> rest) {
  ReadOptions some = options;
  some.namesTime = true;
  const bool isOneMore = rest && std::ranges::find(times, *rest) == times.end();
  some.time = isOneMore ? shortestText(*rest) : "";
  for (const double time : times) some.time += (some.time.empty() ? "" : ",") + shortestText(time);
  Result<ReadMesh> out = readMesh(path, some);
  if (out && isOneMore)
    std::erase_if(out->mesh.fields, [&](const MeshField& field) {
      const auto name = field.name.instant();
      return name && name->time == *rest;
    });
  return out;
}

Result<TetMesh> readWindow(const std::filesystem::path& path, const ReadOptions& options,
                           std::span<const double> times, double rest, ReadReport& report) {
  ReadOptions some = options;
  if (!some.apartBlocks) some.apartBlocks = report.apartBlocks;
  if (!some.joinsOwnPoints) some.joinsOwnPoints = report.ownPointsJoined;
  Result<ReadMesh> window = readTimes(path, some, times, rest);
  if (!window) return std::unexpected(window.error());
  if (report.series.times.empty()) {
    report = std::move(window->report);
  } else {
    if (Status known = checkWindow(window->report.series, path, report.series); !known)
      return std::unexpected(known.error());
    if (Status added = addWindow(std::move(window->report), path, report); !added)
      return std::unexpected(added.error());
  }
  setTypes(report.series, window->mesh.fields);
  return std::move(window->mesh);
}

Result<ReadMesh> readTimesInParts(const std::filesystem::path& path, const ReadOptions& options,
                                  std::span<const double> times, std::size_t atOnce) {
  const auto part = [&](std::size_t at) {
    return times.subspan(at, std::min(atOnce, times.size() - at));
  };
  Result<ReadMesh> out = readTimes(path, options, part(0));
  for (std::size_t at = atOnce; out && at < times.size(); at += atOnce) {
    const bool moves = !out->report.motion.empty();
    ReadOptions ofPart = options;
    ofPart.moves = moves;
    if (!ofPart.apartBlocks) ofPart.apartBlocks = out->report.apartBlocks;
    if (!ofPart.joinsOwnPoints) ofPart.joinsOwnPoints = out->report.ownPointsJoined;
    Result<ReadMesh> more =
        readTimes(path, ofPart, part(at), moves ? std::optional(times.front()) : std::nullopt);
    if (!more) return more;
    eraseLabelFields(more->report, more->mesh.fields);  // those of the first part stand for all
    if (more->mesh.points != out->mesh.points || more->mesh.tetrahedra != out->mesh.tetrahedra ||
        (!moves && !more->report.motion.empty()))
      return readTimes(path, options, times);
    std::ranges::move(more->mesh.fields, std::back_inserter(out->mesh.fields));
    if (Status added = addWindow(std::move(more->report), path, out->report); !added)
      return std::unexpected(added.error());
  }
  if (out) setTypes(out->report.series, out->mesh.fields);
  return out;
}

}  // namespace qtet
