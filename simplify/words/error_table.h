// The levels of a log as a table for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "proto/manifest.h"

namespace qtet {

/// A line a level with its counts and bytes (`levels` as levelsJson gives them) and, where the
/// manifest has them, its errors in per cent. `most`: of more levels only so many are shown. These
/// are the first, the last and those whose counts of cells are evenly apart on a scale of ratios.
/// Fields beyond `mostFields` are not shown. Those for which a line of kLineColumns has no room
/// follow in tables of their own.
[[nodiscard]] std::string levelTable(const Manifest& manifest, const nlohmann::ordered_json& levels,
                                     std::size_t most, std::size_t mostFields);

/// 100 * fraction with three significant digits, for a column: "12.3", "0.0456", "7.8e-05", "0".
[[nodiscard]] std::string percentCell(double fraction);

}  // namespace qtet
