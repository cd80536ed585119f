// The link of a vertex: the closed triangle surface round its star, ghost cells included
// (FORMAT.md, "Link"). Built by decoder, encoder and simplifier alike.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/prefetch.h"
#include "codec/mesh/mesh.h"

namespace qtet {

inline constexpr std::uint32_t kNoNeighbour = 0xFFFFFFFFu;
inline constexpr std::uint8_t kNoLabel = 0xFF;

/// Local vertex ids, oriented so that (v0, v1, v2, centre) is a positive cell; neighbour[i] lies
/// across the edge that misses vertex[i].
struct alignas(16) LinkTriangle {
  std::array<std::uint32_t, 3> vertex{};
  std::array<std::uint32_t, 3> neighbour{};
  std::uint8_t label = kNoLabel;  ///< the prey vertex that the cell belongs to after the split
  /// One of the vertices is the ghost: the cell is a boundary triangle.
  bool ghost = false;

  /// The directed edge a -> b is one of its.
  [[nodiscard]] bool holds(std::uint32_t a, std::uint32_t b) const {
    return (vertex[0] == a && vertex[1] == b) || (vertex[1] == a && vertex[2] == b) ||
           (vertex[2] == a && vertex[0] == b);
  }
};

class Link {
 public:
  /// A vertex's offset: vertex less centre in whole numbers, and a fourth that is 0. All 0 for the
  /// ghost.
  using Offset = std::array<double, 4>;
  /// A triangle's middle: six times the mean of its corners, or of the two beside the ghost, less
  /// the centre. Whole numbers.
  struct Middle {
    std::array<double, 3> place{};
    int logSquare = 0;  ///< L(1 + |place|^2) of FORMAT.md, "Label stream"
  };

  /// How many triangles carry each label, 16 bits a label from the lowest on; kMaxLinkTriangles
  /// fit.
  using LabelCounts = std::uint64_t;
  [[nodiscard]] static unsigned countOf(LabelCounts counts, std::size_t label) {
    return static_cast<unsigned>(counts >> (16 * label) & 0xFFFF);
  }

  /// Forgets the triangles; `vertices` is the number of vertex slots that ids stay below.
  void clear(std::size_t vertices);
  /// A hint: triangles of this vertex are to come. REQUIRES: below the number of slots, or the
  /// ghost.
  void expect(VertexId vertex) const {
    assert(localSlot(vertex) < locals_.size());
    prefetch(&locals_[localSlot(vertex)]);
  }
  /// Adds the triangle (a, b, c) of the cell (a, b, c, centre).
  void add(VertexId a, VertexId b, VertexId c) {
    const Triangle one{a, b, c};
    add({&one, 1});
  }
  /// Adds these in order.
  void add(std::span<const Triangle> triangles);
  /// Knows every triangle's neighbours. False unless every edge joins two vertices and is met by
  /// exactly two triangles, once in each direction.
  [[nodiscard]] bool close();
  /// True for one sphere: connected, Euler characteristic 2. Leaves the traversal ready. REQUIRES
  /// close() was true.
  [[nodiscard]] bool isSphere();
  /// Triangles in breadth-first order from the start, neighbours 0, 1, 2. REQUIRES isSphere() was
  /// true.
  [[nodiscard]] std::span<const std::uint32_t> traversal() const {
    assert(reached_ == triangleCount_);
    return {order_.data(), triangleCount_};
  }
  /// Notes where the vertices lie relative to the centre. The traversal then starts at the triangle
  /// furthest from it, which best indicates the direction of the prey. REQUIRES ids below
  /// points.size(), and isSphere() not asked before.
  void place(std::span<const LatticePoint> points, const LatticePoint& centre);
  /// By local id. REQUIRES place().
  [[nodiscard]] std::span<const Offset> offsets() const {
    assert(vertexCount_ <= offsets_.size());
    return {offsets_.data(), vertexCount_};
  }
  /// By triangle. REQUIRES place().
  [[nodiscard]] std::span<const Middle> middles() const {
    assert(triangleCount_ <= middles_.size());
    return {middles_.data(), triangleCount_};
  }

  /// Gives a triangle its label. REQUIRES: it has none yet, label < 4.
  void label(std::uint32_t triangle, unsigned label) {
    LinkTriangle& t = triangles_[triangle];
    assert(triangle < triangleCount_ && t.label == kNoLabel && label < 4);
    t.label = static_cast<std::uint8_t>(label);
    for (const std::uint32_t v : t.vertex) labelsRound_[v] += LabelCounts{1} << (16 * label);
  }
  /// The label counts of the triangles round a local vertex.
  [[nodiscard]] LabelCounts labelsRound(std::uint32_t local) const {
    assert(local < vertexCount_);
    return labelsRound_[local];
  }

  [[nodiscard]] std::span<const LinkTriangle> triangles() const {
    return {triangles_.data(), triangleCount_};
  }
  /// Local id -> vertex (kGhost for the ghost), in order of first appearance.
  [[nodiscard]] std::span<const VertexId> vertices() const {
    return {vertices_.data(), vertexCount_};
  }
  /// One triangle that holds the local vertex.
  [[nodiscard]] std::uint32_t triangleOf(std::uint32_t local) const {
    assert(local < vertexCount_);
    return anyTriangle_[local];
  }
  /// The local id of a vertex, or kNoNeighbour when it is not on the link.
  [[nodiscard]] std::uint32_t localOf(VertexId vertex) const;
  [[nodiscard]] bool hasGhost() const { return localOf(kGhost) != kNoNeighbour; }
  /// The directed edge a -> b (local ids) belongs to a triangle: that triangle, or kNoNeighbour.
  [[nodiscard]] std::uint32_t triangleAtEdge(std::uint32_t a, std::uint32_t b) const;

 private:
  struct Local {
    std::uint32_t generation = 0;  // in which `id` is valid
    std::uint32_t id = 0;
  };

  // the ghost's is the first
  static std::size_t localSlot(VertexId vertex) { return static_cast<VertexId>(vertex + 1); }
  void makeRoom(std::size_t triangles);
  [[nodiscard]] bool closeSmall();
  [[nodiscard]] bool closeLarge();
  void traverse();

  // As long as any link needed so far; what counts is below triangleCount_ and vertexCount_.
  std::vector<LinkTriangle> triangles_;
  std::vector<VertexId> vertices_;
  std::vector<std::uint32_t> anyTriangle_;  // by local id
  std::vector<Offset> offsets_;
  std::vector<LabelCounts> labelsRound_;
  std::vector<Middle> middles_;
  std::vector<std::uint32_t> order_;
  std::uint32_t triangleCount_ = 0, vertexCount_ = 0;
  std::uint32_t start_ = 0;
  std::uint32_t reached_ = 0;  // triangles that the traversal found
  std::vector<Local> locals_;  // by localSlot()
  std::uint32_t generation_ = 0;
  // For a link of at most kSmall vertices. Entry a * kSmall + b is the place (4 * triangle + edge)
  // of the directed edge a -> b. Its upper bits are the turn in which it was noted.
  static constexpr std::size_t kSmall = 64;
  static constexpr int kPlaceBits = 16;
  static constexpr std::int32_t kTurns = 1 << 15;
  std::vector<std::int32_t> small_;
  std::int32_t turn_ = 0;  // below kTurns: the table is cleared but every 32,767th time
  // of a larger one: open-addressed map of directed edges, a power of two long
  std::vector<std::uint64_t> edgeKeys_;
  std::vector<std::uint32_t> edgeTriangles_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace qtet
