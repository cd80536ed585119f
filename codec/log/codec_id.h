// How a block's bytes are coded.
#pragma once

#include <cstdint>

namespace qtet {

/// How a block's bytes are coded (FORMAT.md, "Codec ids").
enum class CodecId : std::uint8_t {
  kEmpty = 0,     ///< no bytes
  kRange = 1,     ///< structure: the adaptive binary range coder
  kDraco = 2,     ///< values: one Draco point cloud, sequential, one int32 attribute, and digits
  kAdaptive = 3,  ///< values: the adaptive binary range coder
};

}  // namespace qtet
