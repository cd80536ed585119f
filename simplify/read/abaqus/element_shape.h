// The kinds of elements of Abaqus and CalculiX by their names.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace qtet {

struct AbaqusElement {
  std::uint8_t type = 0;     ///< CellType; 0: the element is no volume
  std::uint32_t nodes = 0;   ///< that the element has at least
  bool mayHaveMore = false;  ///< further nodes, which are left out
  /// Which of the file's nodes is VTK's first, second ...; empty: the order is VTK's.
  std::span<const std::uint8_t> order{};
};

/// `name` in capital letters: "C3D10M". Shells, beams, springs and the like are no volumes.
/// nullopt: the name is not known.
[[nodiscard]] std::optional<AbaqusElement> abaqusElement(std::string_view name);

}  // namespace qtet
