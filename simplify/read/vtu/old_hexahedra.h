// Hexahedra of higher degree in files of VTK before version 9, which numbered two edges the other
// way round.
#pragma once

#include <string_view>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The versions of the two formats from which on hexahedra have VTK 9's order of nodes. VTK's own
/// readers renumber the nodes of older files
/// (VTK 9.0, "node-numbering-change-for-VTK_LAGRANGE_HEXAHEDRON").
inline constexpr std::string_view kNewXmlHexahedra = "2.1";
inline constexpr std::string_view kNewLegacyHexahedra = "5.1";

/// Whether the text "MAJOR.MINOR" states an older version than `other` does. A number that is
/// missing is 0.
[[nodiscard]] bool isOlderVersion(std::string_view version, std::string_view other);

/// Lagrange and Bezier hexahedra get VTK 9's order of nodes: edges 10 and 11 change places. Degrees
/// are those that the cell field kDegreesField states. Cells with an impossible number of nodes
/// stay as they are.
void renumberOldHexahedra(CellMesh& mesh);

}  // namespace qtet
