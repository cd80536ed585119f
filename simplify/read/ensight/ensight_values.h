// The values of EnSight's variables.
#pragma once

#include <string>
#include <vector>

#include "simplify/read/ensight/ensight_geometry.h"

namespace qtet {

/// The variable's values by block, for each point, or for each row of elements (EnSightBlock);
/// empty where the file has none for a block. NaN: undefined, or not listed. Errors: bad-input,
/// without the file's name (too few or too many values; values of other parts than the geometry's;
/// no values at all; more than `bounds` have room for).
[[nodiscard]] Result<std::vector<std::vector<double>>> readEnSightValues(
    std::string_view bytes, const std::filesystem::path& file, const EnSightVariable& variable,
    const EnSightGeometry& geometry, EnSightBounds& bounds);

}  // namespace qtet
