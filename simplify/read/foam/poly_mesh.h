// A mesh of OpenFOAM: the lists in a folder polyMesh, checked and turned into cells.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The points of the folder and their type. Errors: not-found (no such file), bad-input (the file
/// and the line), truncated, io. `patience` holds for each file (FoamList::open).
[[nodiscard]] Status readFoamPoints(const std::filesystem::path& folder,
                                    std::chrono::seconds patience, CellMesh& out);

/// Appends the cells of the folder to `out`, which has the points already. Its lists must have as
/// many things as they say, and fit together. Each cell's faces must close, and the patches must
/// have all faces of the boundary. Errors: as readFoamPoints's, bad-input also with the cell.
[[nodiscard]] Status readPolyMesh(const std::filesystem::path& folder,
                                  std::chrono::seconds patience, CellMesh& out);

/// The label of the cells' zones.
inline constexpr const char* kZoneLabel = "cellZone";

/// Gives the cells the label of their zones where the folder has a file cellZones with one at
/// least. A cell in two zones is in the first; a note counts these. A note says so where the file
/// is damaged, and it has no label then. REQUIRES: `out` has the cells of the folder.
void addCellZones(const std::filesystem::path& folder, std::chrono::seconds patience, CellMesh& out,
                  std::vector<std::string>& notes);

}  // namespace qtet
