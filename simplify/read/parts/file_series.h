// ParaView's lists of files, one a time step: NAME.vtu.series.
#pragma once

#include <filesystem>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// One file of a series.
struct SeriesEntry {
  double time = 0;
  int number = 0;  ///< its place in the list
  std::filesystem::path file;
};

/// The entries by time, and of one time in the list's order.
void sortByTime(std::vector<SeriesEntry>& entries);

/// The files of ParaView's JSON, relative to it, by time. Errors: io, bad-input (no such JSON; a
/// file without a name or a finite time).
[[nodiscard]] Result<std::vector<SeriesEntry>> entriesOfJson(const std::filesystem::path& path);

}  // namespace qtet
