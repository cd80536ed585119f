// Which fields an `open` means, and in which order they come (STREAM.md, "Time").
#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codec/log/field_shape.h"
#include "proto/stream_request.h"

namespace qtet {

class FieldKeys;
struct Series;

/// The blocks of one turn's fields come before those of the next turn's. Each turn is ascending,
/// and no field is in two.
using FieldTurns = std::vector<std::vector<std::uint32_t>>;

/// One turn at least; the first has all fields that are no wished instants. With a time a name that
/// no field has means a series (FieldKeys). Then fields come with those that they are predicted
/// from, and instants ahead that would make more than kMaxRequestFields fields are left out.
/// Returns the first name that means nothing instead. REQUIRES: `keys`, `series` and `shapes` are
/// those of one log.
[[nodiscard]] std::expected<FieldTurns, std::string> fieldTurns(
    std::span<const std::string> names, const std::optional<StreamTime>& time,
    const FieldKeys& keys, std::span<const Series> series, std::span<const FieldShape> shapes);

}  // namespace qtet
