// Cases of OpenFOAM, in one folder or in one of each processor, with their times and regions.
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// The case in whose folder `path` lies, which need not be there. Errors: those of readPolyMesh and
/// addFoamFields; not-found (a processor's folder is missing; no mesh; no such time), bad-input
/// (processors with different times).
[[nodiscard]] Result<std::vector<TimedCells>> readFoam(const std::filesystem::path& path,
                                                       const ReadOptions& options,
                                                       ReadReport& report);

}  // namespace qtet
