// The points and cells of VTK's grids whose files do not list them: structured, rectilinear, image.
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/vtu/vtu_cells.h"
#include "simplify/read/vtu/vtu_document.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Appends the points of a rectilinear grid or an image, the first axis changing first. Errors:
/// those of readVtu. REQUIRES: a grid of such a kind.
[[nodiscard]] Status addGridPoints(const VtuFile& file, const VtuDocument& document,
                                   const VtuPiece& piece, std::vector<Position>& points);

/// Appends the piece's visible cells to `out`, and adds one of `rows` for each. A cell of a
/// structured grid is also hidden where one of its points is (VTK's blanking). Flat cells are
/// counted in the report. Errors: those of readVtu. REQUIRES: a grid that is not unstructured.
[[nodiscard]] Status addGridCells(const VtuFile& file, const VtuDocument& document,
                                  const VtuPiece& piece, CellMesh& out, KeptRows& rows,
                                  ReadReport& report);

}  // namespace qtet
