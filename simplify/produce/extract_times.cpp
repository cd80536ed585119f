#include "simplify/produce/extract_times.h"

#include "codec/files/file_names.h"
#include "proto/number_text.h"
#include "proto/series.h"
#include "simplify/read/options/time_steps.h"

namespace qtet {
Result<std::vector<InstantFile>> instantFiles(const Instants& instants, const std::string& asked,
                                              const std::filesystem::path& log,
                                              std::vector<std::string>& notes) {
  const std::vector<double>& times = instants.times();
  const Result<std::vector<std::size_t>> steps = chosenSteps(times, asked, log, notes);
  if (!steps) return std::unexpected(steps.error());
  std::vector<InstantFile> out;
  for (const std::size_t step : *steps) out.push_back(instants.fileAt(times[step]));
  if (times.empty()) out.push_back(instants.fileAt(std::nullopt));
  return out;
}

std::vector<InstantFile> segmentFiles(const Instants& instants, const std::vector<double>& times) {
  std::vector<InstantFile> out;
  for (const double time : times) {
    const auto found = placeOfTime(instants.times(), time);
    out.push_back(
        instants.fileAt(found ? std::optional<double>(instants.times()[*found]) : std::nullopt));
    out.back().time = time;
  }
  return out;
}

std::string collectionText(
    const std::vector<std::pair<std::optional<double>, std::string>>& timesAndFiles) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const auto& [time, file] : timesAndFiles)
    out += "    <DataSet timestep=\"" + shortestText(time.value_or(0)) + "\" file=\"" +
           xmlText(file) + "\"/>\n";
  return out + "  </Collection>\n</VTKFile>\n";
}

}  // namespace qtet
