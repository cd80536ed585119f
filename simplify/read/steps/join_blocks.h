// Blocks and time steps of one file as one mesh.
#pragma once

#include <filesystem>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The blocks one after the other, cells numbered on. A block whose points are those of the one
/// before (as Exodus has them) shares them. The others are pieces of their own. They are joined at
/// the points that they share (join_pieces.h) unless `options.joinPieces` is false. Points of
/// blocks with names (cell_labels.h) stay apart where `options.apartBlocks` names both, or else
/// where their values differ. A field whose types differ takes the narrowest type that holds all
/// values. A field of floats that a block lacks is NaN there. A field of integers that a block
/// lacks, or whose components differ, is left out. The report's notes say so.
[[nodiscard]] CellMesh joinBlocks(std::vector<CellMesh> blocks, const ReadOptions& options,
                                  ReadReport& report);

/// Whether both meshes have as many points and the same cells, which their points' places do not
/// change.
[[nodiscard]] bool haveSameCells(const CellMesh& a, const CellMesh& b);

/// The first step's mesh with every step's fields, called NAME@TIME. A step whose points or cells
/// stand in another order is put into that of the first (step_order.h). The instants of a field
/// take the narrowest type that holds all values. If the points of a later step lie elsewhere,
/// every step gets the point field displacementName (moving_points.h). It says how far they are
/// from those of the first step. With `moves` those of some other step lie elsewhere. The field is
/// left out unless `names` means it. The report's notes, its `series` and its `motion` say so.
/// Errors: bad-input where a step has other cells than the first, or another number of points. The
/// same where its points stand in another order than its cells know, or one of a cell is not
/// finite. Also where a field has other components at some steps.
[[nodiscard]] Result<CellMesh> joinSteps(std::vector<TimedCells> steps,
                                         const std::filesystem::path& path, const FieldNames& names,
                                         ReadReport& report, bool moves);

}  // namespace qtet
