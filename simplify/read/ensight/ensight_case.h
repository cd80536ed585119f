// The case file of EnSight, which names the files of a result and says which step stands where
// (EnSight User Manual, "EnSight Case Gold" and "EnSight6 Case" file formats).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// A file, or with a wildcard one of each step, that a line of the case names.
struct EnSightItem {
  std::optional<std::int64_t> timeSet, fileSet;
  std::string file;  ///< as the case names it; stars stand for a number
};

struct EnSightVariable {
  std::string name;
  bool isOfElements = false;
  std::uint32_t components = 1;  ///< 1, 3, 6 (symmetric tensors) or 9
  EnSightItem item;
};

/// As many times as steps, finite, in the order of the file.
struct EnSightTimeSet {
  std::vector<double> times;
  std::vector<std::int64_t> numbers;  ///< in the files' names; empty: none
};

/// Files of several steps, one after the other. `index` fills their name's wildcard.
struct EnSightFileRun {
  std::optional<std::int64_t> index;
  std::uint64_t steps = 0;
};

/// A file and the number of the step in it, if it holds several.
struct EnSightPlace {
  std::filesystem::path file;
  std::uint64_t step = 0;
};

struct EnSightCase {
  std::filesystem::path path;
  bool isGold = false;  ///< otherwise EnSight 6
  EnSightItem model;
  /// The cells are those of the step `cellStep`; the others have new coordinates alone.
  bool changesCoordinatesOnly = false;
  std::uint64_t cellStep = 0;
  std::vector<EnSightVariable> variables;  ///< of nodes and elements
  std::map<std::int64_t, EnSightTimeSet> timeSets;
  std::map<std::int64_t, std::vector<EnSightFileRun>> fileSets;
  std::vector<std::string> notes;  ///< what was left out

  /// Those of all time sets, ascending; empty: the case knows no times.
  [[nodiscard]] std::vector<double> times() const;
  /// The number of the item's last step that is not later than `time`, or of its first.
  [[nodiscard]] std::uint64_t stepAt(const EnSightItem& item, double time) const;
  /// Errors: bad-input (the case does not say which file has the step).
  [[nodiscard]] Result<EnSightPlace> placeOf(const EnSightItem& item, std::uint64_t step) const;
};

/// Errors: io; not-found, io (a file of times that it names); bad-input (no case of EnSight 6 or
/// Gold; no model; a time set with fewer times than steps, or whose times are no numbers).
[[nodiscard]] Result<EnSightCase> readEnSightCase(const std::filesystem::path& path);

}  // namespace qtet
