// Lists of files, one or several a time step: ParaView's NAME.vtu.series, and VTK's .pvd.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// One file of a series.
struct SeriesEntry {
  double time = 0;
  int number = 0;  ///< its place in the list
  std::filesystem::path file;
  std::string part{};  ///< which part of the time's mesh it is
};

/// The files of one time, which are parts of one mesh.
struct SeriesStep {
  double time = 0;
  std::vector<std::filesystem::path> files;
};

/// The steps by time, their files in the list's order. A program that runs again from an earlier
/// time appends to its list. So the last entry of one time and part counts alone, and a note says
/// so. Times are the same where their last digits alone differ (isSameTime), by less than a
/// thousandth of the mean step. Errors: bad-input (a time whose parts are listed unequally often).
/// REQUIRES: `entries` in the list's order, one at least; finite times.
[[nodiscard]] Result<std::vector<SeriesStep>> stepsOfSeries(std::vector<SeriesEntry> entries,
                                                            const std::filesystem::path& path,
                                                            std::vector<std::string>& notes);

/// The files of ParaView's JSON, relative to it, in its order. Errors: io, bad-input (no such JSON;
/// a file without a name or a finite time).
[[nodiscard]] Result<std::vector<SeriesEntry>> entriesOfJson(const std::filesystem::path& path);

}  // namespace qtet
