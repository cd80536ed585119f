// Values that are missing (NaN) on their way through the simplifier, which wants a number everywhere: filled in before, cut out again after.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/fusion_history.h"
#include "codec/mesh.h"

namespace qtet {

/// Gives each gap the value of a point or cell that is nearest along the mesh, by steps from point to point of one cell, or from cell to cell over a point;
/// 0 where none is to be reached. `gaps` has one flag a value.
void fillGaps(std::span<const Tetrahedron> cells, const FieldInfo& field, std::span<const std::uint8_t> gaps, std::vector<std::int32_t>& values);

/// A history's values of a field with the gaps put back: `gaps` are those of the original's points or cells. A fused vertex is a gap if all of its prey are.
[[nodiscard]] std::vector<std::int32_t> gapsCutOut(const FusionHistory& history, const FieldInfo& field, std::vector<std::uint8_t> gaps,
                                                   std::vector<std::int32_t> values);

/// The same for all fields that have gaps; one list a field, empty without gaps.
void cutGapsOut(FusionHistory& history, const std::vector<std::vector<std::uint8_t>>& gaps);

}  // namespace qtet
