// The mesh under simplification: live cells with their ghosts, stars that stay up to date, and the
// history of what was fused.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "codec/coding/prefetch.h"
#include "codec/mesh/mesh.h"
#include "codec/record/fusion_history.h"
#include "simplify/mesh/cell_corners.h"
#include "simplify/mesh/vector3.h"

namespace qtet {

class Workers;

/// The prey of a fusion: k = 4 a tetrahedron, 3 a triangle, 2 an edge.
struct Prey {
  std::uint8_t k = 2;
  std::array<VertexId, 4> vertex{};

  [[nodiscard]] std::span<const VertexId> vertices() const { return {vertex.data(), k}; }
};

/// The cells of a prey's star and the star's other vertices, kGhost among them where the prey
/// touches the boundary.
struct Star {
  std::vector<CellId> affected, deleted;
  std::vector<std::uint8_t> labels;  ///< by affected cell: the index of its prey vertex
  std::vector<VertexId> link;
};

/// The plane of a boundary triangle. Up to 16 bits of lattice the normal is exact.
struct alignas(32) BoundaryPlane {  // in one cache line
  Vector3 normal;                   ///< outward, as long as twice the area
  double inverseLength;             ///< 1 over that, 0 for a triangle without area
};

/// The vertex that a prey becomes.
struct FusedVertex {
  LatticePoint point{};
  /// The integers of every point field, one field after the other.
  std::span<const std::int32_t> values;
};

class FusionMesh {
 public:
  static constexpr std::size_t kNoRegions = ~std::size_t{0};
  /// The region of a ghost cell.
  static constexpr std::int64_t kOutside = std::numeric_limits<std::int64_t>::min();

  /// `regionField`: the cell field of one component whose values are regions to be kept apart.
  /// `workers` share the work and change nothing of its outcome. REQUIRES: a clean mesh (consistent
  /// orientation, no face of three cells) whose boundary is boundaryOf(tetrahedra).
  explicit FusionMesh(const LatticeMesh& mesh, std::size_t regionField = kNoRegions,
                      Workers* workers = nullptr);

  [[nodiscard]] std::size_t vertexSlots() const { return history_.points.size(); }
  [[nodiscard]] bool alive(VertexId v) const {
    assert(v < aliveVertex_.size());
    return aliveVertex_[v];
  }
  [[nodiscard]] bool onBoundary(VertexId v) const {
    assert(v < onBoundary_.size());
    return onBoundary_[v];
  }
  /// Takes these out of all fusions to come, as singular vertices are. REQUIRES: vertices of the
  /// mesh.
  void keep(std::span<const VertexId> vertices);
  /// The link of v is no sphere: the mesh is not a manifold there, or v is kept. V is never prey.
  [[nodiscard]] bool singular(VertexId v) const {
    assert(v < singular_.size());
    return hasSingular_ && singular_[v];
  }
  [[nodiscard]] const LatticePoint& point(VertexId v) const {
    assert(v < vertexSlots());
    return history_.points[v];
  }
  [[nodiscard]] Vector3 position(VertexId v) const { return toVector(history_.points[v]); }
  [[nodiscard]] const std::array<VertexId, 4>& cell(CellId c) const {
    assert(c < history_.cells.size());
    return history_.cells[c];
  }
  [[nodiscard]] std::span<const CellId> star(VertexId v) const {
    assert(v < stars_.size() && stars_[v].ghosts <= stars_[v].size);
    assert(stars_[v].first + stars_[v].size <= pool_.size());
    return std::span(pool_).subspan(stars_[v].first, stars_[v].size);
  }
  /// The ghost cells of v's star, one a boundary triangle; the ghost is their last vertex.
  [[nodiscard]] std::span<const CellId> boundaryStar(VertexId v) const {
    return std::span(pool_).subspan(stars_[v].first, stars_[v].ghosts);
  }
  /// The others.
  [[nodiscard]] std::span<const CellId> innerStar(VertexId v) const {
    return star(v).subspan(stars_[v].ghosts);
  }
  [[nodiscard]] bool isLive(CellId c) const {
    assert(c < history_.live.size());
    return history_.live[c];
  }
  [[nodiscard]] bool isGhost(CellId c) const { return c >= firstGhost_; }
  [[nodiscard]] bool holds(CellId c, VertexId v) const {
    return cornersThatAre(history_.cells[c], v) != 0;
  }
  /// The cells that hold both, boundary triangles among them.
  [[nodiscard]] std::size_t cellsRound(VertexId v, VertexId w) const {
    std::size_t count = 0;
    for (const CellId c : star(v)) count += holds(c, w);
    return count;
  }
  /// Ask the memory for where v's star is, and then for its list.
  void prefetchVertex(VertexId v) const { qtet::prefetch(&stars_[v]); }
  void prefetchList(VertexId v) const {
    const auto cells = star(v);
    qtet::prefetch(cells.data()), qtet::prefetch(cells.data() + cells.size());  // mostly two lines
  }
  /// Asks the memory for the cells of v's star, which lie anywhere: by the time they are read they
  /// are near.
  void prefetchStar(VertexId v) const {
    for (const CellId c : star(v)) qtet::prefetch(&history_.cells[c]);
  }
  /// And for the planes of its boundary triangles.
  void prefetchPlanes(VertexId v) const {
    for (const CellId c : boundaryStar(v)) qtet::prefetch(&planes_[c - firstGhost_]);
  }
  void prefetchPoint(VertexId v) const { qtet::prefetch(&history_.points[v]); }
  [[nodiscard]] bool hasRegions() const { return regionField_ != kNoRegions; }
  /// REQUIRES: hasRegions().
  [[nodiscard]] std::int64_t region(CellId c) const {
    assert(hasRegions());
    assert(c < history_.cells.size());
    const auto& values = history_.values[regionField_];
    return c < values.size() ? values[c] : kOutside;
  }
  /// Two regions meet at v. REQUIRES: hasRegions().
  [[nodiscard]] bool onInterface(VertexId v) const {
    assert(hasRegions());
    return onInterface_[v];
  }
  /// Whether v stands for a surface: it lies on the boundary or, where there are regions, between
  /// two of them.
  [[nodiscard]] bool onSurface(VertexId v) const {
    return onBoundary_[v] || (hasRegions() && onInterface_[v]);
  }
  /// REQUIRES: a ghost cell.
  [[nodiscard]] const BoundaryPlane& plane(CellId c) const {
    assert(isGhost(c));
    assert(c - firstGhost_ < planes_.size());
    return planes_[c - firstGhost_];
  }
  /// Boundary triangles at first: the ghost cells from firstGhost() on.
  [[nodiscard]] std::size_t boundaryTriangles() const { return planes_.size(); }
  [[nodiscard]] CellId firstGhost() const { return firstGhost_; }
  /// Those that were done.
  [[nodiscard]] std::size_t fusions() const { return history_.fusions.size(); }
  [[nodiscard]] std::size_t liveTetrahedra() const { return liveTetrahedra_; }
  [[nodiscard]] const Lattice& lattice() const { return history_.lattice; }
  [[nodiscard]] int latticeBits() const { return history_.lattice.bits; }
  [[nodiscard]] std::span<const FieldInfo> fields() const { return history_.fields; }
  [[nodiscard]] std::span<const std::int32_t> values(std::size_t field, VertexId v) const {
    assert(!isCellField(history_.fields[field]) && v < vertexSlots());
    const std::size_t n = history_.fields[field].components;
    return std::span(history_.values[field]).subspan(v * n, n);
  }

