// The nearest triangle of a surface on the lattice: a tree of bounding boxes that follows a surface
// which is being simplified.
#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/mesh/measure_geometry.h"

namespace qtet {

/// A triangle and its point nearest to some place. A fresh one is infinitely far away.
struct NearestTriangle {
  std::uint32_t triangle = 0;
  NearestPoint point{std::numeric_limits<double>::infinity(), {}};
};

/// If a surface's triangles are long and thin and askew, its nodes have slabs along one of their
/// triangles beside the boxes. Boxes hold one another there: in a fan of n triangles every box
/// holds a place of a share of all others. Slabs leave out of a search what boxes do not, never
/// what is nearest. Triangle i has the first three vertices of cells[i]: a ghost cell, or a copy of
/// one. Reading is safe from any thread.
class TriangleTree {
 public:
  using Cell = std::array<VertexId, 4>;

  /// A tree over the triangles `ids`. The data behind the spans must outlive it; vertices may
  /// change between two refits.
  TriangleTree(std::span<const LatticePoint> points, std::span<const Cell> cells,
               std::vector<std::uint32_t> ids);

  /// From now on grow() may be called.
  void allowGrowth();
  /// A vertex of the triangle has changed. The boxes that hold the triangle do so again, and until
  /// the next refit they hold where it was as well. Slabs do not: nearest() is not for such a tree.
  /// REQUIRES: allowGrowth().
  void grow(std::uint32_t triangle);
  /// Calls visit(id, corners) for the triangles of every leaf whose box touches the one from low to
  /// high, until it returns false.
  template <class Visit>
  void touching(const LatticePoint& low, const LatticePoint& high, const Visit& visit) const;
  /// Calls visit(id, corners) for the triangles of every leaf whose box the segment passes, and
  /// perhaps a few more.
  template <class Visit>
  void crossing(const Vector3& from, const Vector3& to, const Visit& visit) const;

  /// Fits the boxes to the vertices as they are now and leaves out the triangles that do not live
  /// any more. Linear time without slabs, n log n with them.
  void refit(std::span<const std::uint8_t> live);
  [[nodiscard]] std::size_t builtOver() const { return ids_.size(); }
  [[nodiscard]] std::array<Vector3, 3> corners(std::uint32_t triangle) const {
    return toVectors(placeOf(triangle));
  }

  /// Puts the nearest triangle into `best` if it is nearer than what stands there: a good guess
  /// makes the search short. A search for a maximum may end at any triangle whose squared distance
  /// is not above `enough`. Returns what it took: nodes looked into.
  std::size_t nearest(const Vector3& p, NearestTriangle& best, double enough = 0) const;
  /// The same for one triangle.
  void tryTriangle(const Vector3& p, std::uint32_t triangle, NearestTriangle& best) const;

 private:
  struct Node {
    LatticePoint low, high;  // low > high where nothing lives
    // second child, the first one follows its parent; 0 = a leaf
    std::uint32_t right = 0;
    std::uint32_t first = 0, count = 0;  // of a leaf, into ids_
  };

  static constexpr std::uint32_t kNoNode = ~std::uint32_t{0};
  // Nodes that wait during a search: one a level of a tree that halves 2^29 triangles, and
  // one more.
  static constexpr std::size_t kMaxWaiting = 32;

  /// Two slabs, each between two planes: along the surface across its triangles, and away from it.
  struct Slabs {
    std::array<Vector3, 2> axis;      // unit vectors
    std::array<double, 2> low, high;  // low > high where nothing lives
  };

