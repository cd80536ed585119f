// Where the prey vertices of a record lie (FORMAT.md, "Positions"): the leading digits of each difference go to the positions block, as small
// integers of one and the same distribution whatever the size of the star; the digits below, which are noise, ride in the structure block.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "codec/growing_mesh.h"
#include "codec/link.h"
#include "codec/log2_fixed.h"
#include "codec/mesh.h"
#include "codec/placement.h"
#include "codec/range_coder.h"
#include "codec/values.h"

namespace qtet {

struct PositionModels {
  std::array<std::array<BitModel, 4>, 4> same;               // placement, axis (or 3: what is left of a free point)
  std::array<std::array<BitModel, 2>, 3> parity;             // axis, the difference's lowest bit
  std::array<std::array<BitModel, 4>, 3> remainder;          // axis, digits so far
};

template <class Coder>
class PositionCoder {
 public:
  /// Of the record of v, whose link is labelled.
  PositionCoder(Coder& coder, PositionModels& models, Values& values, VertexId v, const GrowingMesh& mesh, const Link& link)
      : coder_(coder), models_(models), values_(values), fused_(mesh.points[v]) {
    const auto spread = mesh.spread(v);
    for (std::size_t a = 0; a < 3; ++a) logLength_[a] = log2Fixed(spread[a]) / 128 + mesh.spreadShift();
    findMiddles(mesh, link);
  }

  /// Codes the k prey points in place: an encoder's are read, a decoder's written.
  void code(int k, Placement placement, std::array<LatticePoint, 4>& points) {
    switch (placement) {
      case Placement::kAtPrey:
        points[0] = fused_;
        for (std::size_t i = 1; i < static_cast<std::size_t>(k); ++i) point(points[i], predicted({{{i, 28}, {kShared, 8}, {0, -8}}}), placement, kWholeEdge);
        return;
      case Placement::kMiddle:
        point(points[0], predicted({{{0, 13}, {1, -13}, {1, 0}}}), placement, kHalfEdge);
        for (std::size_t a = 0; a < 3; ++a) points[1][a] = otherEnd(points[0][a], points[1][a], a);
        return;
      case Placement::kQuarter:
        point(points[0], predicted({{{0, 6}, {1, -6}, {1, 0}}}), placement, kQuarterEdge);
        for (std::size_t a = 0; a < 3; ++a) points[1][a] = farEnd(points[0][a], points[1][a], a);
        return;
      case Placement::kFree: free(k, points);
    }
  }

 private:
  // How many digits of a difference go to the positions block: an edge of the star's mean length along the axis is about 2^kWholeEdge of its units.
  static constexpr int kWholeEdge = 5, kHalfEdge = 6, kQuarterEdge = 7;
  static constexpr std::size_t kShared = 4;

  // The middle of the link's vertices that only one prey vertex's triangles hold, for each prey vertex, and of all the others; from the fused vertex.
  void findMiddles(const GrowingMesh& mesh, const Link& link) {
    owners_.assign(link.vertices().size(), 0);
    for (const LinkTriangle& t : link.triangles())
      for (const std::uint32_t x : t.vertex) owners_[x] |= static_cast<std::uint8_t>(1 << t.label);
    std::array<std::int64_t, 5> count{};
    for (std::size_t i = 0; i < owners_.size(); ++i) {
      const VertexId x = link.vertices()[i];
      if (x == kGhost) continue;
      const std::size_t owner = std::has_single_bit(owners_[i]) ? static_cast<std::size_t>(std::countr_zero(owners_[i])) : kShared;
      ++count[owner];
      for (std::size_t a = 0; a < 3; ++a) middle_[owner][a] += mesh.points[x][a] - fused_[a];
    }
    for (std::size_t owner = 0; owner < count.size(); ++owner)
      if (count[owner] > 1)
        for (std::int64_t& x : middle_[owner]) x /= count[owner];
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
    for (std::size_t a = 0; a < 3; ++a) p[a] = component(predicted[a], p[a], digits, a, models_.same[static_cast<std::size_t>(placement)][a]);
  }

  std::int32_t component(std::int32_t predicted, std::int32_t truth, int digits, std::size_t axis, BitModel& same) {
    const int shift = std::clamp(logLength_[axis] - digits, 0, kMaxPositionBits);
    const std::int64_t half = (std::int64_t{1} << shift) >> 1;
    const std::int64_t shifted = std::int64_t{truth} - predicted + half;
    const std::int64_t high = values_.code<Coder::kEncoding>(shifted >> shift);
    const std::int64_t least = predicted - half + high * (std::int64_t{1} << shift);
    if (shift == 0) return inRange(least);
    // On the fused vertex's lattice plane, as in grids?
    const std::int64_t plane = fused_[axis] - least;
    if (plane >= 0 && plane >> shift == 0 && coder_.bit(truth == fused_[axis], same)) return fused_[axis];
    return inRange(least + coder_.raw(static_cast<std::uint32_t>(truth - least), shift));
  }

  // Middle: fused = (near + other) >> 1.
  std::int32_t otherEnd(std::int32_t near, std::int32_t other, std::size_t axis) {
    const std::int64_t even = 2 * std::int64_t{fused_[axis]} - near;
    return inRange(even + coder_.bit(static_cast<int>(other - even) & 1, models_.parity[axis][static_cast<std::size_t>(near - fused_[axis]) & 1]));
  }

  // Quarter: fused = (3 near + far + 2) >> 2.
  std::int32_t farEnd(std::int32_t near, std::int32_t far, std::size_t axis) {
    const std::int64_t least = 4 * std::int64_t{fused_[axis]} - 3 * std::int64_t{near} - 2;
    const int rest = static_cast<int>(far - least);
    auto& model = models_.remainder[axis];
    const int high = coder_.bit(rest >> 1 & 1, model[1]);
    const int low = coder_.bit(rest & 1, model[static_cast<std::size_t>(2 + high)]);
    return inRange(least + 2 * high + low);
  }

  // The last is predicted as what keeps the mean.
  void free(int k, std::array<LatticePoint, 4>& points) {
    LatticePoint last{};
    for (std::size_t a = 0; a < 3; ++a) last[a] = inRange(std::int64_t{k} * fused_[a]);
    for (std::size_t i = 0; i < static_cast<std::size_t>(k); ++i) {
      const bool isLast = i + 1 == static_cast<std::size_t>(k);
      const LatticePoint own = predicted({{{i, 28}, {i, 0}, {i, 0}}});
      for (std::size_t a = 0; a < 3; ++a) {
        points[i][a] = component(isLast ? last[a] : own[a], points[i][a], kWholeEdge, a, models_.same[3][isLast ? 3 : a]);
        last[a] = inRange(std::int64_t{last[a]} - points[i][a]);
      }
    }
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
  LatticePoint fused_;
  std::array<int, 3> logLength_{};
  std::array<std::array<std::int64_t, 3>, 5> middle_{};
  std::vector<std::uint8_t> owners_;
};

}  // namespace qtet
