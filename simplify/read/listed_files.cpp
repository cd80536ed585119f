#include "simplify/read/listed_files.h"

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "proto/number_text.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/parts/file_family.h"
#include "simplify/read/parts/named_files.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/vtu/read_vtu.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<fs::path>;

Files filesLike(const fs::path& pattern) {
  glob_t found{};
  Files out;
  std::error_code code;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i)
      if (!fs::is_directory(found.gl_pathv[i], code)) out.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  sortByNumber(out);
  return out;
}

/// "a.msh, b.txt and 3 more"
std::string shownNames(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 6;
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < kShown; ++i)
    out += (i == 0 ? "" : ", ") + names[i];
  return out +
         (names.size() > kShown ? " and " + std::to_string(names.size() - kShown) + " more" : "");
}

/// The numbered files of a folder that has one name for all of them.
Result<Files> filesIn(const fs::path& folder) {
  std::map<std::string, Files> families;
  std::vector<std::string> others;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const fs::path name = entry.path().filename();
    const MeshFormat format = formatOf(name);
    std::error_code unknown;
    if (entry.is_directory(unknown)) continue;
    if (traitsOf(format).isSeries)
      return badFile(folder,
                     "it has " + name.string() + ", which lists files with their times; give that");
    const auto parts = numberedName(name);
    if (traitsOf(format).mayBeStep)
      families[parts ? parts->before + "*" + parts->behind : name.string()].push_back(entry.path());
    else
      others.push_back(name.string());
  }
  if (code) return fail(ErrorCode::kIo, "cannot read " + folder.string() + ": " + code.message());
  std::ranges::sort(others);
  if (families.empty())
    return badFile(folder,
                   "this folder holds neither numbered files of VTK nor a case of OpenFOAM" +
                       (others.empty() ? "; it has no files" : ", but " + shownNames(others)) +
                       "; give a mesh file");
  if (families.size() > 1) {
    std::vector<std::string> names;
    for (const auto& [name, files] : families)
      names.push_back(name + (files.size() > 1 ? " (" + std::to_string(files.size()) + ")" : ""));
    return badFile(folder, "its files have several names: " + shownNames(names) +
                               "; give those of one, in quotes: '" +
                               (folder / families.begin()->first).string() + "'");
  }
  Files out = std::move(families.begin()->second);
  sortByNumber(out);
  return out;
}

Result<Files> filesOf(const fs::path& path, const ReadOptions& options) {
  if (!options.listed.files.empty()) return options.listed.files;
  std::error_code code;
  if (fs::is_directory(path, code)) return filesIn(path);
  if (!namesFiles(path)) return Files{path};
  Files out = filesLike(path);
  if (out.empty())
    return fail(ErrorCode::kNotFound,
                "there is no file " + path.string() + "; check the pattern and the folder");
  return out;
}

/// Each is there, and all are of one kind that may be a step.
Status checkKinds(const Files& files, const fs::path& path) {
  const MeshFormat kind = formatOf(files.front());
  for (const fs::path& file : files) {
    const MeshFormat format = formatOf(file);
    if (format == MeshFormat::kExodusPieces)
      return badFile(path, file.string() +
                               " is a piece of a parallel result; give it alone, and all others "
                               "are read with it");
    if (!traitsOf(format).mayBeStep)
      return badFile(path, file.string() +
                               " cannot be a step: files of VTK alone can; convert each to .vtu "
                               "with qtet convert");
    if (format != kind)
      return badFile(path, files.front().string() + " and " + file.string() +
                               " are of different kinds; give files of one kind");
    if (Status checked = checkMeshFile(file, format); !checked) return checked;
  }
  return {};
}

/// The finite TimeValue of a .vtu, or of a .pvtu's first piece.
Result<std::optional<double>> timeValueOf(const fs::path& file, const ReadOptions& options) {
  const MeshFormat format = formatOf(file);
  if (format == MeshFormat::kPvtu) {
    const auto pieces = piecesOf(file, format);
    if (!pieces) return std::unexpected(pieces.error());
    if (formatOf(pieces->front().path) != MeshFormat::kVtu) return std::nullopt;
    return timeValueOf(pieces->front().path, options);
  }
  if (format != MeshFormat::kVtu) return std::nullopt;
  const Result<VtuFile> opened = VtuFile::open(file, options.patience);
  if (!opened) return std::unexpected(opened.error());
  const Result<VtuDocument> document = readVtuDocument(*opened);
  if (!document) return std::unexpected(document.error());
  if (document->hasTimeSteps) return std::nullopt;
  auto time = readVtuTime(*opened, *document);
  if (time && *time && !std::isfinite(**time)) time->reset();
  return time;
}

