#include "simplify/parts/mesh_part.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "codec/mesh/boundary.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {
namespace {

/// The part as a mesh, in numbers of its own.
class PartMesh {
 public:
  PartMesh(const FusionMesh& whole, std::span<const CellId> cells, std::size_t regionField,
           PartNumbers& numbers)
      : whole_(whole), cells_(cells.begin(), cells.end()) {
    assert(numbers.size() >= whole.vertexSlots());
    takeVertices(numbers);
    lattice_.lattice = whole.lattice();
    for (const VertexId v : vertices_) lattice_.points.push_back(whole.point(v));
    for (const CellId c : cells) {
      assert(whole.isLive(c) && !whole.isGhost(c));
      Tetrahedron own;
      for (std::size_t i = 0; i < own.size(); ++i) own[i] = numbers[whole.cell(c)[i]];
      lattice_.tetrahedra.push_back(own);
    }
    lattice_.boundary = boundaryOf(lattice_.tetrahedra);
    for (const Triangle& t : lattice_.boundary) cells_.push_back(ghostOf(t));
    assert(cells_.size() == lattice_.tetrahedra.size() + lattice_.boundary.size());
    takeValues(regionField);
    for (const VertexId v : vertices_) numbers[v] = kGhost;
  }

  [[nodiscard]] const LatticeMesh& lattice() const { return lattice_; }
  [[nodiscard]] const std::vector<VertexId>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<CellId>& cells() const { return cells_; }

 private:
  void takeVertices(PartNumbers& numbers) {
    for (const CellId c : cells_)
      for (const VertexId v : whole_.cell(c))
        if (std::exchange(numbers[v], 0) == kGhost) vertices_.push_back(v);
    std::ranges::sort(vertices_);
    for (VertexId i = 0; i < vertices_.size(); ++i) numbers[vertices_[i]] = i;
  }

  /// The whole's boundary triangle of these corners, or kNoCell.
  [[nodiscard]] CellId ghostOf(const Triangle& own) const {
    const std::array<VertexId, 3> corners{vertices_[own[0]], vertices_[own[1]], vertices_[own[2]]};
    // a hub has very many of them
    const auto ghosts = whole_.boundaryStar(
        std::ranges::min(corners, {}, [&](VertexId v) { return whole_.boundaryStar(v).size(); }));
    const auto found = std::ranges::find_if(ghosts, [&](CellId ghost) {
      return std::ranges::all_of(corners, [&](VertexId v) { return whole_.holds(ghost, v); });
    });
    return found == ghosts.end() ? kNoCell : *found;
  }

  /// Without cell fields but that of regions: no other one counts while cells are fused.
  void takeValues(std::size_t regionField) {
    lattice_.fields.assign(whole_.fields().begin(), whole_.fields().end());
    lattice_.values.resize(lattice_.fields.size());
    for (std::size_t f = 0; f < lattice_.fields.size(); ++f) {
      std::vector<std::int32_t>& values = lattice_.values[f];
      if (!isCellField(lattice_.fields[f])) {
        for (const VertexId v : vertices_)
          for (const std::int32_t x : whole_.values(f, v)) values.push_back(x);
      } else if (f == regionField) {
        for (std::size_t t = 0; t < lattice_.tetrahedra.size(); ++t)
          values.push_back(static_cast<std::int32_t>(whole_.region(cells_[t])));
      }
    }
  }

  const FusionMesh& whole_;
  std::vector<VertexId> vertices_;
  std::vector<CellId> cells_;
  LatticeMesh lattice_;
};

}  // namespace

PartFusions fusePart(const FusionState& whole, const FusionFrame& frame,
                     const FusionOptions& options, std::span<const CellId> cells,
                     std::span<const std::uint8_t> isSeam, const PartEnd& end,
                     PartNumbers& numbers) {
  const std::size_t regionField = options.regionField.value_or(FusionMesh::kNoRegions);
  const PartMesh part(whole.mesh(), cells, regionField, numbers);
  PartFusions out;
  out.vertices = part.vertices();
  out.cells = part.cells();
  std::vector<double> quadrics;
  std::vector<VertexId> kept;
  std::vector<std::uint8_t> isOwnSeam;
  for (const VertexId v : out.vertices) {
    assert(whole.mesh().alive(v) && v < isSeam.size());
    const auto quadric = whole.cost().quadric(v);
    quadrics.insert(quadrics.end(), quadric.begin(), quadric.end());
    isOwnSeam.push_back(isSeam[v]);
    if (isSeam[v] || whole.mesh().singular(v))
      kept.push_back(static_cast<VertexId>(isOwnSeam.size() - 1));
  }
  FusionState state(part.lattice(), regionField, whole.cost().frame(), quadrics);
  state.keep(kept);
  FusionOptions own = options;
  own.progress = {};
  own.kept.clear();
  Workers alone(1, options.stop);
  out.done = FusionLoop(state, frame, own, alone).runPart(end, {.isSeam = isOwnSeam});
  assert(state.mesh().fusions() == out.done.wentOutside.size());
  out.history = state.takeHistory(static_cast<std::uint32_t>(out.done.levels.size()));
  return out;
}

}  // namespace qtet
