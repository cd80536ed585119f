// Lists of logs (proto/SEGMENT_LIST.md) on disk, and the logs that they name.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "proto/segment_list.h"
#include "simplify/log/opened_log.h"

namespace qtet {

/// Whether a file of this name is a list and not a log.
[[nodiscard]] bool isSegmentList(const std::filesystem::path& path);

/// Reads at most kMaxListBytes. Errors: not-found, io, readSegmentList's with the file's
/// name.
[[nodiscard]] Result<SegmentList> openList(const std::filesystem::path& path);

/// The times of a log's instants, ascending, each once. Empty: its fields hold for all times.
[[nodiscard]] std::vector<double> instantTimes(const Manifest& manifest);

/// Times as the option `time` takes them: "0,0.1,0.2".
[[nodiscard]] std::string timesText(std::span<const double> times);

/// Opens the log of a segment of the list at `list`. Errors: openLog's with the list's name;
/// not-found (there is no such log; it has instants, but not one of the segment's times).
[[nodiscard]] Result<OpenedLog> openSegment(const std::filesystem::path& list,
                                            const Segment& segment);

}  // namespace qtet
