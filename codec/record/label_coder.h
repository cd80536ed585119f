// Codes which prey vertex each cell of a star belongs to: one label a link triangle, in
// breadth-first order (FORMAT.md, "Label stream"). A label is predicted from the earlier labels and
// from where their triangles lie. The places of the prey vertices are not known yet: labels help to
// predict them.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "codec/coding/log2_fixed.h"
#include "codec/coding/mixed_bit.h"
#include "codec/coding/pair.h"
#include "codec/coding/range_coder.h"
#include "codec/coding/small_order.h"
#include "codec/mesh/link.h"
#include "codec/mesh/mesh.h"
#include "proto/limits.h"

namespace qtet {

static_assert(3 * kMaxLinkTriangles < 1 << 16 && kMaxLinkTriangles <= 1 << 15);
static_assert(kNoLabel % 8 >= 4);

struct LabelModels {
  // Which question it is: k = 2, or the rank asked of three or four candidates.
  static constexpr std::size_t kQuestions = 4;
  // Neighbours that carry this candidate and the next one (4 x 4), and then:
  // margin of the distances, of the shares round the corners, unseen
  static constexpr std::size_t kCoarse = 12 * 5 * 4;
  // margin of the distances, how many triangles carry each
  static constexpr std::size_t kFine = 24 * 16;
  static constexpr std::size_t kCorners = 64;  // which of the two each corner has met
  // side of and angle to the plane between the two through the fused vertex, how many triangles
  // carry each
  static constexpr std::size_t kPlane = 16 * 4 * 4;
  /// Beside each other, since a decision asks one of each kind.
  struct Place {
    std::array<BitModel, kCoarse> coarse;
    std::array<BitModel, kFine> fine;
    std::array<BitModel, kCorners> corners;
    std::array<BitModel, kPlane> plane;
    Mixer<4> mixer;
  };
  std::vector<Place> places = std::vector<Place>(kQuestions * 16);
};

/// Labels come in order of first appearance along the traversal. Three in ten instructions of a
/// decoder are spent here: sums and distances of two candidates at a time.
template <class Coder>
class LabelCoder {
 public:
  LabelCoder(Coder& coder, LabelModels& models, Link& link)
      : coder_(coder), models_(models), link_(link) {}

  /// Codes every triangle's label below k; an encoder's are read from `truth` (one a triangle).
  /// REQUIRES link placed, 2 <= k <= 4.
  void code(int k, std::span<const std::uint8_t> truth) {
    assert(k >= 2 && k <= 4);
    if (k == 2)
      codeOf<2>(truth);
    else if (k == 3)
      codeOf<3>(truth);
    else
      codeOf<4>(truth);
  }

 private:
  using PairBits [[gnu::vector_size(16)]] = std::uint64_t;
  static constexpr std::size_t kPairs = 2;
  using Numbers = std::array<Pair, kPairs>;  // one of each label
  static double of(const Numbers& numbers, std::size_t label) {
    return numbers[label / 2][label % 2];
  }
  static constexpr std::array<Numbers, 4> kOnly{{{Pair{1, 0}, Pair{0, 0}},
                                                 {Pair{0, 1}, Pair{0, 0}},
                                                 {Pair{0, 0}, Pair{1, 0}},
                                                 {Pair{0, 0}, Pair{0, 1}}}};

  /// The scores of every candidate label for the current triangle, and their parts.
  struct Candidates {
    std::array<int, 4> neighbours{};  // triangles across an edge that carry this label
    std::array<int, 4> shared{};      // of the labels round the three corners, in eighths
    // log of the squared distance to the middle of the triangles that carry it
    std::array<int, 4> distance{};
    std::array<int, 4> score{};
    // 16 bits a label: the highest, third and fifth highest say whether the first, second and third
    // corner has met it
    Link::LabelCounts met = 0;
  };

  // One triangle of a label among the three across the edges, 8 bits a label; kNoLabel counts
  // nowhere.
  static constexpr std::array<std::uint32_t, 8> kOne{1, 1 << 8, 1 << 16, 1 << 24};
  // floor(x / n) = x * kInverse[n] >> 16 for x <= 8 n, n < 64.
  static constexpr auto kInverse = [] {
    std::array<std::uint32_t, 64> out{};
    for (std::uint32_t n = 1; n < out.size(); ++n) out[n] = 65536 / n + 1;
    return out;
  }();

