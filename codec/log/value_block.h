// The bytes of a value block (FORMAT.md, "Value blocks"). It is a Draco stream of symbols, the
// digits behind it, and the number of bytes of digits; or an adaptive block.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/log/codec_id.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Encodes values.size() / components tuples. No tuples give no bytes.
/// REQUIRES kDraco or kAdaptive. Errors: limit-exceeded (a magnitude of 2^31), bad-codec (Draco
/// refused).
[[nodiscard]] Result<Bytes> encodeValueBlock(std::span<const std::int32_t> values,
                                             std::uint32_t components, CodecId codec);

/// The inverse; `tuples` is what the chunk table promises. REQUIRES the same codecs. Errors:
/// bad-codec, bad-value (another number of tuples, components or digits).
[[nodiscard]] Result<std::vector<std::int32_t>> decodeValueBlock(ByteView bytes,
                                                                 std::uint32_t components,
                                                                 std::uint32_t tuples,
                                                                 CodecId codec);

}  // namespace qtet
