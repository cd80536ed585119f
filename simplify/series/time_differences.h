// Puts differences in time in place of a series' values, before they are encoded (FORMAT.md,
// "Series").
#pragma once

#include <cstddef>

#include "codec/record/fusion_history.h"

namespace qtet {

/// Chooses how each instant of each series is predicted, so that least is left. The choices are
/// nothing, the nearest decoded instant, the two around it, and the polynomial through up to four.
/// Its values become what is left, and its FieldInfo says of what. Returns how many instants became
/// differences. REQUIRES: series in the order of decoding (orderSeries); fields of a series with
/// one step and minimum.
std::size_t toTimeDifferences(FusionHistory& history);

}  // namespace qtet
