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

}  // namespace qtet
