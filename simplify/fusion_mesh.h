// The mesh under simplification: live cells with their ghosts, stars that stay up to date, and the history of what was fused.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "codec/fusion_history.h"
#include "codec/mesh.h"
#include "simplify/vector3.h"

namespace qtet {

/// The prey of a fusion: k = 4 a tetrahedron, 3 a triangle, 2 an edge.
struct Prey {
  std::uint8_t k = 2;
  std::array<VertexId, 4> vertex{};

  [[nodiscard]] std::span<const VertexId> vertices() const { return {vertex.data(), k}; }
};

/// The cells of a prey's star and the star's other vertices, kGhost among them where the prey touches the boundary.
struct Star {
  std::vector<CellId> affected, deleted;
  std::vector<std::uint8_t> labels;  ///< by affected cell: the index of its prey vertex
  std::vector<VertexId> link;
};

/// What a prey becomes.
struct FusedVertex {
  LatticePoint point{};
  std::span<const std::int32_t> values;  ///< the integers of every point field, one field after the other
  float outside = 0;                     ///< how far the boundary round it may lie outside the original solid, in lattice steps
};

class FusionMesh {
 public:
  static constexpr std::size_t kNoRegions = ~std::size_t{0};
  /// The region of a ghost cell.
  static constexpr std::int64_t kOutside = std::numeric_limits<std::int64_t>::min();

  /// `regionField`: the cell field of one component whose values are regions to be kept apart.
  /// REQUIRES: a clean mesh (consistent orientation, no face of three cells) whose boundary is boundaryOf(tetrahedra).
  explicit FusionMesh(const LatticeMesh& mesh, std::size_t regionField = kNoRegions);

  [[nodiscard]] std::size_t vertexSlots() const { return history_.points.size(); }
  [[nodiscard]] bool alive(VertexId v) const { return aliveVertex_[v]; }
  [[nodiscard]] bool onBoundary(VertexId v) const { return onBoundary_[v]; }
  /// The link of v is no sphere: the mesh is not a manifold there, and v is never prey.
  [[nodiscard]] bool singular(VertexId v) const { return singular_[v]; }
  [[nodiscard]] const LatticePoint& point(VertexId v) const { return history_.points[v]; }
  [[nodiscard]] Vector3 position(VertexId v) const { return toVector(history_.points[v]); }
  [[nodiscard]] const std::array<VertexId, 4>& cell(CellId c) const { return history_.cells[c]; }
  [[nodiscard]] std::span<const CellId> star(VertexId v) const { return std::span(pool_).subspan(stars_[v].first, stars_[v].size); }
  /// Ask the memory for where v's star is, and then for its list.
  void prefetchVertex(VertexId v) const { __builtin_prefetch(&stars_[v]); }
  void prefetchList(VertexId v) const { __builtin_prefetch(pool_.data() + stars_[v].first); }
  /// Asks the memory for the cells of v's star, which lie anywhere: by the time they are read they are near.
  void prefetchStar(VertexId v) const {
    for (const CellId c : star(v)) __builtin_prefetch(&history_.cells[c]);
  }
  void prefetchPoint(VertexId v) const { __builtin_prefetch(&history_.points[v]); }
  [[nodiscard]] bool hasRegions() const { return regionField_ != kNoRegions; }
  /// REQUIRES: hasRegions().
  [[nodiscard]] std::int64_t region(CellId c) const {
    const auto& values = history_.values[regionField_];
    return c < values.size() ? values[c] : kOutside;
  }
  /// Two regions meet at v. REQUIRES: hasRegions().
  [[nodiscard]] bool onInterface(VertexId v) const { return onInterface_[v]; }
  /// On the boundary or, where there are regions, between two of them: what the vertex stands for is a surface.
  [[nodiscard]] bool onSurface(VertexId v) const { return onBoundary_[v] || (hasRegions() && onInterface_[v]); }
  /// How far boundary triangle `c` may lie outside the original solid, in lattice steps. REQUIRES: a ghost cell.
  [[nodiscard]] float outside(CellId c) const { return outside_.empty() ? 0 : outside_[c - firstGhost_]; }
  [[nodiscard]] std::size_t liveTetrahedra() const { return liveTetrahedra_; }
  [[nodiscard]] int latticeBits() const { return history_.lattice.bits; }
  [[nodiscard]] std::span<const FieldInfo> fields() const { return history_.fields; }
  [[nodiscard]] std::span<const std::int32_t> values(std::size_t field, VertexId v) const {
    const std::size_t n = history_.fields[field].components;
    return std::span(history_.values[field]).subspan(v * n, n);
  }

  /// Fuses the prey. REQUIRES: legal (FusionTest), `star` the prey's. Returns the fused vertex.
  VertexId fuse(const Prey& prey, const FusedVertex& fused, const Star& star, std::uint32_t level);

  [[nodiscard]] FusionHistory takeHistory(std::uint32_t levels);

 private:
  struct StarRange {
    std::uint64_t first = 0;
    std::uint32_t size = 0;
  };

  void buildStars();
  void findSingular();
  /// How a point lies with respect to the prey, and which prey vertex is to be the first of the record.
  struct Placed {
    Placement placement;
    std::uint8_t first;
  };
  [[nodiscard]] Placed placed(const Prey& prey, const LatticePoint& point) const;
  void record(const Prey& prey, const Placed& placed, const Star& star, std::uint32_t level);
  void removeFromStar(VertexId v, CellId c);
  void compactPool();

  FusionHistory history_;
  void findInterfaces();
  void pushOutside(const Star& star, float outside);

  std::size_t regionField_;
  CellId firstGhost_;
  std::vector<float> outside_;  // by ghost cell; empty while nothing has left the original solid
  std::vector<std::uint8_t> aliveVertex_, onBoundary_, onInterface_, singular_;
  std::vector<StarRange> stars_;
  std::vector<CellId> pool_;  // stars back to back, with holes
  std::size_t livePool_ = 0;
  std::size_t liveTetrahedra_ = 0;
};

}  // namespace qtet
