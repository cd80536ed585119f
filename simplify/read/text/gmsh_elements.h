// Gmsh's kinds of elements in VTK's words.
#pragma once

#include <cstdint>
#include <span>

namespace qtet {

struct GmshElement {
  std::uint32_t nodes = 0;  ///< 0: a kind that is not known
  std::uint8_t type = 0;    ///< CellType; 0: of lower dimension
  /// The place among Gmsh's nodes of each of VTK's; empty: the same order.
  std::span<const std::uint16_t> nodeOf{};
};

[[nodiscard]] GmshElement gmshElement(std::int64_t number);

/// The complete element of order 3 or more with so many nodes and the corners of `linear`, a
/// CellType. It has no nodes if there is none.
[[nodiscard]] GmshElement higherGmshElement(std::uint8_t linear, std::uint32_t nodes);

}  // namespace qtet
