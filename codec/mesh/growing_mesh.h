// The mesh that grows in place, in the refiner and in the encoder's mirror of it. Slots never move,
// an affected cell changes one index, and the stars of all vertices stay up to date (FORMAT.md,
// "Refinement").
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/coding/log2_fixed.h"
#include "codec/coding/prefetch.h"
#include "codec/mesh/deleted_cells.h"
#include "codec/mesh/link.h"
#include "codec/mesh/mesh.h"
#include "codec/mesh/placement.h"
#include "codec/mesh/star_pool.h"

namespace qtet {

/// The even permutation of `cell` that puts its vertex `index` last: the other three are the
/// triangle of its link.
[[nodiscard]] inline std::array<VertexId, 4> withLast(const std::array<VertexId, 4>& cell,
                                                      std::size_t index) {
  static constexpr std::array<std::array<std::uint8_t, 4>, 4> kEven{
      {{1, 3, 2, 0}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 1, 2, 3}}};
  const auto& e = kEven[index];
  return {cell[e[0]], cell[e[1]], cell[e[2]], cell[e[3]]};
}

/// One split as both sides see it.
struct Split {
  int k = 2;
  Placement placement = Placement::kAtPrey;
  /// The prey vertex that the placement is about: kAtPrey, kQuarter.
  int near = 0;
  std::array<LatticePoint, 4> points{};  ///< of the prey vertices; the first keeps the slot
  std::vector<LocalCell> deleted;        ///< the cells that come back, oriented
};

class GrowingMesh {
 public:
  std::vector<LatticePoint> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Triangle> boundary;

  /// The four vertices of a cell; the ghost comes last in a boundary triangle.
  [[nodiscard]] std::array<VertexId, 4> cell(CellRef ref) const {
    if (!(ref & kBoundaryBit)) return tetrahedra[ref];
    const Triangle& t = boundary[ref & ~kBoundaryBit];
    return {t[0], t[1], t[2], kGhost};
  }

  /// Takes points, tetrahedra and boundary as the base mesh. The frozen vertices never split.
  /// REQUIRES: called once, ids in range, coordinates below 2^positionBits.
  void start(int positionBits, std::span<const VertexId> frozen = {});
  /// A hint: reserves memory for `total` slots, so that growing moves nothing. REQUIRES: there is
  /// memory for it (roomFor).
  void reserve(const Slots& total);
  /// Bytes that reserve() takes.
  [[nodiscard]] static std::uint64_t roomFor(const Slots& total);
  /// The slots that the next split fills first.
  [[nodiscard]] Slots next() const {
    return {static_cast<std::uint32_t>(points.size()),
            static_cast<std::uint32_t>(tetrahedra.size()),
            static_cast<std::uint32_t>(boundary.size())};
  }
  /// next() after this split.
  [[nodiscard]] Slots slotsAfter(const Split& split, const Link& link) const;

