#include "simplify/read/read_times.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "simplify/read/options/time_steps.h"
#include "simplify/read/steps/step_reports.h"

namespace qtet {

Result<ChosenTimes> chosenTimesOf(const std::filesystem::path& path, const ReadOptions& options) {
  ChosenTimes out;
  if (options.time != "all" && options.time.find_first_of(",:") == std::string::npos) return out;
  ReadOptions first = options;
  first.time = "first";
  const Result<ReadMesh> read = readMesh(path, first);
  if (!read) return std::unexpected(read.error());
  const std::vector<double>& times = read->report.times;
  if (times.empty()) return out;
  std::vector<std::string> notes;
  const auto steps = chosenSteps(times, options.time, path, notes);
  if (!steps) return std::unexpected(steps.error());
  for (const std::size_t step : *steps) out.times.push_back(times[step]);
  for (const MeshField& field : read->mesh.fields) out.valuesOfAStep += field.values.size();
  return out;
}

Result<ReadMesh> readTimes(const std::filesystem::path& path, const ReadOptions& options,
                           std::span<const double> times) {
  ReadOptions some = options;
  some.namesTime = true;
  some.time.clear();
  for (const double time : times) some.time += (some.time.empty() ? "" : ",") + timeText(time);
  return readMesh(path, some);
}

Result<ReadMesh> readTimes(const std::filesystem::path& path, const ReadOptions& options,
                           std::span<const double> times, std::size_t atOnce) {
  Result<ReadMesh> out = readTimes(path, options, times.first(std::min(atOnce, times.size())));
  for (std::size_t at = atOnce; out && at < times.size(); at += atOnce) {
    const auto next = times.subspan(at, std::min(atOnce, times.size() - at));
    Result<ReadMesh> more = readTimes(path, options, next);
    if (!more) return more;
    if (more->mesh.points != out->mesh.points || more->mesh.tetrahedra != out->mesh.tetrahedra)
      return fail(ErrorCode::kBadInput, path.string() + ": the mesh at time " +
                                            timeText(next.front()) + " is not that of time " +
                                            timeText(times.front()) +
                                            "; make a log of each step, with `time` " +
                                            timeText(next.front()) + " and so on");
    std::ranges::move(more->mesh.fields, std::back_inserter(out->mesh.fields));
    addNew(more->report.notes, out->report.notes);
  }
  return out;
}

}  // namespace qtet
