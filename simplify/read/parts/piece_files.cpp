#include "simplify/read/parts/piece_files.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>
#include <system_error>

#include "simplify/read/options/time_text.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// The number that the whole text is; none: it is no such number.
bool isNumber(std::string_view text, std::uint64_t& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && read.ec == std::errc{} && read.ptr == text.data() + text.size();
}

std::string_view withoutDot(const std::string& ending) {
  return std::string_view(ending).substr(ending.empty() ? 0 : 1);
}

/// Folders of an OpenFOAM case that are called by a time.
std::set<std::string> timesIn(const fs::path& folder) {
  std::set<std::string> out;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    if (plainTime(name) && entry.is_directory(code)) out.insert(name);
  }
  return out;
}

bool isThere(const fs::path& path) {
  std::error_code code;
  return fs::exists(path, code);
}

/// Whether the case has a mesh of its own, or one of a region.
bool hasMesh(const fs::path& folder) {
  const fs::path constant = folder / "constant";
  if (isThere(constant / "polyMesh")) return true;
  std::error_code code;
  for (const fs::directory_entry& region : fs::directory_iterator(constant, code))
    if (isThere(region.path() / "polyMesh")) return true;
  return false;
}

/// The numbers of the processor folders, and whether there are folders of several processes each.
struct Processors {
  std::set<std::uint64_t> numbers;
  bool isCollated = false;
};

Processors processorsIn(const fs::path& folder) {
  constexpr std::string_view kName = "processor";
  Processors out;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    std::uint64_t number = 0;
    if (!name.starts_with(kName) || !entry.is_directory(code)) continue;
    if (isNumber(std::string_view(name).substr(kName.size()), number))
      out.numbers.insert(number);
    else if (name.starts_with("processors"))
      out.isCollated = true;
  }
  return out;
}

/// Whether the processors' folders hold what the case itself does not.
bool haveMore(const fs::path& folder, const fs::path& first) {
  const std::set<std::string> whole = timesIn(folder), parts = timesIn(first);
  return !hasMesh(folder) || !std::ranges::includes(whole, parts);
}

}  // namespace

Result<std::vector<fs::path>> exodusPieces(const fs::path& path) {
  const std::string piece = path.extension().string(), count = path.stem().extension().string();
  std::uint64_t number = 0, pieces = 0;
  if (!isNumber(withoutDot(piece), number) || !isNumber(withoutDot(count), pieces) ||
      number >= pieces || pieces > kMaxPieceFiles)
    return fail(ErrorCode::kBadInput,
                path.string() +
                    " is no piece of a parallel Exodus result, which are called "
                    "NAME.e.N.M with M from 0 to N - 1; rename it");
  std::vector<fs::path> out;
  for (std::uint64_t i = 0; i < pieces; ++i) {
    std::string digits = std::to_string(i);
    if (digits.size() < piece.size() - 1) digits.insert(0, piece.size() - 1 - digits.size(), '0');
    out.push_back(path.parent_path() / (path.stem().string() + "." + digits));
    if (!isThere(out.back()))
      return fail(ErrorCode::kNotFound, path.string() + " is one of " + std::to_string(pieces) +
                                            " pieces, of which " + out.back().string() +
                                            " is missing; put all of them into one folder");
  }
  return out;
}

bool isFoamCase(const fs::path& folder) {
  const auto [numbers, isCollated] = processorsIn(folder);
  return !numbers.empty() || isCollated || hasMesh(folder);
}

Result<std::vector<fs::path>> processorFolders(const fs::path& marker) {
  const fs::path folder = marker.parent_path().empty() ? fs::path(".") : marker.parent_path();
  const auto [numbers, isCollated] = processorsIn(folder);
  std::vector<fs::path> out;
  if (isCollated && numbers.empty() && !hasMesh(folder))
    return fail(ErrorCode::kBadInput,
                marker.string() +
                    ": its processes have written into one folder (collated), which "
                    "is not read; run reconstructPar, or foamFormatConvert "
                    "-fileHandler uncollated");
  if (numbers.empty() ||
      !haveMore(folder, folder / ("processor" + std::to_string(*numbers.begin()))))
    return out;
  for (std::uint64_t i = 0; i <= *numbers.rbegin(); ++i) {
    out.push_back(folder / ("processor" + std::to_string(i)));
    if (!numbers.contains(i))
      return fail(ErrorCode::kNotFound, marker.string() + ": " + out.back().string() +
                                            " is missing; copy all processor folders");
  }
  return out;
}

}  // namespace qtet
