// The blocks that a mesh is dealt to in a band (BLOCKS.md): boxes between planes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace qtet {

/// Four times the middle of a tetrahedron: the sum of its corners.
using CellMiddle = std::array<std::uint32_t, 3>;

class BlockPlanes {
 public:
  /// `count` blocks of about equal numbers of the sampled cells, or fewer if these do not tell so
  /// many apart. Planes cut across the longest side. The same sample in any order gives the same
  /// blocks. REQUIRES: count >= 1.
  BlockPlanes(std::vector<CellMiddle> sample, std::uint32_t count);

  [[nodiscard]] std::uint32_t count() const { return count_; }
  /// Below count().
  [[nodiscard]] std::uint32_t blockOf(const CellMiddle& middle) const;

 private:
  struct Node {
    std::uint8_t axis = 0;
    std::uint32_t at = 0;     // cells below go to the child that follows
    std::uint32_t right = 0;  // 0: a leaf, and `at` is its block
  };

  void cut(std::span<CellMiddle> sample, std::uint32_t count);

  std::vector<Node> nodes_;
  std::uint32_t count_ = 0;
};

}  // namespace qtet