  using Place = std::array<LatticePoint, 3>;
  [[nodiscard]] Place placeOf(std::uint32_t triangle) const {
    const Cell& cell = cells_[triangle];
    assert(cell[0] < points_.size() && cell[1] < points_.size() && cell[2] < points_.size());
    return {points_[cell[0]], points_[cell[1]], points_[cell[2]]};
  }
  [[nodiscard]] static std::array<Vector3, 3> toVectors(const Place& place) {
    return {toVector(place[0]), toVector(place[1]), toVector(place[2])};
  }
  static void tryPlace(const Vector3& p, const Place& place, std::uint32_t triangle,
                       NearestTriangle& best);
  /// Calls visit(id, corners), until it returns false, for the leaves under nodes that are not
  /// apart.
  template <class IsApart, class Visit>
  void walk(const IsApart& isApart, const Visit& visit) const;
  void build(std::uint32_t first, std::uint32_t count);
  static void clear(Node& node);
  /// Returns whether the node's box had to grow.
  static bool enclose(Node& node, const Place& place);
  [[nodiscard]] bool isCrowded() const;
  void fitSlabs(std::span<const std::uint8_t> live);
  [[nodiscard]] Slabs slabsOf(const Node& node, std::span<const std::uint8_t> live) const;
  [[nodiscard]] static double squaredDistance(const Vector3& p, const Slabs& slabs);
  [[nodiscard]] static double squaredDistance(const Vector3& p, const Node& node);

  std::span<const LatticePoint> points_;
  std::span<const Cell> cells_;
  std::vector<std::uint32_t> ids_;
  // Where the triangles are, as of the last refit or grow, in the order of ids_. A search reads
  // neighbours in the tree, which lie anywhere in the mesh.
  std::vector<Place> places_;
  std::vector<Node> nodes_;
  std::vector<Slabs> slabs_;  // one a node, or none
  // of grow(): by node its parent, by triangle its leaf
  std::vector<std::uint32_t> parents_, leaves_;
};

template <class IsApart, class Visit>
void TriangleTree::walk(const IsApart& isApart, const Visit& visit) const {
  std::array<std::uint32_t, kMaxWaiting> waiting;
  std::size_t size = 0;
  for (std::uint32_t index = 0;;) {
    const Node& node = nodes_[index];
    const bool apart = isApart(node);
    if (!apart && node.right != 0) {
      assert(size < kMaxWaiting && node.right > index);
      waiting[size++] = node.right;
      ++index;
      continue;
    }
    if (!apart)
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        if (!visit(ids_[i], toVectors(places_[i]))) return;
    if (size == 0) return;
    index = waiting[--size];
  }
}

template <class Visit>
void TriangleTree::touching(const LatticePoint& low, const LatticePoint& high,
                            const Visit& visit) const {
  assert(low[0] <= high[0] && low[1] <= high[1] && low[2] <= high[2]);
  const auto isApart = [&](const Node& node) {
    bool apart = false;
    for (std::size_t k = 0; k < 3; ++k) apart |= node.high[k] < low[k] || node.low[k] > high[k];
    return apart;
  };
  walk(isApart, visit);
}

// Neither their boxes are apart, nor what they are like seen along an axis (separating axes).
template <class Visit>
void TriangleTree::crossing(const Vector3& from, const Vector3& to, const Visit& visit) const {
  const Vector3 middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const Vector3 size{std::abs(half[0]), std::abs(half[1]), std::abs(half[2])};
  constexpr double kSlack = 1e-6;  // lattice steps, for rounding and a flat box
  const auto isApart = [&](const Node& node) {
    const Vector3 low = toVector(node.low), high = toVector(node.high);
    const Vector3 off = 0.5 * (low + high) - middle, box = 0.5 * (high - low);
    bool apart = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      apart |= std::abs(off[k]) > box[k] + size[k] + kSlack;
      apart |= std::abs(off[k] * half[l] - off[l] * half[k]) >
               box[k] * size[l] + box[l] * size[k] + kSlack * (size[k] + size[l]);
    }
    return apart;
  };
  walk(isApart, [&](std::uint32_t id, const std::array<Vector3, 3>& corners) {
    return visit(id, corners), true;
  });
}

}  // namespace qtet
