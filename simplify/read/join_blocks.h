// Blocks and time steps of one file as one mesh.
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/vtk_grid.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The blocks one after the other, cells numbered on. A block whose points are those of the one
/// before (as Exodus has them) shares them, others stand apart until they are welded. A field that
/// a block lacks is NaN there; a field of integers that a block lacks, or that has other components
/// or another type, is left out, with a note.
[[nodiscard]] CellMesh joinBlocks(std::vector<CellMesh> blocks, std::vector<std::string>& notes);

/// The first step's mesh with every step's fields, called NAME@TIME. Errors: bad-input where a step
/// has other points or cells than the first.
[[nodiscard]] Result<CellMesh> joinSteps(std::vector<TimedCells> steps,
                                         const std::filesystem::path& path);

}  // namespace qtet
