// Puts differences in time in place of a series' values, before they are encoded (FORMAT.md,
// "Series").
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stop_token>

#include "codec/record/fusion_history.h"
#include "proto/error.h"

namespace qtet {

/// Chooses how each instant of each series is predicted, so that least is left. The choices are
/// nothing, the nearest decoded instant, the two around it, and the polynomial through up to four.
/// Only instants of one bits, step and minimum predict each other. Its values become what is left,
/// and its FieldInfo says of what. `progress` gets fractions of the work. Returns how many instants
/// became differences. Errors: cancelled; the history is then of no use. REQUIRES: series in the
/// order of decoding (orderSeries). The first rows.size() fields stay as they are: instants that a
/// log has already. rows[f] is how many predictions field f rests on there, one on the other.
[[nodiscard]] Result<std::size_t> toTimeDifferences(
    FusionHistory& history, const std::stop_token& stop = {},
    const std::function<void(double)>& progress = {}, std::span<const std::size_t> rows = {});

}  // namespace qtet
