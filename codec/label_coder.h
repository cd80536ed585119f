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
#include "codec/mixed_bit.h"
#include "codec/range_coder.h"
#include "codec/small_order.h"
#include "proto/limits.h"

namespace qtet {

static_assert(3 * kMaxLinkTriangles < 1 << 16);
static_assert(kNoLabel % 8 >= 4);

struct LabelModels {
  // Which question it is: k = 2, or the rank asked of three or four candidates.
  static constexpr std::size_t kQuestions = 4;
  // Neighbours that carry this candidate and the next one (4 x 4), and then:
  static constexpr std::size_t kCoarse = 12 * 5 * 4;  // margin of the distances, of the shares round the corners, unseen
  static constexpr std::size_t kFine = 24 * 16;       // margin of the distances, how many triangles carry each
  static constexpr std::size_t kCorners = 64;         // which of the two each corner has met
  static constexpr std::size_t kPlane = 16 * 4 * 4;   // side of and angle to the plane between the two through the fused vertex, how many triangles carry each
  std::vector<BitModel> coarse = std::vector<BitModel>(kQuestions * 16 * kCoarse);
  std::vector<BitModel> fine = std::vector<BitModel>(kQuestions * 16 * kFine);
  std::vector<BitModel> corners = std::vector<BitModel>(kQuestions * 16 * kCorners);
  std::vector<BitModel> plane = std::vector<BitModel>(kQuestions * 16 * kPlane);
  std::array<Mixer<4>, kQuestions * 16> mixer;
};

/// Labels come in order of first appearance along the traversal.
template <class Coder>
class LabelCoder {
 public:
  LabelCoder(Coder& coder, LabelModels& models, Link& link) : coder_(coder), models_(models), link_(link) {}

  /// Codes every triangle's label below k; an encoder's are read from `truth` (one a triangle). REQUIRES link placed, 2 <= k <= 4.
  void code(int k, std::span<const std::uint8_t> truth) {
    if (k == 2)
      codeOf<2>(truth);
    else if (k == 3)
      codeOf<3>(truth);
    else
      codeOf<4>(truth);
  }

 private:
  using Vector = std::array<double, 3>;  // whole numbers, sums of them below 2^53

  struct Candidate {
    int neighbours = 0;  // triangles across an edge that carry this label
    int shared = 0;      // of the labels round the three corners, in eighths
    int distance = 0;    // log of the squared distance to the middle of the triangles that carry it
    int score = 0;
  };

  // How often each label was given, 16 bits each: three times less than kMaxLinkTriangles.
  using Counts = std::uint64_t;
  static constexpr std::array<Counts, 8> kOne{1, Counts{1} << 16, Counts{1} << 32, Counts{1} << 48};  // kNoLabel counts nowhere
  static unsigned of(Counts counts, std::size_t label) { return static_cast<unsigned>(counts >> (16 * label) & 0xFFFF); }

  template <std::size_t K>
  void codeOf(std::span<const std::uint8_t> truth) {
    sum_ = {};
    seen_ = {};
    counts_.assign(link_.vertices().size(), 0);
    for (const std::uint32_t f : link_.traversal()) {
      LinkTriangle& t = link_.triangles()[f];
      const Vector& place = link_.sixTimesMiddles()[f];
      score<K>(t, place);
      t.label = static_cast<std::uint8_t>(choose<K>(t, place, truth.empty() ? 0 : truth[f]));
      for (const std::uint32_t v : t.vertex) counts_[v] += kOne[t.label];
      for (std::size_t a = 0; a < 3; ++a) sum_[t.label][a] += place[a];
      ++seen_[t.label];
    }
  }

  template <std::size_t K>
  void score(const LinkTriangle& t, const Vector& place) {
    Counts corners = 0, neighbours = 0;
    for (const std::uint32_t v : t.vertex) corners += counts_[v];
    for (const std::uint32_t g : t.neighbour) neighbours += kOne[link_.triangles()[g].label % kOne.size()];
    unsigned total = 0;
    for (std::size_t c = 0; c < K; ++c) total += of(corners, c);
    for (std::size_t c = 0; c < K; ++c) {
      Candidate& x = candidates_[c];
      x.neighbours = static_cast<int>(of(neighbours, c));
      x.shared = total ? static_cast<int>(of(corners, c) * 8 / total) : 0;
      x.distance = distance<K>(c, place);
      x.score = 96 * x.neighbours + 12 * x.shared - x.distance;
    }
  }

