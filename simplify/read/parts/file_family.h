// Numbers in the names of files: step_9.vtu comes before step_10.vtu.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace qtet {

/// A file's name around its number, the last group of digits before the ending.
struct NumberedName {
  std::string before, digits, behind;  ///< `behind` with the ending
  double number = 0;
};

/// nullopt: the name has no digit before its ending.
[[nodiscard]] std::optional<NumberedName> numberedName(const std::filesystem::path& file);

/// By their numbers; those without come last, by name.
void sortByNumber(std::vector<std::filesystem::path>& files);

/// One text for all files: what their names begin and end with, and a star between. Digits at the
/// star go into it. REQUIRES: one file at least.
[[nodiscard]] std::string familyOf(std::span<const std::filesystem::path> files);

}  // namespace qtet
