#include "simplify/commands/extract_times.h"

#include <algorithm>
#include <map>
#include <span>

#include "codec/files/file_names.h"
#include "proto/series.h"
#include "simplify/read/options/time_steps.h"

namespace qtet {
namespace {

/// Time and series' name of those among `wanted` that are instants.
std::map<std::uint32_t, std::pair<double, std::string>> instantsOf(
    const std::vector<ManifestField>& fields, const std::vector<std::uint32_t>& wanted) {
  std::map<std::uint32_t, std::pair<double, std::string>> out;
  for (const Series& series : seriesOf(std::span(fields)))
    for (std::size_t i = 0; i < series.fields.size(); ++i)
      if (std::ranges::binary_search(wanted, series.fields[i]))
        out[static_cast<std::uint32_t>(series.fields[i])] = {series.times[i], series.name};
  return out;
}

}  // namespace

Result<std::vector<InstantFile>> instantFiles(const std::vector<ManifestField>& fields,
                                              const std::vector<std::uint32_t>& wanted,
                                              const std::string& asked,
                                              const std::filesystem::path& log) {
  const auto instants = instantsOf(fields, wanted);
  std::vector<double> times;
  for (const auto& [field, instant] : instants) times.push_back(instant.first);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<std::string> notes;  // "last" was asked for
  const Result<std::vector<std::size_t>> steps = chosenSteps(times, asked, log, notes);
  if (!steps) return std::unexpected(steps.error());

  const auto isTaken = [&](const std::string& name, const std::string& association) {
    return std::ranges::any_of(wanted, [&](std::uint32_t f) {
      return !instants.contains(f) && fields[f].name == name &&
             fields[f].association == association;
    });
  };
  const auto fileAt = [&](std::optional<double> time) {
    InstantFile out{time, {}};
    for (const std::uint32_t f : wanted) {
      const auto instant = instants.find(f);
      if (instant == instants.end()) {
        out.fields.push_back({f, fields[f].name, false});
      } else if (instant->second.first == time) {
        const std::string& series = instant->second.second;
        out.fields.push_back(
            {f, isTaken(series, fields[f].association) ? fields[f].name : series, true});
      }
    }
    return out;
  };
  std::vector<InstantFile> out;
  for (const std::size_t step : *steps) out.push_back(fileAt(times[step]));
  if (times.empty()) out.push_back(fileAt(std::nullopt));
  return out;
}

std::string collectionText(
    const std::vector<std::pair<std::optional<double>, std::string>>& timesAndFiles) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const auto& [time, file] : timesAndFiles)
    out += "    <DataSet timestep=\"" + timeText(time.value_or(0)) + "\" file=\"" + xmlText(file) +
           "\"/>\n";
  return out + "  </Collection>\n</VTKFile>\n";
}

}  // namespace qtet
