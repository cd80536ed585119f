// The bound of a mesh's name.
#pragma once

#include <cstddef>

namespace qtet::limits {

/// Bytes of a mesh's name: with `.qtet` and what an upload appends, below the 255 that file systems
/// allow.
inline constexpr std::size_t kMaxIdBytes = 150;

}  // namespace qtet::limits
