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
  /// A hint: triangles of this vertex are to come. REQUIRES: below the number of slots.
  void expect(VertexId vertex) const { __builtin_prefetch(&locals_[vertex]); }
  /// Adds the triangle (a, b, c) of the cell (a, b, c, centre).
  void add(VertexId a, VertexId b, VertexId c);
  /// Knows every triangle's neighbours. False unless every edge joins two vertices and is met by exactly two triangles, once in each direction.
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
  /// By triangle: six times the middle of its corners, or of the two beside the ghost, less the centre. Whole numbers. REQUIRES place().
  [[nodiscard]] const std::vector<std::array<double, 3>>& sixTimesMiddles() const { return middles_; }

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
  struct Local {
    std::uint32_t generation = 0;  // in which `id` is valid
    std::uint32_t id = 0;
  };

  std::uint32_t intern(VertexId vertex);
  std::uint32_t fresh(VertexId vertex);
  void meet(std::uint32_t a, std::uint32_t b, std::uint32_t place);
  [[nodiscard]] bool closeLarge();
  void traverse();

  std::vector<LinkTriangle> triangles_;
  std::vector<VertexId> vertices_;
  std::vector<LatticePoint> offsets_;
  std::vector<std::array<double, 3>> middles_;
  std::uint32_t start_ = 0;
  std::vector<std::uint32_t> anyTriangle_;
  std::uint32_t ghostLocal_ = kNoNeighbour;
  std::vector<Local> locals_;  // by vertex
  std::uint32_t generation_ = 0;
  // While the link is small, by a * kSmall + b: the place (4 * triangle + edge) of the directed edge a -> b, below the turn in which it was noted.
  static constexpr std::size_t kSmall = 64;
  static constexpr int kPlaceBits = 16;
  std::vector<std::uint32_t> small_;
  std::uint32_t turn_ = 0;     // below 2^16, so that the table is cleared but every 65,535th time
  std::uint32_t joined_ = 0;   // edges met from both sides
  bool isSmall_ = true;        // small_ knows every edge
  bool isBad_ = false;         // an edge met twice from one side, or of one vertex
  std::vector<std::uint64_t> edgeKeys_;  // open-addressed map of directed edges, a power of two long
  std::vector<std::uint32_t> edgeTriangles_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace qtet
