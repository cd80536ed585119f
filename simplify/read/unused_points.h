// Points that no cell uses and that lie nowhere.
#pragma once

#include <string>
#include <vector>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Drops points with a coordinate that is NaN or infinite, with their values, where no cell uses
/// one of them, and notes how many. Where a cell uses one, all stay for checkCellMesh to refuse.
/// A mesh that checkCellMesh would refuse for its ids
/// or fields stays as it is, too.
void dropUnusedPoints(CellMesh& mesh, std::vector<std::string>& notes);

}  // namespace qtet
