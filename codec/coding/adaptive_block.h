// Value blocks in our own entropy coder (FORMAT.md, "Adaptive blocks"): smaller than Draco's, and
// slower to decode.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Encodes values.size() / components tuples; no tuples give no bytes. REQUIRES |value| < 2^31, 1
/// to kMaxFieldComponents components, whole tuples.
[[nodiscard]] Bytes encodeAdaptiveBlock(std::span<const std::int32_t> values,
                                        std::uint32_t components);

/// The inverse; `tuples` is what the chunk table promises. Errors: limit-exceeded (more tuples than
/// the bytes can hold), truncated, bad-value (a value of 31 bits and more, bytes left over).
[[nodiscard]] Result<std::vector<std::int32_t>> decodeAdaptiveBlock(ByteView bytes,
                                                                    std::uint32_t components,
                                                                    std::uint32_t tuples);

}  // namespace qtet
