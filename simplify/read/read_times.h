// Series whose steps are read a few at a time: each step holds a whole mesh while it is read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "simplify/read/read_mesh.h"

namespace qtet {

/// The steps of a file that the options mean.
struct ChosenTimes {
  std::vector<double> times;      ///< ascending
  std::size_t valuesOfAStep = 0;  ///< numbers in all fields of one step
};

/// Empty if `options.time` means one step, and for formats whose reader takes all steps at once.
/// Also empty with a threshold, and if a field is asked for that the step read does not have: such
/// steps are read together. Reads one step: the first of times between commas, else the file's
/// first one. Errors: readMesh's.
[[nodiscard]] Result<ChosenTimes> chosenTimesOf(const std::filesystem::path& path,
                                                const ReadOptions& options);

/// Reads the steps at these times as one mesh, whose fields are called NAME@TIME. Where points
/// move, the mesh is that of the step at `rest`, else of the first one. Errors: readMesh's.
[[nodiscard]] Result<ReadMesh> readTimes(const std::filesystem::path& path,
                                         const ReadOptions& options, std::span<const double> times,
                                         std::optional<double> rest = std::nullopt);

/// The same for the next window of a long series, whose earlier windows are coded already. `report`
/// is on all windows so far, empty before the first. Instants have the types that it knows. Errors:
/// readMesh's, checkWindow's, addWindow's.
[[nodiscard]] Result<TetMesh> readWindow(const std::filesystem::path& path,
                                         const ReadOptions& options, std::span<const double> times,
                                         double rest, ReadReport& report);

/// As readTimes, `atOnce` steps at a time, or all at once where points begin to move behind the
/// first so many. The first step is that of rest. REQUIRES: one time at least.
[[nodiscard]] Result<ReadMesh> readTimesInParts(const std::filesystem::path& path,
                                                const ReadOptions& options,
                                                std::span<const double> times, std::size_t atOnce);

}  // namespace qtet
