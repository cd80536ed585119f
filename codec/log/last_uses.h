// Until when decoded fields are needed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/log/field_shape.h"

namespace qtet {

/// `fields` are decoded one after the other. At each place: those that no field behind it is
/// predicted from any more. REQUIRES: withParents's order and completeness.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> lastUses(
    std::span<const FieldShape> shapes, std::span<const std::uint32_t> fields);

}  // namespace qtet
