// Codes where the prey vertices of a record lie (FORMAT.md, "Positions"). The leading digits of
// each difference go to the positions block, as small integers with the same distribution whatever
// the size of the star. The digits below are noise and go to the structure block.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "codec/coding/log2_fixed.h"
#include "codec/coding/pair.h"
#include "codec/coding/range_coder.h"
#include "codec/coding/small_order.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/link.h"
#include "codec/mesh/mesh.h"
#include "codec/mesh/placement.h"
#include "codec/record/values.h"
#include "proto/limits.h"

namespace qtet {

struct PositionModels {
  static constexpr std::size_t kRatios = 8;
  // k, touches the boundary, ratio of the distances of the two nearest middles, question
  std::array<std::array<std::array<std::array<BitModel, 3>, kRatios>, 2>, 3> placement;
  // quarter or at a prey vertex, ratio, rank
  std::array<std::array<std::array<BitModel, 3>, kRatios>, 2> near;
  std::array<std::array<BitModel, 3>, 4> same;  // placement, axis
  // of a mean: k, axis, digits so far
  std::array<std::array<std::array<BitModel, 4>, 3>, 3> remainder;
  std::array<std::array<BitModel, 4>, 3> quarter;  // axis, digits so far
  std::array<NumberModel, 3> offset;               // axis
};

template <class Coder>
class PositionCoder {
 public:
  PositionCoder(Coder& coder, PositionModels& models, Values& values, const GrowingMesh& mesh,
                const Link& link)
      : coder_(coder), models_(models), values_(values), mesh_(mesh), link_(link) {}

  /// Codes placement, near and the k points of the split of v, whose link is placed and labelled:
  /// an encoder's are read, a decoder's written.
  void code(VertexId v, Split& split) {
    fused_ = mesh_.points[v];
    const GrowingMesh::Spread& spread = mesh_.spread(v);
    for (std::size_t a = 0; a < 3; ++a)
      logLength_[a] = spread.logMean(spread.squares[a]) / 128 + mesh_.spreadShift();
    findMiddles();
    const auto n = static_cast<std::size_t>(split.k);
    std::array<LatticePoint, 4>& points = split.points;
    placement(split);
    const auto near = static_cast<std::size_t>(split.near);
    switch (split.placement) {
      case Placement::kAtPrey:
        points[near] = fused_;
        for (std::size_t i = 0; i < n; ++i)
          if (i != near)
            point(points[i], predicted({{{i, 28}, {kShared, 8}, {near, -8}}}), Placement::kAtPrey,
                  kWholeEdge);
        return;
      case Placement::kQuarter:
        point(points[near], predicted({{{near, 6}, {1 - near, -6}, {near, 0}}}),
              Placement::kQuarter, kQuarterEdge);
        for (std::size_t a = 0; a < 3; ++a)
          points[1 - near][a] =
              remainder(4 * std::int64_t{fused_[a]} - 3 * std::int64_t{points[near][a]} - 2,
                        points[1 - near][a], 4, models_.quarter[a]);
        return;
      case Placement::kMiddle:
      case Placement::kFree:
        for (std::size_t i = 0; i + 1 < n; ++i)
          point(points[i],
                n == 2 ? predicted({{{0, 13}, {1, -13}, {1, 0}}})
                       : predicted({{{i, 24}, {i, 0}, {i, 0}}}),
                split.placement, kHalfEdge);
        for (std::size_t a = 0; a < 3; ++a) {
          std::int64_t rest = std::int64_t{split.k} * fused_[a];
          for (std::size_t i = 0; i + 1 < n; ++i) rest -= points[i][a];
          std::int32_t& last = points[n - 1][a];
          last = split.placement == Placement::kMiddle
                     ? remainder(inRange(rest), last, split.k, models_.remainder[n - 2][a])
                     : fromNear(inRange(rest), last, a);
        }
    }
  }

 private:
  // How many digits of a difference go to the positions block. In their units, an edge of the
  // star's mean length along the axis is about 2^kWholeEdge.
  static constexpr int kWholeEdge = 2, kHalfEdge = 3, kQuarterEdge = 4;
  static constexpr std::size_t kShared = 4;

  // For each prey vertex, the mean of the link's vertices that only its triangles have; then the
  // mean of all others. Relative to the fused vertex.
  void findMiddles() {
    std::array<Link::Offset, 5> sum{};
    std::array<std::int64_t, 5> count{};
    for (std::uint32_t i = 0; i < link_.vertices().size(); ++i) {
      if (link_.vertices()[i] == kGhost) continue;
      const Link::LabelCounts labels = link_.labelsRound(i);
      const auto lowest = static_cast<std::size_t>(std::countr_zero(labels)) / 16;
      const auto alone = static_cast<std::size_t>(labels >> (16 * lowest) < 1 << 16);
      // without a branch: one in three is shared
      const std::size_t owner = kShared ^ ((kShared ^ lowest) & (0 - alone));
      ++count[owner];
      for (std::size_t a = 0; a < 4; a += 2)
        putPair(&sum[owner][a], pairAt(&sum[owner][a]) + pairAt(&link_.offsets()[i][a]));
    }
    for (std::size_t owner = 0; owner < count.size(); ++owner)
      for (std::size_t a = 0; a < 3; ++a) {
        middle_[owner][a] = static_cast<std::int64_t>(sum[owner][a]);
        if (count[owner] > 1) middle_[owner][a] /= count[owner];
      }
  }

