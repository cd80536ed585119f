// The fields of one instant of a log's series, and their names in an ordinary file. `qtet extract
// --time` and a server's levels choose by this alone.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/manifest.h"
#include "proto/series.h"

namespace qtet {

/// A field of the log, and its name in a file.
struct FieldInFile {
  std::uint32_t number = 0;
  std::string name;
  bool isInstant = false;  ///< in no other file
};

/// The fields of one file, by number.
struct InstantFile {
  std::optional<double> time{};  ///< nullopt: the log has no series
  std::vector<FieldInFile> fields;
};

/// The instants of the series among some fields of a log.
class Instants {
 public:
  /// `wanted`: ascending numbers of `fields`, which outlive the object, as `wanted` does. `series`
  /// are those of all the fields.
  Instants(const std::vector<ManifestField>& fields, const std::vector<std::uint32_t>& wanted,
           std::span<const Series> series);

  /// Ascending, each once.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// The instants of exactly this time under their series' names, and the fields without time.
  /// Where a name is taken, the instant keeps its own.
  [[nodiscard]] InstantFile fileAt(std::optional<double> time) const;

 private:
  const std::vector<ManifestField>& fields_;
  const std::vector<std::uint32_t>& wanted_;
  std::map<std::uint32_t, std::pair<double, std::string>> instants_;  // time and series' name
  std::set<std::pair<std::string_view, std::string_view>> taken_;     // name, association of others
  std::vector<double> times_;
};

}  // namespace qtet
