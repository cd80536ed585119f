#include "simplify/read/abaqus/element_shape.h"

#include <algorithm>
#include <array>

#include "simplify/read/text/plain_numbers.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {
namespace {

/// Names of volumes begin with one of these, and the number of nodes follows.
constexpr auto kVolumes =
    std::to_array<std::string_view>({"C3D", "AC3D", "DC3D", "DCC3D", "EC3D", "EMC3D", "FC3D", "F3D",
                                     "Q3D", "SC", "CSS", "COH3D", "COD3D", "GK3D"});
/// Names of anything else begin with one of these.
constexpr auto kOthers = std::to_array<std::string_view>(
    {"AC1D",  "AC2D",  "ACAX",   "ACIN",  "ASI",   "B2",    "B3",   "CAX",     "CGAX",  "CIN",
     "COD2D", "CODAX", "COH2D",  "COHAX", "CONN",  "CPE",   "CPS",  "DASHPOT", "DC1D",  "DC2D",
     "DCAX",  "DCC1D", "DCC2D",  "DCCAX", "DCGAX", "DCOUP", "DGAP", "DRAG",    "DS3",   "DS4",
     "DS6",   "DS8",   "DSAX",   "ELBOW", "EMC2D", "F2D",   "F3D3", "FAX",     "FLINK", "FP",
     "FRAME", "GAP",   "GK2D",   "GK3D2", "GKAX",  "GKPE",  "GKPS", "HEAT",    "IRS",   "ISL",
     "ISP",   "ITS",   "ITT",    "JOINT", "LS3",   "LS6",   "M3D",  "MASS",    "MAX",   "MCL",
     "MGAX",  "PC3D",  "PD3D",   "PIPE",  "PSI",   "R2D2",  "R3D",  "RAX",     "RB",    "ROTARYI",
     "SAX",   "SFM",   "SPRING", "STRI",  "T2D"});
/// Shells "S4R", trusses "T3D2", and CalculiX' elements of networks.
bool isOther(std::string_view name) {
  if (std::ranges::any_of(kOthers, [&](std::string_view front) { return name.starts_with(front); }))
    return true;
  const bool hasDigit = name.size() > 1 && name[1] >= '1' && name[1] <= '9';
  return (name.starts_with('S') && hasDigit) || name.starts_with("T3D") ||
         name.starts_with("TUBE") || name.starts_with("WARP") || name == "D" || name == "US3";
}

/// Abaqus has the node at the centre first, then those of the faces below, above and round it.
constexpr std::array<std::uint8_t, 27> kTriquadratic{0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                     9,  10, 11, 12, 13, 14, 15, 16, 17,
                                                     18, 19, 26, 24, 23, 25, 21, 22, 20};

std::optional<AbaqusElement> ofNodes(std::uint32_t nodes) {
  switch (nodes) {
    case 4: return AbaqusElement{kTetrahedronCell, 4};
    case 5: return AbaqusElement{kPyramidCell, 5};
    case 6: return AbaqusElement{kWedgeCell, 6};
    case 8: return AbaqusElement{kHexahedronCell, 8};
    case 10: return AbaqusElement{kQuadraticTetrahedronCell, 10};
    case 13: return AbaqusElement{kQuadraticPyramidCell, 13};
    case 15: return AbaqusElement{kQuadraticWedgeCell, 15};
    case 20: return AbaqusElement{kQuadraticHexahedronCell, 20};
    case 27: return AbaqusElement{kTriquadraticHexahedronCell, 27, false, kTriquadratic};
    default: return std::nullopt;
  }
}

}  // namespace

std::optional<AbaqusElement> abaqusElement(std::string_view name) {
  for (const std::string_view front : kVolumes) {
    if (!name.starts_with(front)) continue;
    const std::string_view rest = name.substr(front.size());
    const std::size_t end = std::min(rest.find_first_not_of("0123456789"), rest.size());
    const auto nodes = plainInteger<std::uint32_t>(rest.substr(0, end));
    const std::string_view suffix = rest.substr(end);
    // a line gasket, whose nodes lie in one surface
    if (front == "GK3D" && suffix.starts_with('L')) return AbaqusElement{};
    // a gasket's 18 nodes and the like are in another order
    const bool isGasket = front == "GK3D" && nodes && *nodes > 8;
    if (!nodes || isGasket || suffix.find_first_of("0123456789") != std::string_view::npos)
      continue;
    if (std::optional<AbaqusElement> out = ofNodes(*nodes)) {
      // nodes for the pressure in the pores follow those of a cohesive element's shape
      const bool hasPores = (front == "COH3D" || front == "COD3D") && suffix.starts_with('P');
      out->mayHaveMore = suffix.starts_with('V') || hasPores;
      return out;
    }
  }
  return isOther(name) ? std::optional(AbaqusElement{}) : std::nullopt;
}

}  // namespace qtet
