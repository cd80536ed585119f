// Which prey vertex each cell of a star belongs to: one label a link triangle, in breadth-first order, predicted from the labels given so far and
// from where their triangles lie (FORMAT.md, "Label stream"). Nothing is known yet of where the prey vertices lie: labels help to predict that.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/link.h"
#include "codec/log2_fixed.h"
#include "codec/mesh.h"
#include "codec/range_coder.h"
#include "codec/small_order.h"

namespace qtet {

struct LabelModels {
  // k, rank asked, neighbours that carry this candidate and the next, margin of the distances, margin of the shares round the corners, unseen
  static constexpr std::size_t kContexts = 3 * 3 * 16 * 12 * 5 * 4;
  std::vector<BitModel> model = std::vector<BitModel>(kContexts);
};

/// Labels come in order of first appearance along the traversal.
template <class Coder>
class LabelCoder {
 public:
  LabelCoder(Coder& coder, LabelModels& models, Link& link, int k) : coder_(coder), models_(models), link_(link), k_(static_cast<std::size_t>(k)) {}

  /// Codes every triangle's label; an encoder's are read from `truth` (one a triangle). REQUIRES link placed.
  void code(std::span<const std::uint8_t> truth) {
    counts_.assign(link_.vertices().size(), {});
    for (const std::uint32_t f : link_.traversal()) {
      LinkTriangle& t = link_.triangles()[f];
      const Vector place = link_.sixTimesMiddle(t);
      score(t, place);
      t.label = static_cast<std::uint8_t>(choose(truth.empty() ? 0 : truth[f]));
      for (const std::uint32_t v : t.vertex) ++counts_[v][t.label];
      for (std::size_t a = 0; a < 3; ++a) sum_[t.label][a] += static_cast<double>(place[a]);
      ++seen_[t.label];
    }
  }

 private:
  using Vector = std::array<std::int64_t, 3>;

  struct Candidate {
    int neighbours = 0;  // triangles across an edge that carry this label
    int shared = 0;      // of the labels round the three corners, in eighths
    int distance = 0;    // log of the squared distance to the middle of the triangles that carry it
    int score = 0;
  };

  void score(const LinkTriangle& t, const Vector& place) {
    candidates_.fill({});
    for (const std::uint32_t g : t.neighbour)
      if (const std::uint8_t label = link_.triangles()[g].label; label != kNoLabel) ++candidates_[label].neighbours;
    int total = 0;
    std::array<int, 4> sum{};
    for (const std::uint32_t v : t.vertex)
      for (std::size_t c = 0; c < k_; ++c) sum[c] += counts_[v][c], total += counts_[v][c];
    for (std::size_t c = 0; c < k_; ++c) {
      Candidate& x = candidates_[c];
      x.shared = total ? sum[c] * 8 / total : 0;
      x.distance = distance(c, place);
      x.score = 96 * x.neighbours + 12 * x.shared - x.distance;
    }
  }

  // To the middle of the candidate's triangles; of a candidate without any, to the opposite of all that were labelled.
  [[nodiscard]] int distance(std::size_t c, const Vector& place) const {
    std::array<double, 3> sum = sum_[c];
    double n = seen_[c];
    if (n == 0) {
      for (std::size_t other = 0; other < k_; ++other) {
        n += seen_[other];
        for (std::size_t a = 0; a < 3; ++a) sum[a] -= sum_[other][a];
      }
      if (n == 0) return 0;
    }
    double squared = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = n * static_cast<double>(place[a]) - sum[a];
      squared += d * d;
    }
    return log2Fixed(squared) - 2 * log2Fixed(n);
  }

  std::size_t choose(std::size_t truth) {
    std::size_t candidates = 0;
    while (candidates < k_ && seen_[candidates] > 0) ++candidates;
    candidates = std::min(candidates + 1, k_);
    const auto order = smallOrder(candidates, [&](std::size_t x, std::size_t y) { return candidates_[x].score > candidates_[y].score; });
    for (std::size_t rank = 0; rank + 1 < candidates; ++rank)
      if (coder_.bit(truth == order[rank], context(rank, order[rank], order[rank + 1]))) return order[rank];
    return order[candidates - 1];
  }

  BitModel& context(std::size_t rank, std::size_t first, std::size_t second) {
    const Candidate& a = candidates_[first];
    const Candidate& b = candidates_[second];
    const auto clampTo = [](int v, int high) { return static_cast<std::size_t>(std::clamp(v, 0, high)); };
    const std::size_t agreement = static_cast<std::size_t>(a.neighbours) * 4 + static_cast<std::size_t>(b.neighbours);
    const std::size_t distance = clampTo((b.distance - a.distance + 6 * 32) / 32, 11);
    const std::size_t shared = clampTo((a.shared - b.shared + 9) / 4, 4);
    const std::size_t unseen = (seen_[first] == 0 ? 2u : 0u) + (seen_[second] == 0 ? 1u : 0u);
    return models_.model[((((((k_ - 2) * 3 + rank) * 16 + agreement) * 12 + distance) * 5) + shared) * 4 + unseen];
  }

  Coder& coder_;
  LabelModels& models_;
  Link& link_;
  std::size_t k_;
  std::array<Candidate, 4> candidates_{};
  std::array<std::array<double, 3>, 4> sum_{};  // of the middles, exact: integers below 2^53
  std::array<int, 4> seen_{};
  std::vector<std::array<int, 4>> counts_;
};

}  // namespace qtet
