// Plain values for the blocks that a client of `/v1/stream` has (STREAM.md, "What a client has").
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace qtet {

/// Counts of the leading chunks that a client has applied.
struct Have {
  std::uint32_t chunks = 0;                                     ///< of the mesh
  std::vector<std::pair<std::string, std::uint32_t>> fields{};  ///< by key; at most `chunks` each
};

/// Which instants of the series asked for come, and in which order (STREAM.md, "Time").
struct StreamTime {
  double at = 0;            ///< the nearest instant comes first
  std::uint32_t ahead = 0;  ///< so many behind it, at most kMaxAhead
  enum class First : std::uint8_t {
    kSpace,  ///< an instant is whole before the next one begins
    kTime,   ///< a chunk has all instants before the next one begins
  };
  First first = First::kSpace;
};

}  // namespace qtet