  template <std::size_t K>
  void codeOf(std::span<const std::uint8_t> truth) {
    sum_ = {}, from_ = {}, all_ = {};
    carried_ = {}, count_ = {}, logCount_ = {}, many_ = {};
    labels_ = triangles_ = 0;
    const std::span<const std::uint32_t> order = link_.traversal();
    give<K>(order[0], 0);
    for (const std::uint32_t f : order.subspan(1)) {
      const LinkTriangle& t = link_.triangles()[f];
      const Link::Middle& middle = link_.middles()[f];
      give<K>(f, choose<K>(score<K>(t, middle), middle, Coder::kEncoding ? truth[f] : 0));
    }
  }

  // The triangle counts with its label; and what no label has yet is looked for opposite to all.
  template <std::size_t K>
  void give(std::uint32_t f, std::size_t label) {
    link_.label(f, static_cast<unsigned>(label));
    const std::array<double, 3>& place = link_.middles()[f].place;
    labels_ = std::max(labels_, label + 1);
    for (std::size_t h = 0; h < (K + 1) / 2; ++h) {
      const Pair one = kOnly[label][h];
      for (std::size_t a = 0; a < 3; ++a) from_[a][h] = sum_[a][h] += one * place[a];
      count_[h] = carried_[h] += one;
    }
    const double n = of(carried_, label);
    logCount_[label] = 2 * log2Fixed(n);
    many_[label] = (n >= 2) + (n >= 5) + (n >= 10);
    if (labels_ < K) expectNext<K>(place);
  }

  // Prepares the figures of the next new label, while there is one.
  template <std::size_t K>
  void expectNext(const std::array<double, 3>& place) {
    ++triangles_;
    const auto triangles = static_cast<double>(triangles_);
    for (std::size_t a = 0; a < 3; ++a) all_[a] += place[a];
    for (std::size_t h = 0; h < (K + 1) / 2; ++h) {
      const Pair other = kOnly[labels_][h];
      for (std::size_t a = 0; a < 3; ++a) from_[a][h] = sum_[a][h] - other * all_[a];
      count_[h] = carried_[h] + other * triangles;
    }
    logCount_[labels_] = 2 * log2Fixed(triangles);
  }

  template <std::size_t K>
  [[nodiscard]] Candidates score(const LinkTriangle& t, const Link::Middle& middle) const {
    Candidates x;
    Link::LabelCounts corners = 0;
    std::uint32_t neighbours = 0, total = 0;
    // Each label's 16 bits pass 2^15 if it is there at all.
    constexpr Link::LabelCounts kAlmost = 0x7FFF7FFF7FFF7FFFu, kThere = ~kAlmost;
    for (std::size_t i = 0; i < 3; ++i) {
      const Link::LabelCounts round = link_.labelsRound(t.vertex[i]);
      corners += round;
      x.met |= ((round + kAlmost) & kThere) >> (2 * i);
    }
    for (const std::uint32_t g : t.neighbour)
      neighbours += kOne[link_.triangles()[g].label % kOne.size()];
    for (std::size_t c = 0; c < K; ++c) total += Link::countOf(corners, c);
    for (std::size_t c = 0; c < K; ++c) {
      const std::uint32_t eighths = Link::countOf(corners, c) * 8;
      x.neighbours[c] = static_cast<int>(neighbours >> (8 * c) & 0xFF);
      x.shared[c] = static_cast<int>(total < kInverse.size() ? eighths * kInverse[total] >> 16
                                                             : eighths / total);
    }
    for (std::size_t h = 0; h < (K + 1) / 2; ++h) {
      Pair squared{};
      for (std::size_t a = 0; a < 3; ++a) {
        const Pair d = count_[h] * middle.place[a] - from_[a][h];
        squared += d * d;
      }
      squared = squared < 1 ? Pair{1, 1} : squared;  // whose log is 0
      PairBits bits;
      std::memcpy(&bits, &squared, sizeof bits);
      bits >>= 46;
      x.distance[2 * h] = static_cast<int>(bits[0]) - (1023 << 6) - logCount_[2 * h];
      x.distance[2 * h + 1] = static_cast<int>(bits[1]) - (1023 << 6) - logCount_[2 * h + 1];
    }
    for (std::size_t c = 0; c < K; ++c)
      x.score[c] = 96 * x.neighbours[c] + 12 * x.shared[c] - x.distance[c];
    return x;
  }

