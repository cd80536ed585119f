// Finds the runs of steps with the same cells in a series whose cells change.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "simplify/read/read_mesh.h"

namespace qtet {

/// The times of the steps that `options.time` means, ascending. Each maximal run of consecutive
/// steps with the same cells and number of points (haveSameCells) has a list of its own. Cells and
/// points may stand in another order (StepOrder). Empty if the file has no times, or if its reader
/// takes all steps at once. Reads each of these steps without its fields, and holds two of them.
/// `progress` receives the fraction that is done, 0 to 1. `notes` receives those of chosenSteps.
/// Errors: readMesh's, chosenSteps's.
[[nodiscard]] Result<std::vector<std::vector<double>>> segmentTimes(
    const std::filesystem::path& path, const ReadOptions& options,
    const std::function<void(double)>& progress, std::vector<std::string>& notes);

}  // namespace qtet
