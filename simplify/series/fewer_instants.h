// Films of half the rate: a log with series without some of their instants.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/log/field_shape.h"
#include "proto/manifest.h"

namespace qtet {

/// The fields that stay if every second instant of each series goes. Each further list lacks every
/// second instant of the one before, up to the ends of windows (decodingOrder). Lists ascend, and
/// hold what their fields are predicted from. Empty where no instant can go.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> fewerInstants(
    const Manifest& manifest, std::span<const FieldShape> fields);

}  // namespace qtet
