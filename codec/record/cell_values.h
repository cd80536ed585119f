// Cell fields: a tetrahedron keeps its value for life, so a chunk brings the values of the
// tetrahedra that it brings (FORMAT.md, "Cell values").
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "codec/mesh/deleted_cells.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/link.h"
#include "codec/mesh/mesh.h"

namespace qtet {

/// For each tetrahedron the earlier ones that its values are predicted from: those that shared a
/// face with it when it came. Takes 16 bytes a tetrahedron for any number of fields. It lets a
/// field lag behind the mesh.
class CellAncestry {
 public:
  /// Adds the base mesh's tetrahedra. REQUIRES: called once and first; four different vertices a
  /// cell.
  void addBase(std::span<const Tetrahedron> tetrahedra);
  /// Adds the tetrahedra among `restored`, what a split whose star and labelled link are given
  /// brings, from slot `first` on. REQUIRES: called for every split.
  void addRestored(std::span<const CellRef> star, const Link& link,
                   std::span<const LocalCell> restored, CellId first);
  /// The earlier tetrahedra that this one's values are predicted from.
  [[nodiscard]] std::span<const CellId> parents(CellId cell) const {
    const std::array<CellId, 4>& known = known_[cell];
    return {known.begin(), std::ranges::find(known, kNone)};
  }
  /// The prediction of a value of tetrahedron `cell`; `at(t)` reads that of an earlier tetrahedron
  /// t; missing values do not count.
  template <class At>
  [[nodiscard]] std::int64_t predict(CellId cell, const At& at) const {
    std::array<std::int64_t, 4> values{};
    std::size_t n = 0;
    for (const CellId t : known_[cell])
      if (t != kNone)
        if (const std::int64_t value = at(t); value != kMissing) values[n++] = value;
    return predictFrom(std::span(values).first(n));
  }
  /// Whether all that the prediction rests on are missing, one of them at least.
  template <class At>
  [[nodiscard]] bool onlyMissing(CellId cell, const At& at) const {
    if (known_[cell][0] == kNone) return false;
    for (const CellId t : known_[cell])
      if (t != kNone && at(t) != kMissing) return false;
    return true;
  }

  /// The lowest value that two of them have (labels), else their mean rounded towards zero (smooth
  /// fields); 0 of none.
  [[nodiscard]] static std::int64_t predictFrom(std::span<const std::int64_t> values);

 private:
  static constexpr CellId kNone = std::numeric_limits<CellId>::max();
  /// A tetrahedron's side of a face at a split: the face's vertices as bits above, which
  /// tetrahedron below; sorting pairs up the two sides.
  using Side = std::uint64_t;

  void addSide(LocalVertex a, LocalVertex b, LocalVertex c, std::size_t tetrahedron);
  void add(CellId cell, CellId earlier);

  std::vector<std::array<CellId, 4>> known_;  // slots of earlier tetrahedra, kNone after the last
  std::vector<Side> sides_;                   // of the split in hand
  std::vector<CellId> atSplit_;               // its tetrahedra, those of the star first
};

}  // namespace qtet
