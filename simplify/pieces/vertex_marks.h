// Which vertices of the input were met, and which of them in several pieces.
#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <vector>

#include "simplify/blocks/mesh_piece.h"

namespace qtet {

/// Two bits a vertex. Vertices that splitting has added are within their cell, and so in one piece.
class VertexMarks {
 public:
  explicit VertexMarks(std::uint64_t points)
      : points_(points), met_(points / 64 + 1), several_(points / 64 + 1) {}

  /// In one more piece.
  void meet(WholeVertex v) {
    if (v >= points_) {
      ++added_;
      return;
    }
    if (isSet(met_, v)) several_[v / 64] |= bit(v);
    met_[v / 64] |= bit(v);
  }
  /// `v` turns out to be the vertex `into`.
  void join(WholeVertex v, WholeVertex into) {
    met_[v / 64] &= ~bit(v);
    several_[into / 64] |= bit(into);
  }
  [[nodiscard]] bool isShared(WholeVertex v) const { return v < points_ && isSet(several_, v); }
  [[nodiscard]] bool isMet(WholeVertex v) const { return v >= points_ || isSet(met_, v); }
  /// Vertices that were met, once each.
  [[nodiscard]] std::uint64_t count() const { return added_ + metPoints(); }
  /// Without those that splitting has added.
  [[nodiscard]] std::uint64_t metPoints() const {
    std::uint64_t out = 0;
    for (const std::uint64_t word : met_) out += static_cast<std::uint64_t>(std::popcount(word));
    return out;
  }

 private:
  static std::uint64_t bit(WholeVertex v) { return std::uint64_t{1} << (v % 64); }
  static bool isSet(const std::vector<std::uint64_t>& bits, WholeVertex v) {
    return (bits[v / 64] & bit(v)) != 0;
  }

  std::uint64_t points_, added_ = 0;
  std::vector<std::uint64_t> met_, several_;
};

}  // namespace qtet
