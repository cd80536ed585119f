// Checks a mesh of OpenFOAM before VTK reads it. VTK takes lists that contradict each other, and
// makes other cells of them or none.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "proto/error.h"
#include "simplify/read/options/read_options.h"

namespace qtet {

/// Checks each mesh of the case in `folder`: those of constant/, of constant/REGION/ and of times,
/// also compressed. Its lists must have as many things as they say and fit together, and each
/// cell's faces must close. Returns the number of cells if the case has one mesh. Errors: not-found
/// (no mesh, a file), bad-input (the file and the line, or the cell), truncated, io.
/// `patience` holds for each file (FoamList::open).
[[nodiscard]] Result<std::optional<std::uint64_t>> checkPolyMeshes(
    const std::filesystem::path& folder, std::chrono::seconds patience = kReadPatience);

}  // namespace qtet
