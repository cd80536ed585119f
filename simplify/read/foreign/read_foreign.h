// Steps of files that libraries of Python read (foreign_file.h).
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/foreign/foreign_file.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// As readSteps (read_steps.h). Errors: those of ForeignFile and of readVtu.
[[nodiscard]] Result<std::vector<TimedCells>> readForeign(const ForeignInput& input,
                                                          const ReadOptions& options,
                                                          ReadReport& report);

/// The same through VTK, or where that is not installed and meshio can, through meshio.
/// REQUIRES: a format that VTK reads.
[[nodiscard]] Result<std::vector<TimedCells>> readByVtk(const std::filesystem::path& path,
                                                        MeshFormat format,
                                                        const ReadOptions& options,
                                                        ReadReport& report);

}  // namespace qtet
