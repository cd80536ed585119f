// Which prey vertex each cell of a star belongs to: one label a link triangle, in breadth-first order, predicted from the labels of its
// neighbours and from where the prey vertices lie (FORMAT.md, "Label stream"). Integers only, so that every machine predicts alike.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "codec/link.h"
#include "codec/mesh.h"
#include "codec/predicates.h"
#include "codec/range_coder.h"
#include "codec/small_order.h"

namespace qtet {

/// floor(64 * log2(x)) with a linear mantissa; 0 for 0.
[[nodiscard]] inline int log2Fixed(std::uint64_t x) {
  if (x == 0) return 0;
  const int exponent = static_cast<int>(std::bit_width(x)) - 1;
  const std::uint64_t mantissa = exponent >= 6 ? x >> (exponent - 6) : x << (6 - exponent);
  return exponent * 64 + static_cast<int>(mantissa & 63);
}

struct LabelModels {
  // k, rank asked, neighbours coded, agreement of this and of the best other, margin of the distances, vertex agreement, sidedness
  static constexpr std::size_t kContexts = 5 * 3 * 16 * 9 * 5 * 4;
  std::vector<BitModel> model = std::vector<BitModel>(kContexts);
};

template <class Coder>
class LabelCoder {
 public:
  LabelCoder(Coder& coder, LabelModels& models, Link& link, std::span<const LatticePoint> points, int k,
             std::span<const LatticePoint> prey)
      : coder_(coder), models_(models), link_(link), points_(points), k_(static_cast<std::size_t>(k)), prey_(prey) {}

  /// Codes every triangle's label; an encoder's are read from `truth` (one a triangle).
  void code(std::span<const std::uint8_t> truth) {
    counts_.assign(link_.vertices().size(), {});
    for (const std::uint32_t f : link_.traversal()) {
      LinkTriangle& t = link_.triangles()[f];
      score(t);
      t.label = static_cast<std::uint8_t>(choose(t, truth.empty() ? 0 : truth[f]));
      for (const std::uint32_t v : t.vertex) ++counts_[v][t.label];
    }
  }

 private:
  struct Candidate {
    int neighbours = 0;  // triangles across an edge that carry this label
    int shared = 0;      // of the labels round the three corners, in eighths
    int distance = 0;    // log of the squared distance to the triangle
    bool inside = true;  // on the positive side of the triangle: the cell would not be flipped
    int score = 0;
  };

  void score(const LinkTriangle& t) {
    coded_ = 0;
    candidates_.fill({});
    for (const std::uint32_t g : t.neighbour)
      if (const std::uint8_t label = link_.triangles()[g].label; label != kNoLabel) ++coded_, ++candidates_[label].neighbours;
    int total = 0;
    std::array<int, 4> sum{};
    for (const std::uint32_t v : t.vertex)
      for (std::size_t c = 0; c < k_; ++c) sum[c] += counts_[v][c], total += counts_[v][c];
    for (std::size_t c = 0; c < k_; ++c) {
      Candidate& x = candidates_[c];
      x.shared = total ? sum[c] * 8 / total : 0;
      geometry(t, prey_[c], x);
      x.score = (x.inside ? 0 : -4096) + 96 * x.neighbours + 12 * x.shared - x.distance;
    }
  }

  void geometry(const LinkTriangle& t, const LatticePoint& p, Candidate& x) const {
    std::array<std::int64_t, 3> middle{};  // three times the centroid, or three halves of an edge's ends
    std::array<VertexId, 3> corner{};
    for (std::size_t i = 0; i < 3; ++i) corner[i] = link_.vertices()[t.vertex[i]];
    const std::int64_t times = t.ghost ? 2 : 3;
    for (const VertexId v : corner)
      if (v != kGhost)
        for (std::size_t a = 0; a < 3; ++a) middle[a] += points_[v][a];
    std::uint64_t squared = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t d = times * p[a] - middle[a];
      squared += static_cast<std::uint64_t>(d * d);
    }
    x.distance = log2Fixed(squared);
    if (!t.ghost) x.inside = orientation(points_[corner[0]], points_[corner[1]], points_[corner[2]], p) > 0;
  }

  std::size_t choose(const LinkTriangle& t, std::size_t truth) {
    const auto order = smallOrder(k_, [&](std::size_t x, std::size_t y) { return candidates_[x].score > candidates_[y].score; });
    for (std::size_t rank = 0; rank + 1 < k_; ++rank)
      if (coder_.bit(truth == order[rank], context(t, rank, candidates_[order[rank]], candidates_[order[rank + 1]]))) return order[rank];
    return order[k_ - 1];
  }

  BitModel& context(const LinkTriangle& t, std::size_t rank, const Candidate& a, const Candidate& b) {
    const auto clampTo = [](int v, int high) { return static_cast<std::size_t>(std::clamp(v, 0, high)); };
    const std::size_t agreement = static_cast<std::size_t>(a.neighbours) * 4 + static_cast<std::size_t>(b.neighbours);
    const int margin = b.distance - a.distance;
    const std::size_t distance = clampTo((margin + 64 * 2 + 128) / 32, 8);
    const std::size_t shared = clampTo((a.shared - b.shared + 9) / 4, 4);
    const std::size_t side = t.ghost ? 3 : a.inside == b.inside ? 0 : a.inside ? 1 : 2;
    return models_.model[(((((k_ * 3 + rank) * 16 + agreement) * 9 + distance) * 5) + shared) * 4 + side];
  }

  Coder& coder_;
  LabelModels& models_;
  Link& link_;
  std::span<const LatticePoint> points_;
  std::size_t k_;
  std::span<const LatticePoint> prey_;
  int coded_ = 0;
  std::array<Candidate, 4> candidates_{};
  std::vector<std::array<int, 4>> counts_;
};

}  // namespace qtet
