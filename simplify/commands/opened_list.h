// Lists of logs (proto/SERIES_LIST.md) on disk, and the logs that they name.
#pragma once

#include <filesystem>

#include "proto/series_list.h"
#include "simplify/log/opened_log.h"

namespace qtet {

/// Whether a file of this name is a list and not a log.
[[nodiscard]] bool isSeriesList(const std::filesystem::path& path);

/// Reads at most kMaxSeriesListBytes. Errors: not-found, io, parseSeriesList's with the file's
/// name.
[[nodiscard]] Result<SeriesList> openList(const std::filesystem::path& path);

/// Opens the log of a segment of the list at `list`. Errors: openLog's with the list's name;
/// not-found (there is no such log; it has instants, but not one of the segment's times).
[[nodiscard]] Result<OpenedLog> openSegment(const std::filesystem::path& list,
                                            const Segment& segment);

}  // namespace qtet
