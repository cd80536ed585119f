#include "simplify/read/ensight/ensight_case.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <set>

#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/text/mesh_scanner.h"

namespace qtet {
namespace {

constexpr std::string_view kBlanksOfCase = " \t\r\n";
/// Numbers in files' names have at most so many digits.
constexpr std::int64_t kMaxNumberInName = 2'147'483'647;

struct VariableKind {
  std::string_view key;
  bool isOfElements;
  std::uint32_t components;
};
constexpr std::array<VariableKind, 8> kVariableKinds{{
    {"scalar per node", false, 1},
    {"vector per node", false, 3},
    {"tensor symm per node", false, 6},
    {"tensor asym per node", false, 9},
    {"scalar per element", true, 1},
    {"vector per element", true, 3},
    {"tensor symm per element", true, 6},
    {"tensor asym per element", true, 9},
}};

/// Words between blanks; blanks within double quotes are part of one.
std::vector<std::string> wordsOf(std::string_view text) {
  std::vector<std::string> out;
  for (;;) {
    const std::size_t begin = text.find_first_not_of(kBlanksOfCase);
    if (begin == std::string_view::npos) return out;
    text.remove_prefix(begin);
    const bool isQuoted = text.front() == '"' && text.find('"', 1) != std::string_view::npos;
    const std::size_t end =
        isQuoted ? text.find('"', 1) : std::min(text.find_first_of(kBlanksOfCase), text.size());
    out.emplace_back(text.substr(isQuoted ? 1 : 0, end - (isQuoted ? 1 : 0)));
    text.remove_prefix(end + (isQuoted ? 1 : 0));
  }
}

std::optional<std::int64_t> integerIn(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// In small letters, with one blank between words.
std::string keyOf(std::string_view text) {
  std::string out;
  for (const std::string& word : wordsOf(text)) out += (out.empty() ? "" : " ") + word;
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Takes "[ts] [fs]" off the words, of which `others` remain at least.
EnSightItem setsOf(std::vector<std::string>& words, std::size_t others) {
  EnSightItem out;
  for (std::optional<std::int64_t>* set : {&out.timeSet, &out.fileSet}) {
    if (words.size() <= others) break;
    *set = integerIn(words.front());
    if (!*set) break;
    words.erase(words.begin());
  }
  return out;
}

bool hasWildcard(const EnSightItem& item) { return item.file.contains('*'); }

/// Each run of stars as the number, with zeros in front as far as it is longer.
std::string filled(std::string_view name, std::int64_t number) {
  std::string out;
  for (std::size_t at = 0; at < name.size();) {
    if (name[at] != '*') {
      out += name[at++];
      continue;
    }
    const std::size_t end = std::min(name.find_first_not_of('*', at), name.size());
    const std::string digits = std::to_string(number);
    out.append(end - at - std::min(end - at, digits.size()), '0');
    out += digits;
    at = end;
  }
  return out;
}

/// A time set as the case's lines give it.
struct RawTimeSet {
  std::optional<std::int64_t> steps, start, increment;
  std::vector<std::string> times, numbers;
};

class CaseLines {
 public:
  explicit CaseLines(const std::filesystem::path& path) { out_.path = path; }

  Result<EnSightCase> read(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      if (Status done = take(text.substr(0, end)); !done) return std::unexpected(done.error());
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!hasType_) return bad("it has no line \"type: ensight gold\"");
    if (out_.model.file.empty()) return bad("it names no file of a model");
    for (auto& [id, raw] : raw_)
      if (Status done = addTimeSet(id, raw); !done) return std::unexpected(done.error());
    return std::move(out_);
  }

 private:
  std::unexpected<Error> bad(const std::string& what) const {
    return badFile(out_.path, what + "; export the case again");
  }

  Status take(std::string_view line) {
    const std::size_t begin = line.find_first_not_of(kBlanksOfCase);
    if (begin == std::string_view::npos || line[begin] == '#') return {};
    line = line.substr(begin, line.find_last_not_of(kBlanksOfCase) - begin + 1);
    constexpr std::array<std::string_view, 7> kSections{"FORMAT", "GEOMETRY", "VARIABLE", "TIME",
                                                        "FILE",   "MATERIAL", "SCRIPTS"};
    if (std::ranges::find(kSections, line) != kSections.end()) {
      section_ = line;
      list_ = nullptr;
      return {};
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) {
      if (list_) std::ranges::move(wordsOf(line), std::back_inserter(*list_));
      return {};
    }
    list_ = nullptr;
    const std::string key = keyOf(line.substr(0, colon));
    const std::string_view rest = line.substr(colon + 1);
    if (section_ == "FORMAT") return takeFormat(key, rest);
    if (section_ == "GEOMETRY") return takeGeometry(key, rest);
    if (section_ == "VARIABLE") return takeVariable(key, rest);
    if (section_ == "TIME") return takeTime(key, rest);
    if (section_ == "FILE") return takeFileSet(key, rest);
    return {};
  }

  Status takeFormat(const std::string& key, std::string_view rest) {
    if (key != "type") return {};
    const std::string type = keyOf(rest);
    if (type != "ensight" && type != "ensight gold")
      return bad("its type is \"" + type + "\", but \"ensight\" and \"ensight gold\" are read");
    hasType_ = true;
    out_.isGold = type == "ensight gold";
    return {};
  }

  Status takeGeometry(const std::string& key, std::string_view rest) {
    if (key != "model") return {};
    std::vector<std::string> words = wordsOf(rest);
    out_.model = setsOf(words, 1);
    if (words.empty()) return bad("its model has no file");
    out_.model.file = words.front();
    out_.changesCoordinatesOnly = words.size() > 1 && words[1] == "change_coords_only";
    if (words.size() > 2)
      out_.cellStep =
          static_cast<std::uint64_t>(std::max<std::int64_t>(0, integerIn(words[2]).value_or(0)));
    return {};
  }

  Status takeVariable(const std::string& key, std::string_view rest) {
    std::vector<std::string> words = wordsOf(rest);
    const auto kind = std::ranges::find(kVariableKinds, key, &VariableKind::key);
    if (kind == kVariableKinds.end()) {
      if (!key.starts_with("constant per case"))
        out_.notes.push_back("its variable \"" + std::string(rest.substr(0, kShown)) +
                             "\" was ignored, which is a " + key.substr(0, kShown));
      return {};
    }
    EnSightItem item = setsOf(words, 2);
    if (words.size() < 2)
      return bad("its line \"" + key + ":" + std::string(rest.substr(0, kShown)) +
                 "\" has no name and file");
    item.file = words.back();
    std::string name = words.front();
    for (std::size_t i = 1; i + 1 < words.size(); ++i) name += " " + words[i];
    out_.variables.push_back({name, kind->isOfElements, kind->components, std::move(item)});
    return {};
  }

  Status takeTime(const std::string& key, std::string_view rest) {
    std::vector<std::string> words = wordsOf(rest);
    const std::optional<std::int64_t> first =
        words.empty() ? std::nullopt : integerIn(words.front());
    if (key == "time set") {
      if (!first) return bad("a time set has no number");
      timeSet_ = &raw_[*first];
      return {};
    }
    if (!timeSet_) return bad("its TIME does not begin with a time set");
    if (key == "number of steps") timeSet_->steps = first;
    if (key == "filename start number") timeSet_->start = first;
    if (key == "filename increment") timeSet_->increment = first;
    if (key == "time values file" || key == "filename numbers file")
      return takeListFile(words, key == "time values file" ? timeSet_->times : timeSet_->numbers);
    if (key == "time values") list_ = &timeSet_->times;
    if (key == "filename numbers") list_ = &timeSet_->numbers;
    if (list_) *list_ = std::move(words);
    return {};
  }

  Status takeListFile(const std::vector<std::string>& words, std::vector<std::string>& list) {
    if (words.empty()) return bad("its TIME names a file without a name");
    const std::filesystem::path file = out_.path.parent_path() / words.front();
    if (Status checked = checkMeshFile(file, MeshFormat::kOther); !checked)
      return fail(checked.error().code, out_.path.string() + ": " + checked.error().message);
    const Result<std::string> text = wholeFile(file);
    if (!text) return std::unexpected(text.error());
    list = wordsOf(*text);
    return {};
  }

  Status takeFileSet(const std::string& key, std::string_view rest) {
    const std::vector<std::string> words = wordsOf(rest);
    const std::optional<std::int64_t> first =
        words.empty() ? std::nullopt : integerIn(words.front());
    if (!first || *first < 0)
      return bad("\"" + key.substr(0, kShown) + ":\" of a FILE is no number");
    if (key == "file set") {
      runs_ = &out_.fileSets[*first];
      return {};
    }
    if (!runs_) return bad("its FILE does not begin with a file set");
    if (key == "filename index") index_ = first;
    if (key == "number of steps") {
      runs_->push_back({index_, static_cast<std::uint64_t>(*first)});
      index_.reset();
    }
    return {};
  }

  Status addTimeSet(std::int64_t id, const RawTimeSet& raw) {
    const std::string which = "its time set " + std::to_string(id);
    if (!raw.steps || *raw.steps < 1) return bad(which + " has no number of steps");
    if (static_cast<std::uint64_t>(*raw.steps) > raw.times.size())
      return bad(which + " has " + std::to_string(*raw.steps) + " steps, but " +
                 std::to_string(raw.times.size()) + " time values");
    const auto steps = static_cast<std::size_t>(*raw.steps);
    EnSightTimeSet& set = out_.timeSets[id];
    for (std::size_t i = 0; i < steps; ++i) {
      const std::optional<double> time = timeIn(raw.times[i]);
      if (!time)
        return bad(which + " has the time \"" + raw.times[i].substr(0, kShown) +
                   "\", which is no number");
      set.times.push_back(*time);
    }
    if (!raw.start && raw.numbers.empty()) return {};
    if (!raw.start && raw.numbers.size() < steps)
      return bad(which + " has " + std::to_string(steps) + " steps, but " +
                 std::to_string(raw.numbers.size()) + " filename numbers");
    std::int64_t next = raw.start.value_or(0);
    for (std::size_t i = 0; i < steps; ++i) {
      if (!raw.start) next = integerIn(raw.numbers[i]).value_or(-1);
      if (next < 0 || next > kMaxNumberInName)
        return bad(which + " has a filename number that is none of 0 to " +
                   std::to_string(kMaxNumberInName));
      set.numbers.push_back(next);
      next +=
          std::clamp<std::int64_t>(raw.increment.value_or(1), -kMaxNumberInName, kMaxNumberInName);
    }
    return {};
  }

  static constexpr std::size_t kShown = 60;  ///< characters of a line that an error quotes

  EnSightCase out_;
  std::string_view section_;
  bool hasType_ = false;
  std::map<std::int64_t, RawTimeSet> raw_;
  RawTimeSet* timeSet_ = nullptr;
  std::vector<std::string>* list_ = nullptr;  ///< takes the lines without a key
  std::vector<EnSightFileRun>* runs_ = nullptr;
  std::optional<std::int64_t> index_;
};

/// The item's own set, or the first one where it names none.
const EnSightTimeSet* timeSetOf(const EnSightCase& from, const EnSightItem& item) {
  if (from.timeSets.empty()) return nullptr;
  if (!item.timeSet) return &from.timeSets.begin()->second;
  const auto at = from.timeSets.find(*item.timeSet);
  return at == from.timeSets.end() ? nullptr : &at->second;
}

}  // namespace

std::vector<double> EnSightCase::times() const {
  std::set<double> all;
  for (const auto& [id, set] : timeSets) all.insert(set.times.begin(), set.times.end());
  return {all.begin(), all.end()};
}

std::uint64_t EnSightCase::stepAt(const EnSightItem& item, double time) const {
  const EnSightTimeSet* set = timeSetOf(*this, item);
  std::optional<std::uint64_t> best;
  for (std::uint64_t i = 0; set && i < set->times.size(); ++i)
    if (set->times[i] <= time && (!best || set->times[i] >= set->times[*best])) best = i;
  return best.value_or(0);
}

Result<EnSightPlace> EnSightCase::placeOf(const EnSightItem& item, std::uint64_t step) const {
  const std::filesystem::path folder = path.parent_path();
  const auto without = [&](const std::string& what) {
    return badFile(path, "it does not say which file " + item.file + " has its step " +
                             std::to_string(step) + ", because " + what +
                             "; export the case again");
  };
  if (item.fileSet) {
    const auto set = fileSets.find(*item.fileSet);
    if (set == fileSets.end())
      return without("it has no file set " + std::to_string(*item.fileSet));
    for (const EnSightFileRun& run : set->second) {
      if (step >= run.steps) {
        step -= run.steps;
        continue;
      }
      if (run.index) return EnSightPlace{folder / filled(item.file, *run.index), step};
      if (hasWildcard(item)) return without("its file set has no filename index");
      return EnSightPlace{folder / item.file, step};
    }
    return without("its file set ends before");
  }
  if (!hasWildcard(item)) return EnSightPlace{folder / item.file, step};
  const EnSightTimeSet* set = timeSetOf(*this, item);
  if (!set || step >= set->numbers.size()) return without("no time set has its filename number");
  return EnSightPlace{folder / filled(item.file, set->numbers[step]), 0};
}

Result<EnSightCase> readEnSightCase(const std::filesystem::path& path) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  return CaseLines(path).read(*text);
}

}  // namespace qtet
