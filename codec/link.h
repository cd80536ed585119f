// The link of a vertex: the closed triangle surface round its star, ghost cells included (FORMAT.md, "Link"). Built by decoder, encoder and
// simplifier alike.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh.h"

namespace qtet {

inline constexpr std::uint32_t kNoNeighbour = 0xFFFFFFFFu;
inline constexpr std::uint8_t kNoLabel = 0xFF;

/// Local vertex ids, oriented so that (v0, v1, v2, centre) is a positive cell; neighbour[i] lies across the edge that misses vertex[i].
struct LinkTriangle {
  std::array<std::uint32_t, 3> vertex{};
  std::array<std::uint32_t, 3> neighbour{};
  std::uint8_t label = kNoLabel;  ///< the prey vertex that the cell belongs to after the split
  /// The directed edge a -> b is one of its.
  [[nodiscard]] bool holds(std::uint32_t a, std::uint32_t b) const {
    return (vertex[0] == a && vertex[1] == b) || (vertex[1] == a && vertex[2] == b) || (vertex[2] == a && vertex[0] == b);
  }

  bool ghost = false;             ///< one of the vertices is the ghost: the cell is a boundary triangle
};

class Link {
 public:
  /// Forgets the triangles; `vertices` is the number of vertex slots that ids stay below.
  void clear(std::size_t vertices);
  /// Adds the triangle (a, b, c) of the cell (a, b, c, centre).
  void add(VertexId a, VertexId b, VertexId c);
  /// Finds the neighbours. False unless every edge is met by exactly two triangles, once in each direction.
  [[nodiscard]] bool close();
  /// True for one sphere: connected, Euler characteristic 2. Leaves the traversal ready. REQUIRES close() was true.
  [[nodiscard]] bool isSphere();
  /// Triangles in breadth-first order from the start, neighbours 0, 1, 2. REQUIRES isSphere() was true.
  [[nodiscard]] std::span<const std::uint32_t> traversal() const { return order_; }
  /// Notes where the vertices lie with respect to the centre, and makes the triangle that is furthest from it the start of the traversal: the surest
  /// guess of which way the prey lay. REQUIRES ids below points.size(), and isSphere() not asked before.
  void place(std::span<const LatticePoint> points, const LatticePoint& centre);
  /// Local id -> vertex less centre; 0 for the ghost. REQUIRES place().
  [[nodiscard]] const std::vector<LatticePoint>& offsets() const { return offsets_; }
  /// Six times the middle of a triangle's corners, or of the two beside the ghost, less the centre. REQUIRES place().
  [[nodiscard]] std::array<std::int64_t, 3> sixTimesMiddle(const LinkTriangle& t) const {
    std::array<std::int64_t, 3> sum{};
    for (const std::uint32_t v : t.vertex)
      for (std::size_t a = 0; a < 3; ++a) sum[a] += offsets_[v][a];
    for (std::int64_t& x : sum) x *= t.ghost ? 3 : 2;
    return sum;
  }

  [[nodiscard]] std::vector<LinkTriangle>& triangles() { return triangles_; }
  [[nodiscard]] const std::vector<LinkTriangle>& triangles() const { return triangles_; }
  /// Local id -> vertex (kGhost for the ghost), in order of first appearance.
  [[nodiscard]] const std::vector<VertexId>& vertices() const { return vertices_; }
  /// One triangle that holds the local vertex.
  [[nodiscard]] std::uint32_t triangleOf(std::uint32_t local) const { return anyTriangle_[local]; }
  /// The local id of a vertex, or kNoNeighbour when it is not on the link.
  [[nodiscard]] std::uint32_t localOf(VertexId vertex) const;
  [[nodiscard]] bool hasGhost() const { return ghostLocal_ != kNoNeighbour; }
  /// The directed edge a -> b (local ids) belongs to a triangle: that triangle, or kNoNeighbour.
  [[nodiscard]] std::uint32_t triangleAtEdge(std::uint32_t a, std::uint32_t b) const;

 private:
  std::uint32_t intern(VertexId vertex);
  [[nodiscard]] bool closeSmall();
  [[nodiscard]] bool closeLarge();
  void traverse();

  std::vector<LinkTriangle> triangles_;
  std::vector<VertexId> vertices_;
  std::vector<LatticePoint> offsets_;
  std::uint32_t start_ = 0;
  std::vector<std::uint32_t> anyTriangle_;
  std::uint32_t ghostLocal_ = kNoNeighbour;
  std::vector<std::uint32_t> stamp_;  // by vertex: generation in which local_ is valid
  std::vector<std::uint32_t> local_;
  std::uint32_t generation_ = 0;
  // Of a small link, by a * kSmall + b: the triangle that holds the directed edge a -> b, where it really does; else whatever was there before.
  static constexpr std::size_t kSmall = 64;
  std::vector<std::uint16_t> small_;
  std::vector<std::uint64_t> edgeKeys_;  // open-addressed map of directed edges, a power of two long
  std::vector<std::uint32_t> edgeTriangles_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace qtet
