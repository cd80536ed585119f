// Small numbers for the vertices of one star: a hash table that is emptied at no cost.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/mesh.h"

namespace qtet {

class LocalVertices {
 public:
  /// Vertices that fit: more than the stars of a prey have while they have no more than kMostStarCells cells (a star of n cells has n / 2 + 2).
  static constexpr std::size_t kMost = 512;

  void clear() {
    count_ = 0;
    if (++generation_ == 0) {
      slots_.fill({});
      generation_ = 1;
    }
  }
  /// The number of `v`, in order of first appearance. REQUIRES: fewer than kMost vertices so far, or v among them.
  [[nodiscard]] std::uint32_t intern(VertexId v) {
    std::size_t at = (v * 0x9E3779B1u) >> (32 - kLogSlots);
    while (slots_[at].generation == generation_) {
      if (slots_[at].id == v) return slots_[at].local;
      at = (at + 1) % kSlots;
    }
    assert(count_ < kMost);
    slots_[at] = {v, count_, generation_};
    ids_[count_] = v;
    return count_++;
  }
  [[nodiscard]] std::span<const VertexId> ids() const { return std::span(ids_).first(count_); }

 private:
  static constexpr int kLogSlots = 10;
  static constexpr std::size_t kSlots = std::size_t{1} << kLogSlots;
  static_assert(kSlots >= 2 * kMost);

  struct Slot {
    VertexId id = 0;
    std::uint16_t local = 0, generation = 0;
  };
  std::array<Slot, kSlots> slots_{};
  std::array<VertexId, kMost> ids_{};
  std::uint16_t count_ = 0, generation_ = 0;
};

}  // namespace qtet
