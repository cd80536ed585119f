// Running VTK's readers: their errors and warnings as values, their time steps and blocks.
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// The meshes that VTK makes of the file, unchecked beyond what VTK itself checks. Damage may crash
/// a reader (read_apart.h). Errors: bad-input with VTK's first error, or that this program was
/// built without VTK; those of cellsOf. Not thread-safe: VTK's message window is global. Leaves
/// VTK's logging to stderr switched off.
[[nodiscard]] Result<std::vector<TimedCells>> runVtk(const std::filesystem::path& path,
                                                     MeshFormat format, const ReadOptions& options,
                                                     ReadReport& report);

}  // namespace qtet