  template <std::size_t K>
  std::size_t choose(const Candidates& x, const Link::Middle& middle, std::size_t truth) {
    if constexpr (K == 2) {
      const auto first = static_cast<std::size_t>(x.score[1] > x.score[0]);
      return first ^
             static_cast<std::size_t>(!asks<K>(truth == first, x, middle, 0, first, 1 - first));
    }
    const std::size_t candidates = std::min(labels_ + 1, K);
    const auto order = smallOrder(
        candidates, [&](std::size_t a, std::size_t b) { return x.score[a] > x.score[b]; });
    for (std::size_t rank = 0; rank + 1 < candidates; ++rank)
      if (asks<K>(truth == order[rank], x, middle, rank, order[rank], order[rank + 1]))
        return order[rank];
    return order[candidates - 1];
  }

  // Selects a candidate's number. Between two candidates it uses neither a branch, which nobody
  // could predict, nor memory.
  template <std::size_t K>
  static int of(const std::array<int, 4>& numbers, std::size_t candidate) {
    if constexpr (K == 2)
      return numbers[0] ^ ((numbers[0] ^ numbers[1]) & -static_cast<int>(candidate));
    return numbers[candidate];
  }

  template <std::size_t K>
  bool asks(bool truth, const Candidates& x, const Link::Middle& middle, std::size_t rank,
            std::size_t a, std::size_t b) {
    const auto clampTo = [](int v, int high) {
      return static_cast<std::size_t>(std::clamp(v, 0, high));
    };
    const std::size_t question = K == 2 ? 0 : 1 + rank;
    LabelModels::Place& place =
        models_.places[question * 16 + static_cast<std::size_t>(of<K>(x.neighbours, a) * 4 +
                                                                of<K>(x.neighbours, b))];
    const int margin = of<K>(x.distance, b) - of<K>(x.distance, a) + 192;
    const auto shared = static_cast<std::size_t>((of<K>(x.shared, a) - of<K>(x.shared, b) + 9) / 4);
    const std::size_t unseen =
        static_cast<std::size_t>(a >= labels_) * 2 + static_cast<std::size_t>(b >= labels_);
    const std::size_t met =
        (x.met >> (16 * a + 10) & 0b101010) | (x.met >> (16 * b + 11) & 0b010101);
    const auto sizes = static_cast<std::size_t>(of<K>(many_, a) * 4 + of<K>(many_, b));
    const std::array<BitModel*, 4> models{
        &place.coarse[(clampTo(margin >> 5, 11) * 5 + shared) * 4 + unseen],
        &place.fine[clampTo(margin >> 4, 23) * 16 + sizes], &place.corners[met],
        &place.plane[side(middle, a, b) * 16 + sizes]};
    return mixedBit(coder_, truth, models, place.mixer) != 0;
  }

  // Eight steps of the cosine either side of the plane.
  [[nodiscard]] std::size_t side(const Link::Middle& middle, std::size_t first,
                                 std::size_t second) const {
    double along = 0, across = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const double normal = of(sum_[a], first) - of(sum_[a], second);
      along += normal * middle.place[a], across += normal * normal;
    }
    const int cosine = log2Fixed(across) + middle.logSquare - log2Fixed(along * along);
    const auto step = static_cast<std::size_t>(7 - std::clamp(cosine / 40, 0, 7));
    return along < 0 ? 7 - step : 8 + step;
  }

  Coder& coder_;
  LabelModels& models_;
  Link& link_;
  // By axis and label: the sum of the middles, and what a middle is compared with. That is the sum
  // itself, or for the next label to come the sum of the other labels, negated.
  std::array<Numbers, 3> sum_{}, from_{};
  std::array<double, 3> all_{};
  // By label: the triangles that carry it; those that `from_` sums up, twice the log of that, and
  // how many carry it in four steps.
  Numbers carried_{}, count_{};
  std::array<int, 4> logCount_{}, many_{};
  std::size_t labels_ = 0, triangles_ = 0;  // so far
};

}  // namespace qtet