  // To the middle of the candidate's triangles; of a candidate without any, to the opposite of all that were labelled.
  template <std::size_t K>
  [[nodiscard]] int distance(std::size_t c, const Vector& place) const {
    Vector sum = sum_[c];
    double n = seen_[c];
    if (n == 0) {
      for (std::size_t other = 0; other < K; ++other) {
        n += seen_[other];
        for (std::size_t a = 0; a < 3; ++a) sum[a] -= sum_[other][a];
      }
      if (n == 0) return 0;
    }
    double squared = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = n * place[a] - sum[a];
      squared += d * d;
    }
    return log2Fixed(squared) - 2 * log2Fixed(n);
  }

  template <std::size_t K>
  std::size_t choose(const LinkTriangle& t, const Vector& place, std::size_t truth) {
    std::size_t candidates = 0;
    while (candidates < K && seen_[candidates] > 0) ++candidates;
    candidates = std::min(candidates + 1, K);
    const auto order = smallOrder(candidates, [&](std::size_t x, std::size_t y) { return candidates_[x].score > candidates_[y].score; });
    for (std::size_t rank = 0; rank + 1 < candidates; ++rank)
      if (asks<K>(truth == order[rank], t, place, rank, order[rank], order[rank + 1])) return order[rank];
    return order[candidates - 1];
  }

  template <std::size_t K>
  bool asks(bool truth, const LinkTriangle& t, const Vector& place, std::size_t rank, std::size_t first, std::size_t second) {
    const Candidate& a = candidates_[first];
    const Candidate& b = candidates_[second];
    const auto clampTo = [](int v, int high) { return static_cast<std::size_t>(std::clamp(v, 0, high)); };
    const std::size_t question = K == 2 ? 0 : 1 + rank;
    const std::size_t at = question * 16 + static_cast<std::size_t>(a.neighbours) * 4 + static_cast<std::size_t>(b.neighbours);
    const int margin = b.distance - a.distance;
    const std::size_t shared = clampTo((a.shared - b.shared + 9) / 4, 4);
    const std::size_t unseen = (seen_[first] == 0 ? 2u : 0u) + (seen_[second] == 0 ? 1u : 0u);
    const auto many = [](int n) { return static_cast<std::size_t>((n >= 2) + (n >= 5) + (n >= 10)); };
    std::size_t met = 0;
    for (const std::uint32_t v : t.vertex) met = met * 4 + (of(counts_[v], first) > 0 ? 2u : 0u) + (of(counts_[v], second) > 0 ? 1u : 0u);
    const std::size_t sizes = many(seen_[first]) * 4 + many(seen_[second]);
    const std::array<BitModel*, 4> models{&models_.coarse[at * LabelModels::kCoarse + (clampTo((margin + 6 * 32) / 32, 11) * 5 + shared) * 4 + unseen],
                                          &models_.fine[at * LabelModels::kFine + clampTo((margin + 12 * 16) / 16, 23) * 16 + sizes],
                                          &models_.corners[at * LabelModels::kCorners + met],
                                          &models_.plane[at * LabelModels::kPlane + side(place, first, second) * 16 + sizes]};
    return mixedBit(coder_, truth, models, models_.mixer[at]) != 0;
  }

  // Eight steps of the cosine either side of the plane.
  [[nodiscard]] std::size_t side(const Vector& place, std::size_t first, std::size_t second) const {
    double along = 0, across = 1, length = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const double normal = sum_[first][a] - sum_[second][a];
      along += normal * place[a], across += normal * normal, length += place[a] * place[a];
    }
    const int cosine = log2Fixed(across) + log2Fixed(length) - log2Fixed(along * along);
    const auto step = static_cast<std::size_t>(7 - std::clamp(cosine / 40, 0, 7));
    return along < 0 ? 7 - step : 8 + step;
  }

  Coder& coder_;
  LabelModels& models_;
  Link& link_;
  std::array<Candidate, 4> candidates_{};
  std::array<Vector, 4> sum_{};  // of the middles
  std::array<int, 4> seen_{};
  std::vector<Counts> counts_;  // of the labels at a vertex
};

}  // namespace qtet
