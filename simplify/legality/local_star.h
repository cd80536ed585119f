// The star of a prey in numbers of its own: what the checks of topology and shape read.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>

#include "simplify/legality/fixed_list.h"
#include "simplify/legality/local_vertices.h"
#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

/// Cells in the stars of a prey beyond which a fusion is not tried. A hub of a graded mesh would
/// make every fusion near it expensive.
inline constexpr std::size_t kMaxStarCells = 800;

/// Cells in the stars of the prey's vertices, all together: one of two stars counts twice.
[[nodiscard]] inline std::size_t starCellsOf(const FusionMesh& mesh, const Prey& prey) {
  std::size_t cells = 0;
  for (const VertexId v : prey.vertices()) cells += mesh.star(v).size();
  return cells;
}

class LocalStar {
 public:
  using Local = std::uint32_t;  // place of a vertex in vertices()

  explicit LocalStar(const FusionMesh& mesh) : mesh_(mesh) {}

  /// Collects the star. False when that already rules the fusion out. REQUIRES: the stars of the
  /// prey's vertices have kMaxStarCells cells at most, all together.
  [[nodiscard]] bool gather(const Prey& prey);

  [[nodiscard]] const Prey& prey() const { return prey_; }
  [[nodiscard]] const Star& star() const { return star_; }
  /// The same for good: until the next gather there is none here.
  void takeStar(Star& star) { std::swap(star_, star); }

  /// The prey's, then those of the link.
  [[nodiscard]] std::span<const VertexId> vertices() const { return vertices_.ids(); }
  /// The affected cells, the prey vertex last.
  [[nodiscard]] std::span<const std::array<Local, 4>> turned() const {
    return std::span(turned_).first(star_.affected.size());
  }
  /// The affected cells that are no ghosts: places in star().affected.
  [[nodiscard]] std::span<const std::uint32_t> inner() const { return inner_.all(); }
  /// The deleted cells that are no ghosts.
  [[nodiscard]] std::span<const std::array<Local, 4>> innerDeleted() const {
    return innerDeleted_.all();
  }
  /// The edges opposite the prey in the deleted cells. REQUIRES: prey().k == 2.
  [[nodiscard]] std::span<const std::array<Local, 2>> ring() const {
    assert(prey_.k == 2);
    return std::span(ring_).first(star_.deleted.size());
  }
  struct Counts {
    std::size_t vertices = 0, affected = 0;
  };
  /// The counts of the first prey vertex' star; those that only the second one's star has come
  /// after them.
  /// REQUIRES: prey().k == 2.
  [[nodiscard]] const Counts& ofFirst() const {
    assert(prey_.k == 2);
    return ofFirst_;
  }

 private:
  template <std::uint32_t k>
  [[nodiscard]] bool addStars();
  void addAffected(std::size_t before, std::uint32_t from);
  template <std::uint32_t k>
  [[nodiscard]] bool addDeleted(std::span<const CellId> cells);

  template <class T>
  using ByCell = std::array<T, kMaxStarCells>;

  const FusionMesh& mesh_;
  Prey prey_;
  Star star_;
  LocalVertices vertices_;
  ByCell<std::array<Local, 4>> turned_;
  ByCell<std::array<Local, 2>> ring_;
  FixedList<std::uint32_t, kMaxStarCells> inner_;
  FixedList<std::array<Local, 4>, kMaxStarCells> innerDeleted_;
  Counts ofFirst_;
};

/// Which of the prey's first k vertices cell `c` has, one bit each.
template <std::uint32_t k>
[[nodiscard]] inline std::uint32_t sideOf(const FusionMesh& mesh, const Prey& prey, CellId c) {
  std::uint32_t side = 0;
  for (std::uint32_t i = 0; i < k; ++i) side |= std::uint32_t{mesh.holds(c, prey.vertex[i])} << i;
  return side;
}

}  // namespace qtet
