// One report on the steps of a series, also where they are read a few at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Adds the instants, called NAME@TIME, to those of `series`. An integer that no double holds does
/// not count; such a field is left out later. Errors: bad-input (a field whose number of components
/// is not the same at all steps).
[[nodiscard]] Status addInstants(const std::vector<MeshField>& fields,
                                 const std::filesystem::path& path, SeriesReport& series);

/// Gives each instant the type that `series` has for its field.
void setTypes(const SeriesReport& series, std::vector<MeshField>& fields);

/// Fields that some steps miss, types that differ, steps in another order, points that move.
[[nodiscard]] std::vector<std::string> seriesNotes(const SeriesReport& series);

/// Adds the report on a window of steps more. The notes on the series are then those on all steps.
/// Errors: as addInstants's.
[[nodiscard]] Status addWindow(ReadReport&& window, const std::filesystem::path& path,
                               ReadReport& report);

/// Refuses a window whose values the types of `known` do not hold, or whose points are the first to
/// move. Windows that are coded already cannot change. Errors: bad-input.
[[nodiscard]] Status checkWindow(const SeriesReport& window, const std::filesystem::path& path,
                                 const SeriesReport& known);

}  // namespace qtet
