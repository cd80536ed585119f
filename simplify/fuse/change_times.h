// When each vertex was last touched by a fusion. Vertices that a proposal relies on must not be
// touched after it was made, and levels are independent sets.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/coding/prefetch.h"
#include "codec/mesh/mesh.h"

namespace qtet {

/// Times are fusions since the start.
class ChangeTimes {
 public:
  void resize(std::size_t vertices) {
    assert(vertices >= at_.size());
    at_.resize(vertices, 0);
  }
  /// Fusions so far.
  [[nodiscard]] std::uint32_t now() const { return now_; }
  void beginLevel() { levelStart_ = now_; }
  /// The fusion in hand touches v.
  void touch(VertexId v) {
    assert(v < at_.size());
    at_[v] = now_ + 1;
  }
  /// It has touched all that it touches.
  void next() { ++now_; }
  void prefetch(VertexId v) const { qtet::prefetch(&at_[v]); }
  [[nodiscard]] bool since(VertexId v, std::uint32_t fusion) const {
    assert(v < at_.size() && fusion <= now_);
    return at_[v] > fusion;
  }
  /// Whether a fusion of this level has touched it: the vertex waits for the next one.
  [[nodiscard]] bool isLocked(VertexId v) const { return since(v, levelStart_); }

 private:
  std::uint32_t now_ = 0, levelStart_ = 0;
  std::vector<std::uint32_t> at_;
};

}  // namespace qtet
