// Memory for the stars of a growing mesh. Runs of cells are released and reused while vertices
// split, without a call to the allocator.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace qtet {

/// A cell of a star: a tetrahedron's slot, or kBoundaryBit | a boundary triangle's slot.
using CellRef = std::uint32_t;
inline constexpr CellRef kBoundaryBit = 0x80000000u;

/// Runs are whole units of kUnit cells, named by the unit that they begin with. A released run
/// serves a later request, cut to its size.
class StarPool {
 public:
  static constexpr std::uint32_t kUnit = 8;
  /// Units that hold `cells` cells, at least 1.
  [[nodiscard]] static std::uint32_t unitsFor(std::uint32_t cells) { return cells / kUnit + 1; }

  /// The first unit of a run. REQUIRES units > 0.
  [[nodiscard]] std::uint32_t take(std::uint32_t units) {
    assert(units > 0);
    // One of that size, or two or more: cutting less off would leave pieces that nobody can use.
    for (std::uint32_t size = units;
         size < std::min<std::size_t>(free_.size(), units + kMaxTooLong + 1); ++size) {
      if (free_[size] == kNone || (size > units && size < 2 * units)) continue;
      const std::uint32_t first = free_[size];
      free_[size] = *at(first);
      if (size > units) give(first + units, size - units);
      return first;
    }
    const auto first = static_cast<std::uint32_t>(cells_.size() / kUnit);
    cells_.resize(cells_.size() + std::size_t{units} * kUnit);
    return first;
  }
  /// Releases a run. REQUIRES taken with `units` units, and not released yet.
  void give(std::uint32_t first, std::uint32_t units) {
    assert(units > 0 && (std::size_t{first} + units) * kUnit <= cells_.size());
    if (free_.size() <= units) free_.resize(units + 1, kNone);
    *at(first) = free_[units];
    free_[units] = first;
  }
  [[nodiscard]] CellRef* at(std::uint32_t unit) {
    return cells_.data() + std::size_t{unit} * kUnit;
  }
  [[nodiscard]] const CellRef* at(std::uint32_t unit) const {
    return cells_.data() + std::size_t{unit} * kUnit;
  }
  void reserve(std::size_t cells) { cells_.reserve(cells); }

 private:
  // units by which a run may be longer than asked for, to be cut in two
  static constexpr std::uint32_t kMaxTooLong = 8;
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  std::vector<CellRef> cells_;
  // by units: the first of a chain of runs, each of which begins with the next
  std::vector<std::uint32_t> free_;
};

}  // namespace qtet
