// Values that are missing (NaN) on their way through the simplifier, which wants a number
// everywhere: filled in before, cut out again after.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "codec/record/fusion_history.h"

namespace qtet {

/// Gives each missing value the value of the nearest point or cell along the mesh. A step leads
/// from point to point of one cell, or from cell to cell over a point. The value is 0 where none is
/// within reach. `missing` has one flag a value.
void fillMissing(std::span<const Tetrahedron> cells, const FieldInfo& field,
                 std::span<const std::uint8_t> missing, std::vector<std::int32_t>& values);

/// Flags of the vertices that ever lived, one a component; `missing` has those of the original's. A
/// fused vertex is missing if all of its prey are.
[[nodiscard]] std::vector<std::uint8_t> missingOfFused(const FusionHistory& history, std::size_t n,
                                                       std::vector<std::uint8_t> missing);

/// A history's values of a field with the missing values put back: `missing` are those of the
/// original's points or cells.
[[nodiscard]] std::vector<std::int32_t> withMissing(const FusionHistory& history,
                                                    const FieldInfo& field,
                                                    std::vector<std::uint8_t> missing,
                                                    std::vector<std::int32_t> values);

/// The same for all fields that have missing values; one list a field, empty without missing
/// values.
void restoreMissing(FusionHistory& history, const std::vector<std::vector<std::uint8_t>>& missing);

}  // namespace qtet
