// Small numbers for the vertices of one star: a hash table that is emptied at no cost.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "codec/mesh/mesh.h"

namespace qtet {

class LocalVertices {
 public:
  /// Vertices that fit: more than the stars of a prey have while they have no more than
  /// kMaxStarCells cells (a star of n cells has n / 2 + 2).
  static constexpr std::size_t kMax = 512;

  void clear() {
    base_ += count_;
    count_ = 0;
    if (base_ < std::numeric_limits<std::uint32_t>::max() - kMax) return;
    slots_.fill({});
    base_ = kMax;
  }

  /// Adds vertices one after the other, which is faster than one by one: a loop keeps their number
  /// in a register.
  class Adding {
   public:
    explicit Adding(LocalVertices& all) : all_(all), base_(all.base_), count_(all.count_) {}
    ~Adding() { all_.count_ = count_; }
    Adding(const Adding&) = delete;
    Adding& operator=(const Adding&) = delete;

    /// The number of `v`, in order of first appearance. REQUIRES: fewer than kMax vertices so far,
    /// or v among them.
    [[nodiscard]] std::uint32_t intern(VertexId v) {
      std::size_t at = (v * 0x9E3779B1u) >> (32 - kLogSlots);
      // A slot that an earlier star filled holds a number that is none here. Whether v is new is no
      // branch, since a processor could not foresee it.
      std::uint32_t known = all_.slots_[at].number - base_;
      while ((unsigned{known < count_} & unsigned{all_.slots_[at].id != v}) != 0) [[unlikely]] {
        at = (at + 1) % kSlots;
        known = all_.slots_[at].number - base_;
      }
      const std::uint32_t local = std::min(known, count_);
      assert(local < kMax);
      all_.slots_[at] = {v, base_ + local};
      all_.ids_[count_] = v;
      count_ += local == count_;
      return local;
    }

   private:
    LocalVertices& all_;
    std::uint32_t base_, count_;
  };
  [[nodiscard]] std::uint32_t intern(VertexId v) { return Adding(*this).intern(v); }
  [[nodiscard]] std::span<const VertexId> ids() const { return std::span(ids_).first(count_); }

 private:
  static constexpr int kLogSlots = 10;
  static constexpr std::size_t kSlots = std::size_t{1} << kLogSlots;
  static_assert(kSlots >= 2 * kMax);

  struct Slot {
    VertexId id = 0;
    std::uint32_t number = 0;  // base_ and the local one, when it was written
  };
  std::array<Slot, kSlots> slots_{};
  std::array<VertexId, kMax + 1> ids_{};  // the last is written, not read
  std::uint32_t base_ = kMax, count_ = 0;
};

}  // namespace qtet
