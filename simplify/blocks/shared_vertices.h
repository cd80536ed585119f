// Which vertices a block shares with others, from what was dealt to whom (BLOCKS.md).
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "simplify/blocks/mesh_piece.h"

namespace qtet {

/// Threads may call at once.
class SharedVertices {
 public:
  /// `vertices`, ascending, of a piece that was dealt to block `block`. `mayBe`, ascending: those
  /// of the piece's source that are in several blocks, before or after.
  void add(std::uint32_t block, std::span<const WholeVertex> vertices,
           std::span<const WholeVertex> mayBe);

  /// By block, ascending: the vertices that were added for several blocks.
  [[nodiscard]] std::vector<std::vector<WholeVertex>> take(std::uint32_t blocks);

 private:
  std::mutex mutex_;
  std::vector<std::pair<WholeVertex, std::uint32_t>> blockOf_;
};

}  // namespace qtet
