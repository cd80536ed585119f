// The mesh under simplification: live cells with their ghosts, stars that stay up to date, and the history of what was fused.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/fusion_history.h"
#include "codec/mesh.h"
#include "simplify/quadric.h"

namespace qtet {

/// The prey of a fusion: k = 4 a tetrahedron, 3 a triangle, 2 an edge.
struct Prey {
  std::uint8_t k = 2;
  std::array<VertexId, 4> vertex{};

  [[nodiscard]] std::span<const VertexId> vertices() const { return {vertex.data(), k}; }
};

/// Where the prey goes: `stays` = index of the prey vertex whose place it takes, or kMoves for a new point.
struct FusionPoint {
  static constexpr int kMoves = -1;
  LatticePoint point{};
  int stays = kMoves;
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
  [[nodiscard]] Vector3 position(VertexId v) const {
    const LatticePoint& p = history_.points[v];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }
  [[nodiscard]] const Quadric& quadric(VertexId v) const { return quadrics_[v]; }
  [[nodiscard]] const std::array<VertexId, 4>& cell(CellId c) const { return history_.cells[c]; }
  [[nodiscard]] std::span<const CellId> star(VertexId v) const { return std::span(pool_).subspan(stars_[v].first, stars_[v].size); }
  [[nodiscard]] std::size_t liveTetrahedra() const { return liveTetrahedra_; }

  /// Fuses the prey at `where`. `affected[i]` keeps its place with its prey vertex `labels[i]` replaced; `deleted` go; `link` are the
  /// star's other vertices. REQUIRES: legal (FusionTest). Returns the fused vertex.
  VertexId fuse(const Prey& prey, const FusionPoint& where, std::span<const CellId> affected, std::span<const std::uint8_t> labels,
                std::span<const CellId> deleted, std::span<const VertexId> link, std::uint32_t level);

  [[nodiscard]] FusionHistory takeHistory(std::uint32_t levels);

 private:
  struct Star {
    std::uint64_t first = 0;
    std::uint32_t size = 0;
  };

  void buildStars();
  void findSingular();
  void buildQuadrics(std::size_t tetrahedra);
  void blendValues(const Prey& prey, const FusionPoint& where);
  void compactPool();

  FusionHistory history_;
  std::vector<std::uint8_t> aliveVertex_, onBoundary_, singular_;
  std::vector<Quadric> quadrics_;
  std::vector<Star> stars_;
  std::vector<CellId> pool_;  // stars back to back, with holes
  std::size_t livePool_ = 0;
  std::size_t liveTetrahedra_ = 0;
};

}  // namespace qtet
