// Puts differences in time in place of a series' values, before they are encoded (FORMAT.md,
// "Series").
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>

#include "codec/record/fusion_history.h"
#include "proto/error.h"

namespace qtet {

/// A fused vertex's value of an instant may be moved by so many steps, to the value that other
/// instants predict. It is an estimate, and at the default 12 bits this is 1 / 2,048 of the range.
inline constexpr std::int32_t kMaxSettled = 2;

/// Chooses how each instant of each series is predicted, so that least is left (SERIES.md,
/// "Predictions in time"). The field's FieldInfo says it. Only instants of one step and
/// minimum predict each other. Where it saves bits, fused vertices' values settle: those predicted
/// within kMaxSettled become the prediction. Values of integer types, displacements and fields
/// with missing values stay. `progress` gets fractions of the work. Returns how many instants are
/// predicted. Errors: cancelled; the history is then of no use. REQUIRES: series in the order of
/// decoding (seriesOrder). The first rows.size() fields stay as they are: instants that a log has
/// already. rows[f] is how many predictions field f rests on there, one on the other.
[[nodiscard]] Result<std::size_t> predictInTime(FusionHistory& history,
                                                const std::stop_token& stop = {},
                                                const std::function<void(double)>& progress = {},
                                                std::span<const std::size_t> rows = {});

/// The values of predicted instants become what is left of them.
void toTimeDifferences(FusionHistory& history);

}  // namespace qtet
