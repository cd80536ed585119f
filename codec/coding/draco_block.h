// Value blocks: one standard Draco point cloud, sequential encoding, prediction off, one generic
// int32 attribute (FORMAT.md, "Value blocks").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Encodes values.size() / components tuples and decodes them again to be sure: Draco loses
/// integers above 2^30 without a word. Errors: limit-exceeded (a magnitude above
/// kMaxDracoMagnitude), bad-codec (Draco refused, or gave other values back). No tuples give no
/// bytes.
[[nodiscard]] Result<Bytes> encodeDracoBlock(std::span<const std::int32_t> values,
                                             std::uint32_t components);

/// The inverse. `tuples` is what the chunk table promises; Draco's own count is compared with it
/// before its values are looked at. Errors: bad-codec, bad-value (another number of tuples or
/// components).
[[nodiscard]] Result<std::vector<std::int32_t>> decodeDracoBlock(ByteView bytes,
                                                                 std::uint32_t components,
                                                                 std::uint32_t tuples);

}  // namespace qtet
