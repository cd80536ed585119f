// Limits on the viewer's folder, which is kept in memory.
#pragma once

#include <cstddef>
#include <cstdint>

namespace qtet::limits {

/// Files: the built viewer has about twenty.
inline constexpr std::size_t kMaxViewerFiles = 1000;
/// Bytes of all of them: the built viewer has about one MiB.
inline constexpr std::uintmax_t kMaxViewerBytes = 64u << 20;

}  // namespace qtet::limits
