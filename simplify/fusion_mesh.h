// The mesh under simplification: live cells with their ghosts, stars that stay up to date, and the history of what was fused.
#pragma once

#include <array>
#include <cstdint>
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

[[nodiscard]] inline Vector3 toVector(const LatticePoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// The cells of a prey's star and the star's other vertices, kGhost among them where the prey touches the boundary.
struct Star {
  std::vector<CellId> affected, deleted;
  std::vector<std::uint8_t> labels;  ///< by affected cell: the index of its prey vertex
  std::vector<VertexId> link;
};

class FusionMesh {
 public:
  /// REQUIRES: a clean mesh (consistent orientation, no face of three cells) whose boundary is boundaryOf(tetrahedra).
  explicit FusionMesh(const LatticeMesh& mesh);

  [[nodiscard]] std::size_t vertexSlots() const { return history_.points.size(); }
  [[nodiscard]] bool alive(VertexId v) const { return aliveVertex_[v]; }
  [[nodiscard]] bool onBoundary(VertexId v) const { return onBoundary_[v]; }
  /// The link of v is no sphere: the mesh is not a manifold there, and v is never prey.
  [[nodiscard]] bool singular(VertexId v) const { return singular_[v]; }
  [[nodiscard]] const LatticePoint& point(VertexId v) const { return history_.points[v]; }
  [[nodiscard]] Vector3 position(VertexId v) const { return toVector(history_.points[v]); }
  [[nodiscard]] const std::array<VertexId, 4>& cell(CellId c) const { return history_.cells[c]; }
  [[nodiscard]] std::span<const CellId> star(VertexId v) const { return std::span(pool_).subspan(stars_[v].first, stars_[v].size); }
  /// Asks the memory for the cells of v's star, which lie anywhere: by the time they are read they are near.
  void prefetchStar(VertexId v) const {
    for (const CellId c : star(v)) __builtin_prefetch(&history_.cells[c]);
  }
  void prefetchPoint(VertexId v) const { __builtin_prefetch(&history_.points[v]); }
  [[nodiscard]] std::size_t liveTetrahedra() const { return liveTetrahedra_; }
  [[nodiscard]] int latticeBits() const { return history_.lattice.bits; }
  [[nodiscard]] std::span<const FieldInfo> fields() const { return history_.fields; }
  [[nodiscard]] std::span<const std::int32_t> values(std::size_t field, VertexId v) const {
    const std::size_t n = history_.fields[field].components;
    return std::span(history_.values[field]).subspan(v * n, n);
  }

  /// Fuses the prey at `point` with `values`, the integers of every point field one after the other. REQUIRES: legal (FusionTest), `star`
  /// the prey's. Returns the fused vertex.
  VertexId fuse(const Prey& prey, const LatticePoint& point, std::span<const std::int32_t> values, const Star& star, std::uint32_t level);

  [[nodiscard]] FusionHistory takeHistory(std::uint32_t levels);

 private:
  struct StarRange {
    std::uint64_t first = 0;
    std::uint32_t size = 0;
  };

  void buildStars();
  void findSingular();
  [[nodiscard]] int preyAt(const Prey& prey, const LatticePoint& point, std::span<const std::int32_t> values) const;
  void record(const Prey& prey, int stays, const Star& star, std::uint32_t level);
  void removeFromStar(VertexId v, CellId c);
  void compactPool();

  FusionHistory history_;
  std::vector<std::uint8_t> aliveVertex_, onBoundary_, singular_;
  std::vector<StarRange> stars_;
  std::vector<CellId> pool_;  // stars back to back, with holes
  std::size_t livePool_ = 0;
  std::size_t liveTetrahedra_ = 0;
};

}  // namespace qtet