  /// Fuses the prey. REQUIRES: legal (FusionCheck), `star` the prey's. Returns the fused vertex.
  VertexId fuse(const Prey& prey, const FusedVertex& fused, const Star& star, std::uint32_t level);

  [[nodiscard]] FusionHistory takeHistory(std::uint32_t levels);

 private:
  struct StarRange {
    std::uint64_t first = 0;
    std::uint32_t size = 0;
    std::uint32_t ghosts = 0;  // come first
  };

  void reserve(const LatticeMesh& mesh);
  void buildStars();
  void findSingular(Workers* workers);
  /// How a point lies with respect to the prey, and which prey vertex is to be the first of the
  /// record.
  struct Placed {
    Placement placement;
    std::uint8_t first;
  };
  [[nodiscard]] Placed placed(const Prey& prey, const LatticePoint& point) const;
  Fusion& addRecord(const Star& star, std::uint32_t level);
  void fillRecord(Fusion& record, const Prey& prey, const Placed& placed, const Star& star);
  void fuseCells(const Prey& prey, const Star& star, VertexId fused);
  void setValues(VertexId fused, std::span<const std::int32_t> values);
  [[nodiscard]] StarRange addStar(std::uint64_t first, std::span<const CellId> cells);
  void removeFromStar(VertexId v, CellId c);
  [[nodiscard]] std::uint32_t placeInStar(VertexId v, CellId c);
  void moveInStar(VertexId v, std::uint32_t from, std::uint32_t to);
  using Places = std::unordered_map<CellId, std::uint32_t>;
  void compactPool();

  FusionHistory history_;
  void findInterfaces();
  void findPlane(CellId ghost);

  std::size_t regionField_;
  CellId firstGhost_;
  // by ghost cell, kept up to date: asked for a hundred times as often as one changes
  std::vector<BoundaryPlane> planes_;
  std::vector<std::uint8_t> aliveVertex_, onBoundary_, onInterface_, singular_;
  /// A vertex with more cells keeps where each one stands. A search through all of them for every
  /// cell that goes took time in proportion to the square.
  static constexpr std::size_t kHubCells = 1024;
  // no longer kept once a star, which only shrinks, is smaller
  std::unordered_map<VertexId, Places> placesInHub_;
  std::vector<StarRange> stars_;
  std::vector<CellId> pool_;  // stars back to back, with holes
  std::size_t livePool_ = 0;
  bool hasSingular_ = false;  // hardly a mesh does
  std::size_t liveTetrahedra_ = 0;
};

}  // namespace qtet
