// `qtet extract --time`: the instants of a log's series as fields of one name, a file an instant.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/error.h"
#include "proto/instants.h"
#include "proto/manifest.h"

namespace qtet {

/// A file for each time that `asked` means (chosenSteps). Its fields are those of
/// Instants::fileAt. Errors and notes: chosenSteps's.
[[nodiscard]] Result<std::vector<InstantFile>> instantFiles(const Instants& instants,
                                                            const std::string& asked,
                                                            const std::filesystem::path& log,
                                                            std::vector<std::string>& notes);

/// The same of a segment of a list, for each of some of its times. An instant of the log is that of
/// a time as placeOfTime says.
[[nodiscard]] std::vector<InstantFile> segmentFiles(const Instants& instants,
                                                    const std::vector<double>& times);

/// A ParaView collection (.pvd) of files by time.
[[nodiscard]] std::string collectionText(
    const std::vector<std::pair<std::optional<double>, std::string>>& timesAndFiles);

}  // namespace qtet
