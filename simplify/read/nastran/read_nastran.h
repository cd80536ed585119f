// Bulk data of Nastran: points, coordinate systems and volume elements.
#pragma once

#include <chrono>
#include <filesystem>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// GRID, GRDSET, CORD1R, CORD1C, CORD1S and their kin of CORD2, CTETRA, CHEXA, CPENTA and CPYRAM of
/// the first and second degree. Elements that are no volumes are counted in the report. The
/// properties of elements (PID) are the label nastran:ref where there are two at least. Errors name
/// the file and the line: io; not-found and limit-exceeded (included files); bad-input (a volume
/// element that is not read, or with nodes on some of its edges; a system that is not there;
/// numbers that are given twice).
[[nodiscard]] Result<CellMesh> readNastran(const std::filesystem::path& path, ReadReport& report,
                                           std::chrono::seconds patience = kReadPatience);

}  // namespace qtet
