// Files that name others: parts of one mesh, steps of a series, pieces of a parallel program.
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// The one step of a file that names the parts of a mesh: a summary of pieces, or blocks. `depth`
/// as for readSteps (read_steps.h). Errors: those of piecesOf, blocksOf and readSteps; bad-input
/// (names that go too deep, or that no list of VTK's may have).
[[nodiscard]] Result<std::vector<TimedCells>> readParts(const std::filesystem::path& path,
                                                        MeshFormat format,
                                                        const ReadOptions& options,
                                                        ReadReport& report, int depth);

/// The steps of a file that lists files with their times, or of `options.listed`.
[[nodiscard]] Result<std::vector<TimedCells>> readSeries(const std::filesystem::path& path,
                                                         MeshFormat format,
                                                         const ReadOptions& options,
                                                         ReadReport& report, int depth);

/// The steps of all pieces of an Exodus result, of which `path` names one.
[[nodiscard]] Result<std::vector<TimedCells>> readExodusPieces(const std::filesystem::path& path,
                                                               MeshFormat format,
                                                               const ReadOptions& options,
                                                               ReadReport& report, int depth);

}  // namespace qtet
