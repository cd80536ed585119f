// `qtet extract --time`: the instants of a log's series as fields of one name, a file an instant.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/error.h"
#include "proto/manifest.h"

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

/// A file for each time that `asked` means (chosenSteps) of the series among `wanted`, ascending
/// numbers. It has the series' instants of that time, under the series' names, and the fields
/// without time. Where a name is taken, the instant keeps its own. Errors: chosenSteps's.
[[nodiscard]] Result<std::vector<InstantFile>> instantFiles(
    const std::vector<ManifestField>& fields, const std::vector<std::uint32_t>& wanted,
    const std::string& asked, const std::filesystem::path& log);

/// A ParaView collection (.pvd) of files by time.
[[nodiscard]] std::string collectionText(
    const std::vector<std::pair<std::optional<double>, std::string>>& timesAndFiles);

}  // namespace qtet