/// The numbers in the names. Refused: digits behind a point, of which nobody knows whether they
/// are a number or a fraction.
Result<std::vector<double>> numbersOf(const Files& files, const fs::path& path) {
  std::vector<double> out;
  std::optional<std::size_t> width;
  for (const fs::path& file : files) {
    const auto name = numberedName(file);
    if (!name)
      return badFile(path, file.string() +
                               " has neither a TimeValue nor a number in its name; give `times`, "
                               "one a file");
    const std::string& before = name->before;
    const bool isFraction = before.size() > 1 && before.ends_with('.') &&
                            std::isdigit(static_cast<unsigned char>(before[before.size() - 2]));
    if (isFraction && width && *width != name->digits.size())
      return badFile(path, file.string() + " may mean the number " + name->digits +
                               " or a fraction; give `times`, one a file");
    width = name->digits.size();
    out.push_back(name->number);
  }
  return out;
}

/// The times that the files themselves say; `note` where that is their names.
Result<std::vector<double>> ownTimes(const Files& files, const fs::path& path,
                                     const ReadOptions& options, std::string& note) {
  std::vector<double> out;
  for (const fs::path& file : files) {
    const auto time = timeValueOf(file, options);
    if (!time) return std::unexpected(time.error());
    if (!*time) {
      note = "times are the numbers in the files' names, since " + file.filename().string() +
             " has no TimeValue; `times` gives others";
      return numbersOf(files, path);
    }
    out.push_back(**time);
  }
  return out;
}

/// Times that are given rise with the files' numbers: the shell puts step_10 before step_2.
Status checkGivenTimes(const Files& files, const std::vector<double>& times, const fs::path& path) {
  if (times.size() != files.size())
    return fail(ErrorCode::kBadValue, path.string() + ": `times` gives " +
                                          std::to_string(times.size()) + " times for " +
                                          std::to_string(files.size()) + " files; give one a file");
  for (std::size_t i = 1; i < files.size(); ++i) {
    const auto a = numberedName(files[i - 1]), b = numberedName(files[i]);
    if (a && b && a->before == b->before && a->behind == b->behind && a->number > b->number &&
        times[i - 1] < times[i])
      return fail(ErrorCode::kBadValue, path.string() + ": " + files[i - 1].string() +
                                            " stands before " + files[i].string() +
                                            ", and `times` gives it the earlier time; give the "
                                            "files' pattern in quotes, which takes them by number");
  }
  return {};
}

/// Times that differ by less than this of them are one.
constexpr double kLastDigits = 4 * std::numeric_limits<double>::epsilon();

/// Sorts by time. Refuses two of one time.
Status sortByTime(ListedFiles& listed, const fs::path& path) {
  std::vector<std::size_t> order(listed.files.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(listed.times[i], i); });
  ListedFiles sorted;
  for (const std::size_t i : order) {
    const double time = listed.times[i];
    if (!sorted.times.empty() && time - sorted.times.back() <= kLastDigits * std::abs(time))
      return badFile(path, sorted.files.back().string() + " and " + listed.files[i].string() +
                               " both have time " + shortestText(time) +
                               "; leave one out, or give `times`, one a file");
    sorted.times.push_back(time);
    sorted.files.push_back(std::move(listed.files[i]));
  }
  listed.files = std::move(sorted.files);
  listed.times = std::move(sorted.times);
  return {};
}

}  // namespace

bool namesFiles(const fs::path& path) {
  std::error_code code;
  const fs::file_type type = fs::status(path, code).type();
  return type == fs::file_type::directory ||
         (type == fs::file_type::not_found &&
          path.string().find_first_of("*?[") != std::string::npos);
}

Result<ReadOptions> withListedFiles(const fs::path& path, const ReadOptions& options) {
  const ListedFiles& given = options.listed;
  if (given.files.empty() && isFoamCase(path)) return options;
  if (given.isChecked || (given.files.empty() && given.times.empty() && !namesFiles(path)))
    return options;
  ReadOptions out = options;
  Result<Files> files = filesOf(path, options);
  if (!files) return std::unexpected(files.error());
  if (Status checked = checkKinds(*files, path); !checked) return std::unexpected(checked.error());
  if (!given.times.empty()) {
    if (Status checked = checkGivenTimes(*files, given.times, path); !checked)
      return std::unexpected(checked.error());
  } else {
    auto times = ownTimes(*files, path, options, out.listed.note);
    if (!times) return std::unexpected(times.error());
    out.listed.times = std::move(*times);
  }
  out.listed.files = std::move(*files);
  if (Status sorted = sortByTime(out.listed, path); !sorted) return std::unexpected(sorted.error());
  out.listed.isChecked = true;
  return out;
}

}  // namespace qtet