  /// Frees all present vertices for splitting. REQUIRES: 1 to kMaxLevels, upwards.
  void beginLevel(std::uint32_t level);
  /// The current level.
  [[nodiscard]] std::uint32_t level() const { return level_; }
  /// Vertices that the level may split: those present at its beginning.
  [[nodiscard]] std::uint32_t levelVertices() const { return levelVertices_; }
  [[nodiscard]] bool maysplit(VertexId v) const {
    assert(v < marked_.size());
    return marked_[v] < level_;
  }
  /// A hint: v is one of the next to be asked for.
  void expect(VertexId v) const {
    if (!kPrefetchIsFree || v >= states_.size()) return;
    const State& s = states_[v];
    prefetch(pool_.at(s.first));
    // most stars are longer than a cache line
    prefetch(pool_.at(s.first) + s.size - static_cast<std::uint32_t>(s.size != 0));
  }
  /// A hint: cell(ref) comes soon.
  void expectCell(CellRef ref) const {
    prefetch(ref & kBoundaryBit ? boundary[ref & ~kBoundaryBit].data() : tetrahedra[ref].data());
  }
  /// Tetrahedra by slot, then boundary triangles by slot.
  [[nodiscard]] std::span<const CellRef> star(VertexId v) const {
    assert(v < states_.size());
    return {pool_.at(states_[v].first), states_[v].size};
  }
  /// The other tetrahedron with the face opposite to this corner; nullopt at the boundary.
  /// REQUIRES: a tetrahedron of the mesh, a corner below 4.
  [[nodiscard]] std::optional<CellRef> across(CellRef tetrahedron, std::size_t corner) const;
  /// The star holds a boundary triangle.
  [[nodiscard]] bool onBoundary(VertexId v) const { return states_[v].onBoundary; }
  /// Level at which a vertex got its present position; 0 in the base mesh.
  [[nodiscard]] std::uint32_t born(VertexId v) const {
    assert(states_[v].born <= level_);
    return states_[v].born;
  }
  /// The length of a star's edges: squared lengths along each axis, summed over the edges at v of
  /// its cells. An edge counts once for each of its cells. The unit is 4^spreadShift() squared
  /// lattice steps.
  struct Spread {
    std::array<std::uint64_t, 3> squares{};
    std::uint32_t edges = 0;

    bool operator==(const Spread&) const = default;
    /// 64 times log2 of the mean squared length, at least 0.
    [[nodiscard]] int logMean(std::uint64_t sum) const {
      return std::max(log2Fixed(sum) - log2Fixed(std::uint64_t{edges}), 0);
    }
  };
  [[nodiscard]] const Spread& spread(VertexId v) const { return states_[v].spread; }
  [[nodiscard]] int spreadShift() const { return spreadShift_; }

  /// Builds the link of v into `link`, placed, and marks the star: none of its vertices may split
  /// in this level. False: not one sphere, so that a walk over the link would miss triangles.
  [[nodiscard]] bool enter(VertexId v, Link& link);
  /// Applies a split of v: labels stand in the link's triangles, in star order. REQUIRES: enter(v,
  /// link) was true, and nothing was applied since.
  void apply(VertexId v, const Link& link, const Split& split);

 private:
  static constexpr std::uint16_t kFrozen = 0xFFFF;  // above every level

  struct State {
    Spread spread;
    std::uint32_t first = 0, units = 0, size = 0;  // of the star in the pool
    std::uint16_t born = 0;                        // level
    bool onBoundary = false;
  };

  void add(VertexId v, CellRef cell);
  void mark(VertexId v) { marked_[v] = std::max(marked_[v], static_cast<std::uint16_t>(level_)); }
  void addCell(CellRef cell);
  template <bool kShifted, std::size_t kCorners>
  void measure(std::span<const VertexId, kCorners> corners);
  template <bool kShifted>
  void moveEdges(const Link& link, std::span<const VertexId> prey);
  void moveStar(const Link& link, std::span<const VertexId> prey);
  template <bool kShifted>
  [[nodiscard]] std::uint64_t squared(std::int32_t difference) const {
    const std::int64_t d = kShifted ? difference >> spreadShift_ : difference;
    return static_cast<std::uint64_t>(d * d);
  }
  void makeRoom(State& state, std::uint32_t cells);
  static std::uint64_t starCells(const Slots& total);
  VertexId newVertex();

  std::vector<State> states_;
  // by vertex: the last level in which it was in the star of a split, or kFrozen
  std::vector<std::uint16_t> marked_;
  StarPool pool_;
  // The current split: the star, which corner of each of its cells the fused vertex is, the
  // triangles opposite, and where it was.
  std::vector<CellRef> entered_;
  std::vector<std::uint8_t> places_;
  std::vector<Triangle> turned_;
  LatticePoint fused_{};
  std::uint32_t level_ = 0, levelVertices_ = 0;
  int spreadShift_ = 0;
};

}  // namespace qtet
