// Named sets of cells as one label, as far as they do not overlap.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// Sets by number. `cellsOf` puts the cells of a set into the list that it is given, each once. It
/// is called twice for a set, so that not all sets are held at once.
struct CellSets {
  std::vector<std::string> names;
  std::function<void(std::size_t, std::vector<std::uint32_t>&)> cellsOf;
};

/// A cell field of int32 with names: 1 and more for the sets in their order, 0 for cells of no set.
/// The larger one of sets that overlap stays, of equal ones the later. The others are left out with
/// a note, and so are sets beyond kMaxLabelNames with another. A set of all cells says nothing and
/// is left out without one. nullopt: no set is left.
[[nodiscard]] std::optional<MeshField> labelOfSets(const std::string& name, std::size_t cells,
                                                   const CellSets& sets,
                                                   std::vector<std::string>& notes);

/// A cell field of int32 with names. nullopt: it has one value everywhere.
[[nodiscard]] std::optional<MeshField> labelOf(const std::string& name,
                                               const std::vector<std::uint32_t>& values,
                                               LabelNames names);

}  // namespace qtet
