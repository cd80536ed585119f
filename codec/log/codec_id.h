// How a block's bytes are coded.
#pragma once

#include <cstdint>

#include "codec/log/field_shape.h"

namespace qtet {

/// How a block's bytes are coded (FORMAT.md, "Codec ids").
enum class CodecId : std::uint8_t {
  kRange = 1,     ///< structure: the adaptive binary range coder
  kDraco = 2,     ///< values: one Draco point cloud, sequential, one int32 attribute, and digits
  kAdaptive = 3,  ///< values: the adaptive binary range coder
  /// Point fields: each value once, in the range coder. Cell fields are kAdaptive then, positions
  /// kDraco.
  kLifted = 4,
};

/// The codec of a field's blocks where the values of a chunk have this one.
[[nodiscard]] constexpr CodecId blockCodec(CodecId values, Association association) {
  return values == CodecId::kLifted && association == Association::kCell ? CodecId::kAdaptive
                                                                         : values;
}
[[nodiscard]] constexpr CodecId positionCodec(CodecId values) {
  return values == CodecId::kLifted ? CodecId::kDraco : values;
}

}  // namespace qtet
