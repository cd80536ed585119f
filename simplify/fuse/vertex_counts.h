// How many cells of a star hold each of its vertices: a hash table that holds one star's.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "codec/mesh/mesh.h"

namespace qtet {

class VertexCounts {
 public:
  /// Vertices that fit, as LocalVertices' (local_vertices.h).
  static constexpr std::size_t kMax = 512;

  VertexCounts() { slots_.fill({kGhost, 0}); }

  /// Counts `v` once more; true the first time. REQUIRES: not kGhost; fewer than kMax vertices so
  /// far, or v among them.
  bool add(VertexId v) {
    assert(v != kGhost);
    std::size_t at = (v * 0x9E3779B1u) >> (32 - kLogSlots);
    for (; slots_[at].vertex != v; at = (at + 1) % kSlots) {
      if (slots_[at].vertex != kGhost) continue;
      assert(count_ < kMax);
      slots_[at] = {v, 1};
      taken_[count_++] = static_cast<std::uint16_t>(at);
      return true;
    }
    ++slots_[at].count;
    return false;
  }
  /// How many vertices came.
  [[nodiscard]] std::size_t size() const { return count_; }
  /// Calls visit(vertex, count) in order of first appearance, and forgets them.
  template <class Visit>
  void take(const Visit& visit) {
    for (std::size_t i = 0; i < count_; ++i) {
      Slot& slot = slots_[taken_[i]];
      visit(slot.vertex, slot.count);
      slot.vertex = kGhost;
    }
    count_ = 0;
  }

 private:
  static constexpr int kLogSlots = 10;
  static constexpr std::size_t kSlots = std::size_t{1} << kLogSlots;
  static_assert(kSlots >= 2 * kMax);

  struct Slot {
    VertexId vertex;  // kGhost: free
    std::uint32_t count;
  };
  std::array<Slot, kSlots> slots_;
  std::array<std::uint16_t, kMax> taken_{};
  std::size_t count_ = 0;
};

}  // namespace qtet
