// When each vertex was last touched by a fusion. Vertices that a proposal relies on must not be
// touched after it was made, and levels are independent sets.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/coding/prefetch.h"
#include "codec/mesh/mesh.h"

namespace qtet {

/// Times are fusions since the start. One thread touches, others may look on. A thread that knows
/// of a fusion (acquired) sees what it changed, and perhaps some of what later ones did.
class ChangeTimes {
 public:
  void resize(std::size_t vertices) { at_.resize(vertices, 0); }
  /// Fusions decided on.
  [[nodiscard]] std::uint32_t now() const { return now_.load(std::memory_order_acquire); }
  /// REQUIRES: no other thread looks on.
  void beginLevel() { levelStart_ = now_.load(std::memory_order_relaxed); }
  /// The fusion that is being decided on touches v.
  void touch(VertexId v) {
    std::atomic_ref(at_[v]).store(now_.load(std::memory_order_relaxed) + 1,
                                  std::memory_order_relaxed);
  }
  /// It is decided on.
  void next() { now_.store(now_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }
  void prefetch(VertexId v) const { qtet::prefetch(&at_[v]); }
  [[nodiscard]] bool since(VertexId v, std::uint32_t fusion) const {
    return std::atomic_ref(at_[v]).load(std::memory_order_relaxed) > fusion;
  }
  /// Whether a fusion of this level has touched it: the vertex waits for the next one.
  [[nodiscard]] bool isLocked(VertexId v) const { return since(v, levelStart_); }

 private:
  std::atomic<std::uint32_t> now_{0};
  std::uint32_t levelStart_ = 0;
  // mutable for atomic_ref, which C++20 has none of for what is const
  mutable std::vector<std::uint32_t> at_;
};

}  // namespace qtet
