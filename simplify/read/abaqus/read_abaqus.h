// Our own reader of Abaqus' and CalculiX' input files (.inp).
#pragma once

#include <chrono>
#include <filesystem>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Nodes and volume elements of first and second order, with included files, parts and instances.
/// Labels, where they differ over the mesh: Material by sections, ElementSet by sets that do not
/// overlap (labelOfSets), and Instance. Other elements are counted. The result is still to be
/// checked (checkCellMesh). Errors: io; not-found (an included file); limit-exceeded; truncated,
/// bad-input (also: no time is left), with the line where it has one.
/// https://docs.software.vt.edu/abaqusv2024/English/SIMACAEKEYRefMap/simakey-m-KeyIndex.htm
[[nodiscard]] Result<CellMesh> readAbaqus(const std::filesystem::path& path, ReadReport& report,
                                          std::chrono::seconds patience = kReadPatience);

}  // namespace qtet