  // The label whose middle is nearest to the fused vertex predicts the prey vertex at which it
  // stands. The ratio to the second nearest predicts whether it stands at one at all.
  void placement(Split& split) {
    const auto n = static_cast<std::size_t>(split.k);
    std::array<int, 4> distance{};
    for (std::size_t i = 0; i < n; ++i) {
      double squared = 1;
      for (const std::int64_t x : middle_[i])
        squared += static_cast<double>(x) * static_cast<double>(x);
      distance[i] = log2Fixed(squared);
    }
    const auto order =
        smallOrder(n, [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
    const auto ratio =
        static_cast<std::size_t>(std::min((distance[order[1]] - distance[order[0]]) / 32,
                                          static_cast<int>(PositionModels::kRatios) - 1));
    auto& model = models_.placement[n - 2][link_.hasGhost()][ratio];
    if (coder_.bit(split.placement == Placement::kAtPrey, model[0]))
      split.placement = Placement::kAtPrey;
    else if (coder_.bit(split.placement == Placement::kFree, model[1]))
      split.placement = Placement::kFree;
    else
      split.placement = n > 2 || coder_.bit(split.placement == Placement::kMiddle, model[2])
                            ? Placement::kMiddle
                            : Placement::kQuarter;
    if (split.placement == Placement::kMiddle || split.placement == Placement::kFree) return;
    auto& nearModel = models_.near[split.placement == Placement::kQuarter][ratio];
    std::size_t rank = 0;
    while (rank + 1 < n &&
           !coder_.bit(static_cast<std::size_t>(split.near) == order[rank], nearModel[rank]))
      ++rank;
    split.near = static_cast<int>(order[rank]);
  }

  struct Share {
    std::size_t owner;
    std::int64_t weight;  // in 64ths
  };
  [[nodiscard]] LatticePoint predicted(const std::array<Share, 3>& shares) {
    LatticePoint p = fused_;
    for (std::size_t a = 0; a < 3; ++a) {
      std::int64_t sum = 32;
      for (const Share& s : shares) sum += s.weight * middle_[s.owner][a];
      p[a] = inRange(p[a] + (sum >> 6));
    }
    return p;
  }

  void point(LatticePoint& p, const LatticePoint& predicted, Placement placement, int digits) {
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = component(predicted[a], p[a], digits, a,
                       models_.same[static_cast<std::size_t>(placement)][a]);
  }

  std::int32_t component(std::int32_t predicted, std::int32_t truth, int digits, std::size_t axis,
                         BitModel& same) {
    const int shift = std::clamp(logLength_[axis] - digits, 0, kMaxPositionBits);
    const std::int64_t half = (std::int64_t{1} << shift) >> 1;
    const std::int64_t shifted = std::int64_t{truth} - predicted + half;
    const std::int64_t high = values_.code<Coder::kEncoding>(shifted >> shift);
    const std::int64_t least = predicted - half + high * (std::int64_t{1} << shift);
    if (shift == 0) return inRange(least);
    // On the fused vertex's lattice plane, as in grids?
    const std::int64_t plane = fused_[axis] - least;
    if (plane >= 0 && plane >> shift == 0 && coder_.bit(truth == fused_[axis], same))
      return fused_[axis];
    return inRange(least + coder_.raw(static_cast<std::uint32_t>(truth - least), shift));
  }

  // One of the `count` integers from `least` on, 2 to 4: what rounding a mean leaves open.
  std::int32_t remainder(std::int64_t least, std::int32_t truth, int count,
                         std::array<BitModel, 4>& model) {
    const int rest = static_cast<int>(truth - least);
    const int high = count > 2 ? coder_.bit(rest >> 1 & 1, model[1]) : 0;
    const int low = count == 3 && high == 1
                        ? 0
                        : coder_.bit(rest & 1, model[static_cast<std::size_t>(2 + high)]);
    return inRange(least + 2 * high + low);
  }

  // A free point is most often a projected mean: the difference has a size of its own.
  std::int32_t fromNear(std::int32_t expected, std::int32_t truth, std::size_t axis) {
    const std::int64_t difference = std::int64_t{truth} - expected;
    const std::uint32_t size = models_.offset[axis].code(
        coder_, static_cast<std::uint32_t>(difference < 0 ? -difference : difference));
    const bool negative = size != 0 && coder_.raw(difference < 0, 1) != 0;
    return inRange(negative ? expected - std::int64_t{size} : expected + std::int64_t{size});
  }

  // Noise from a damaged block stays within what the next sum can hold.
  std::int32_t inRange(std::int64_t x) {
    if (x >= -kLargest && x <= kLargest) return static_cast<std::int32_t>(x);
    values_.spoil();
    return 0;
  }
  static constexpr std::int64_t kLargest = std::int64_t{1} << 30;

  Coder& coder_;
  PositionModels& models_;
  Values& values_;
  const GrowingMesh& mesh_;
  const Link& link_;
  LatticePoint fused_{};
  std::array<int, 3> logLength_{};
  std::array<std::array<std::int64_t, 3>, 5> middle_{};
};

}  // namespace qtet
