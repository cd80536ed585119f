#include "simplify/read/parts/file_series.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "proto/series.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/text/mesh_scanner.h"

namespace qtet {

namespace {

/// How near two times of the list are one: the last digits of a double, or more where the steps are
/// long.
class NearTimes {
 public:
  explicit NearTimes(std::span<const SeriesEntry> sorted)
      : near_(kShareOfStep * (sorted.back().time - sorted.front().time) /
              static_cast<double>(std::max<std::size_t>(2, sorted.size()) - 1)) {}

  [[nodiscard]] bool areOne(double a, double b) const {
    constexpr double kLastDigits = 4 * std::numeric_limits<double>::epsilon();
    const double larger = std::max(std::abs(a), std::abs(b));
    return isSameTime(a, b) && std::abs(a - b) <= std::max(kLastDigits * larger, near_);
  }

 private:
  static constexpr double kShareOfStep = 1e-3;
  double near_;
};

/// The last of each part among the entries of one time, by their places in the list. Empty: parts
/// are listed unequally often, so it is unknown which belong together.
std::vector<SeriesEntry> lastOfEachPart(std::span<const SeriesEntry> entries) {
  std::map<std::string_view, std::vector<const SeriesEntry*>> parts;
  for (const SeriesEntry& entry : entries) parts[entry.part].push_back(&entry);
  std::vector<SeriesEntry> out;
  for (const auto& [part, listed] : parts) {
    if (listed.size() != parts.begin()->second.size()) return {};
    out.push_back(**std::ranges::max_element(listed, {}, &SeriesEntry::number));
  }
  std::ranges::sort(out, {}, &SeriesEntry::number);
  return out;
}

}  // namespace

Result<std::vector<SeriesStep>> stepsOfSeries(std::vector<SeriesEntry> entries,
                                              const std::filesystem::path& path,
                                              std::vector<std::string>& notes) {
  assert(!entries.empty());
  std::ranges::sort(entries, [](const SeriesEntry& a, const SeriesEntry& b) {
    return a.time != b.time ? a.time < b.time : a.number < b.number;
  });
  const NearTimes near(entries);
  std::vector<SeriesStep> out;
  std::vector<double> repeated;
  std::size_t leftOut = 0;
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    while (end < entries.size() && near.areOne(entries[begin].time, entries[end].time)) ++end;
    const auto ofOne = std::span(entries).subspan(begin, end - begin);
    const std::vector<SeriesEntry> kept = lastOfEachPart(ofOne);
    if (kept.empty())
      return badFile(path, "its parts of time " + shortestText(ofOne.front().time) +
                               " are listed unequally often, so it is unknown which belong "
                               "together; take those of older runs out of the list");
    SeriesStep& step = out.emplace_back(kept.back().time);
    for (const SeriesEntry& entry : kept) step.files.push_back(entry.file);
    if (kept.size() == ofOne.size()) continue;
    leftOut += ofOne.size() - kept.size();
    repeated.push_back(step.time);
  }
  if (leftOut > 0)
    notes.push_back("data sets left out, because later ones in the list have the same time: " +
                    std::to_string(leftOut) + ", at time " + shownTimes(repeated));
  return out;
}

Result<std::vector<SeriesEntry>> entriesOfJson(const std::filesystem::path& path) {
  const auto bad = [&](const std::string& what) {
    return fail(ErrorCode::kBadInput, path.string() + ": " + what + "; save the series again");
  };
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  const nlohmann::json series = nlohmann::json::parse(*text, nullptr, false);
  if (!series.is_object() || !series.contains("file-series-version"))
    return bad("it is no JSON with a file-series-version, as ParaView's lists of files are");
  const auto files = series.find("files");
  if (files == series.end() || !files->is_array() || files->empty())
    return bad("its list of files is empty");
  std::vector<SeriesEntry> entries;
  for (const nlohmann::json& file : *files) {
    const int number = static_cast<int>(entries.size());
    const auto name = file.is_object() ? file.find("name") : file.end();
    const auto time = file.is_object() ? file.find("time") : file.end();
    if (name == file.end() || !name->is_string() || time == file.end() || !time->is_number() ||
        !std::isfinite(time->get<double>()))
      return bad("its file number " + std::to_string(number) + " has no name or no time");
    entries.push_back({time->get<double>(), number, path.parent_path() / name->get<std::string>()});
  }
  return entries;
}

}  // namespace qtet
