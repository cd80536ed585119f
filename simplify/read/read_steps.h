// Reads the formats whose files hold several time steps, blocks or pieces: VTK's, and those of
// other programs that we or libraries of Python read.
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/foreign/foreign_file.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// The step or steps that `options.time` asks for, all blocks of each in one mesh (join_blocks.h).
/// They are unchecked beyond what the reader itself checks. Warnings become notes.
/// Errors: those of the format's own reader and of readApart; not-found (a time that is none; a
/// file that the file names). REQUIRES: a file that checkMeshFile has passed, of a format before
/// kGmsh; or kSeries and `options.listed` as withListedFiles gives it. Not thread-safe: readers run
/// in processes of their own.
[[nodiscard]] Result<std::vector<TimedCells>> readSteps(const std::filesystem::path& path,
                                                        MeshFormat format,
                                                        const ReadOptions& options,
                                                        ReadReport& report);

/// The same of a file that a library of Python reads. Errors: those of ForeignFile and readSteps.
[[nodiscard]] Result<std::vector<TimedCells>> readForeign(const ForeignInput& input,
                                                          const ReadOptions& options,
                                                          ReadReport& report);

}  // namespace qtet
