// Cases of OpenFOAM, in one folder or in one of each processor. VTK reads the cells.
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// The case whose marker is at `path`. Errors: those of readApart and runVtk; bad-input (VTK found
/// other cells than the mesh's files have), not-found (a processor's folder is missing).
[[nodiscard]] Result<std::vector<TimedCells>> readFoam(const std::filesystem::path& path,
                                                       const ReadOptions& options,
                                                       ReadReport& report);

}  // namespace qtet
