#include "simplify/read/parts/file_series.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "simplify/read/text/mesh_scanner.h"

namespace qtet {

void sortByTime(std::vector<SeriesEntry>& entries) {
  std::ranges::sort(entries, [](const SeriesEntry& a, const SeriesEntry& b) {
    return a.time != b.time ? a.time < b.time : a.number < b.number;
  });
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
  sortByTime(entries);
  return entries;
}

}  // namespace qtet
