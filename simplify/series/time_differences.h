// Puts differences in time in place of a series' values, before they are encoded (FORMAT.md,
// "Series").
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "codec/record/fusion_history.h"
#include "proto/error.h"

namespace qtet {

/// Chooses how each instant of each series is predicted, so that least is left (SERIES.md,
/// "Predictions in time"). The field's FieldInfo says it. Only instants of one step and
/// minimum predict each other. `progress` gets fractions of the work. Returns how many instants are
/// predicted. Errors: cancelled; the history is then of no use. REQUIRES: series in the order of
/// decoding (seriesOrder). The first rows.size() fields stay as they are: instants that a log has
/// already. rows[f] is how many predictions field f rests on there, one on the other.
[[nodiscard]] Result<std::size_t> predictInTime(FusionHistory& history,
                                                const std::stop_token& stop = {},
                                                const std::function<void(double)>& progress = {},
                                                std::span<const std::size_t> rows = {});

/// The values that a field's parents predict: none where it has no parents.
[[nodiscard]] std::vector<std::int32_t> predictedValues(const FusionHistory& history,
                                                        std::size_t field);

/// The values of predicted instants become what is left of them.
void toTimeDifferences(FusionHistory& history);

}  // namespace qtet
