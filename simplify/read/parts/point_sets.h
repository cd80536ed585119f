// Points of pieces: which are one, and of which piece each is.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// Sets of points that are one, each known by its earliest point.
class PointSets {
 public:
  explicit PointSets(std::size_t points) : parent_(points) {
    std::iota(parent_.begin(), parent_.end(), VertexId{0});
  }
  [[nodiscard]] VertexId find(VertexId v) {
    assert(v < parent_.size());
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void unite(VertexId a, VertexId b) {
    a = find(a), b = find(b);
    assert(parent_[a] == a && parent_[b] == b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<VertexId> parent_;
};

/// The piece of each point. `ends` are behind each piece's last point, and ascend.
class PieceOf {
 public:
  explicit PieceOf(std::span<const VertexId> ends) : ends_(ends) {}
  [[nodiscard]] std::size_t operator()(VertexId v) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(ends_, v) - ends_.begin());
  }

 private:
  std::span<const VertexId> ends_;
};

}  // namespace qtet
