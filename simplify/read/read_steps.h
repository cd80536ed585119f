// The readers of all formats: one table.
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// The step or steps that `options.time` asks for, all blocks of each in one mesh (join_blocks.h).
/// They are unchecked beyond what the reader itself checks. Warnings become notes.
/// `depth` files have named this one. Errors: those of the format's own reader and of readApart;
/// not-found (a time that is none; a file that the file names). REQUIRES: a file that checkMeshFile
/// has passed; or kSeries and `options.listed` as withListedFiles gives it. Not thread-safe:
/// readers run in processes of their own.
[[nodiscard]] Result<std::vector<TimedCells>> readSteps(const std::filesystem::path& path,
                                                        MeshFormat format,
                                                        const ReadOptions& options,
                                                        ReadReport& report, int depth = 0);

}  // namespace qtet
