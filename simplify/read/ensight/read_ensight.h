// Results of EnSight, Gold and 6, as text, "C Binary" and "Fortran Binary".
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// The chosen steps of the case at `path`: the volumes of all parts in one mesh (joinBlocks), and
/// the fields asked for, which are float32. The bytes of the files bound memory; the machine's
/// memory bounds what unfolds, which are uniform and rectilinear grids, and fields. Errors: those
/// of readEnSightCase; io; not-found (a file that the case names; no such time); bad-input (a
/// damaged file; a variable whose file has other values than the mesh asks for); truncated.
[[nodiscard]] Result<std::vector<TimedCells>> readEnSight(const std::filesystem::path& path,
                                                          const ReadOptions& options,
                                                          ReadReport& report);

}  // namespace qtet
