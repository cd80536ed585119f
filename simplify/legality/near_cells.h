// The cubes of the lattice that are certainly in a solid or near it. They prove most tetrahedra
// that a fusion adds, without a search (ALGORITHM.md, "The envelope's tolerance").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "simplify/mesh/triangle_tree.h"
#include "simplify/mesh/vector3.h"

namespace qtet {

/// Cubes of a whole number of lattice steps in blocks of 8^3. Reading is safe from any thread.
class NearCells {
 public:
  using Cell = std::array<std::int32_t, 3>;
  using Corners = std::array<Vector3, 4>;
  /// Whether a place that is not on the surface is inside the solid for sure.
  using IsInside = std::function<bool(const Vector3&)>;

  /// Nothing is known.
  NearCells() = default;
  /// Triangle i of the tree has tolerances[i], in lattice steps, and `most` is the largest one. A
  /// cube is near where no point of it is further from one triangle than that one's.
  NearCells(const TriangleTree& tree, std::span<const float> tolerances, double most,
            const IsInside& isInside);

  /// Every cube that the tetrahedron touches is near or inside. REQUIRES: corners in [0, 2^30)^3,
  /// and that something is known.
  [[nodiscard]] bool holds(const Corners& tetrahedron) const;
  [[nodiscard]] bool isKnown() const { return length_ > 0; }

 private:
  static constexpr std::int32_t kBlockBits = 3, kBlockLength = 1 << kBlockBits;
  // what stands in directory_ for blocks of one kind; above: of blocks_, and two more
  static constexpr std::uint32_t kUnknown = 0, kInside = 1, kFirstBlock = 2;
  using Block = std::array<std::uint64_t, kBlockLength>;  // a bit a cube, x first

  struct Node {  // a cube of 2^bits cells
    Cell low;
    int bits;
  };
  /// A triangle's cubes: near where their middles are no further than `near`. It may pass those
  /// whose middles are no further than `passed`.
  struct Spread {
    std::array<Vector3, 3> triangle;
    Vector3 low, high;  // of its box
    Vector3 middle;
    double near, passed;
  };
  void spread(const Spread& of);
  void spread(const Spread& of, const Node& node);
  [[nodiscard]] bool isAllNear(const Node& node) const;
  [[nodiscard]] std::uint32_t blockOf(const Cell& cell);
  [[nodiscard]] bool isNear(const Cell& cell) const;
  /// All cubes from low to high, both included.
  [[nodiscard]] bool areNear(const Cell& low, const Cell& high) const;
  [[nodiscard]] std::size_t placeOf(const Cell& block) const;
  [[nodiscard]] bool isBlock(const Cell& block) const;
  [[nodiscard]] Vector3 middleOf(const Cell& low, double cells) const;
  void findInside(const IsInside& isInside);
  void fillBlock(const Cell& block, const IsInside& isInside);
  void fillEmpty(const Cell& block, const IsInside& isInside, std::vector<std::uint8_t>& isSeen);

  double length_ = 0;  // of a cube; 0: nothing is known
  int rootBits_ = 0;   // a cube of 2^rootBits_ cells holds all
  Cell blockCounts_{};
  std::vector<std::uint32_t> directory_;
  std::vector<Block> blocks_;  // near or inside
  std::vector<Block> passed_;  // by the surface, perhaps; while this is made
};

}  // namespace qtet
