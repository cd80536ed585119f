// Point fields: what a record's prey vertices have, predicted from the fused vertex's value and
// from how the field changes through its star (FORMAT.md, "Point values").
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/link.h"
#include "codec/mesh/mesh.h"
#include "codec/mesh/placement.h"
#include "codec/record/values.h"
#include "proto/limits.h"

namespace qtet {

/// How much a field changes over a step through a star. It is a weighted sum of differences to the
/// fused vertex's value. They are taken at the corners of the two link triangles that the line
/// along the step passes.
struct Slope {
  static constexpr int kWeightBits = 12;
  static constexpr int kReachBits = 8;
  static constexpr std::uint16_t kMaxReach = 0x7FFF;
  /// Added to a reach whose exit lies on the boundary, beyond which there is nothing.
  static constexpr std::uint16_t kBeyond = 0x8000;

  std::array<VertexId, 6> vertex{};      ///< against the step, along it; 0 where the weight is 0
  std::array<std::int16_t, 6> weight{};  ///< in 1 / 2^kWeightBits
  /// How far the exit of each side is, in 1 / 2^kReachBits of the step; 0: there is none.
  std::array<std::uint16_t, 2> reach{};

  [[nodiscard]] std::int64_t reachOf(std::size_t side) const { return reach[side] & kMaxReach; }
  [[nodiscard]] bool isBeyond(std::size_t side) const { return (reach[side] & kBeyond) != 0; }

  [[nodiscard]] bool hasBoth() const { return reach[0] > 0 && reach[1] > 0; }
  /// A side's sum times this, in 1/256, is the change over a step as that side alone has it. 0
  /// without an exit there.
  [[nodiscard]] std::int64_t ratio(std::size_t side) const {
    const auto at = [&](std::size_t i) { return std::uint32_t{reach[i]} & kMaxReach; };
    const std::uint32_t own = at(side), both = at(0) + at(1);
    return own == 0 ? 0 : std::min<std::uint32_t>((256 * both + own / 2) / own, kMaxReach);
  }

  /// By the exits within the mesh. `difference(v)` is v's value less the fused vertex's.
  template <class Difference>
  [[nodiscard]] std::int64_t change(const Difference& difference) const {
    std::array<std::int64_t, 2> sum{};
    for (std::size_t i = 0; i < vertex.size(); ++i) sum[i / 3] += weight[i] * difference(vertex[i]);
    if (!isBeyond(0) && !isBeyond(1)) return sum[0] + sum[1];
    std::int64_t within = 0;
    for (std::size_t side = 0; side < 2; ++side)
      if (!isBeyond(side)) within += sum[side] * ratio(side) >> 8;
    return within;
  }
};

/// The data with which a field follows a record without its connectivity, so that the field may
/// arrive later.
struct Birth {
  VertexId slot = 0;      ///< the vertex that split
  VertexId firstNew = 0;  ///< its k - 1 new vertices start here
  /// Into PointAncestry's; k = 2: one for both prey vertices, else one a prey vertex.
  std::uint32_t firstSlope = 0;
  /// K = 2: from the fused vertex to prey vertex 0, in 1 / 2^kStepBits of the way from prey 0 to
  /// prey 1.
  std::int16_t step = 0;
  std::uint8_t k = 2;

  static constexpr int kStepBits = 8;

  std::uint8_t place = 0;  ///< the Placement, and 4 times the near prey vertex
  /// The slot of prey vertex i.
  [[nodiscard]] VertexId preySlot(std::size_t i) const {
    return i == 0 ? slot : firstNew + static_cast<VertexId>(i) - 1;
  }
  [[nodiscard]] Placement placement() const { return static_cast<Placement>(place & 3); }
  [[nodiscard]] std::size_t near() const { return place >> 2; }
};

/// The records so far, as far as point fields depend on them. Takes 16 bytes a record and 40 a
/// slope.
class PointAncestry {
 public:
  /// `withSlopes`: there is a point field.
  explicit PointAncestry(bool withSlopes = false) : withSlopes_(withSlopes) {}

  /// A hint: `records` records are to come, with at most `vertices` new vertices. REQUIRES: there
  /// is memory for it (roomFor).
  void reserve(std::uint64_t records, std::uint64_t vertices);
  /// Bytes that reserve() takes.
  [[nodiscard]] std::uint64_t roomFor(std::uint64_t records, std::uint64_t vertices) const {
    return records * sizeof(Birth) + slopesOf(records, vertices) * sizeof(Slope);
  }
  /// Notes the split of v. REQUIRES: link built, the split not yet applied.
  void add(VertexId v, const GrowingMesh& mesh, const Link& link, const Split& split);
  [[nodiscard]] std::span<const Birth> births() const { return births_; }
  /// The first birth of each level that has one.
  [[nodiscard]] std::span<const std::uint32_t> levelStarts() const { return levelStarts_; }
  /// Those that a record's tuples are predicted by. REQUIRES: there are slopes.
  [[nodiscard]] std::span<const Slope> slopesAt(const Birth& b) const {
    assert(withSlopes_ && b.firstSlope < slopes_.size());
    return std::span(slopes_).subspan(b.firstSlope, b.k == 2 ? 1 : b.k);
  }

  /// Codes the k tuples of a record into `at(vertex, component)`, references to the field's values.
  /// With missing values, neighbours that are missing change nothing. REQUIRES components <=
  /// kMaxFieldComponents.
  template <bool kEncoding, class At, class Truth>
  void code(const Birth& b, Values& values, std::uint32_t components, const At& at,
            const Truth& truth, bool hasMissing = false) const {
    assert(components <= kMaxFieldComponents);
    // not cleared: that would take as long as the rest
    std::array<std::int32_t, std::size_t{4} * kMaxFieldComponents> prey;
    for (std::uint32_t c = 0; c < components; ++c)
      for (std::size_t i = 0; i < b.k; ++i)
        prey[i * components + c] = values.codeField<kEncoding>(
            hasMissing,
            predicted(b, i, hasMissing, [&](VertexId v) { return std::int64_t{at(v, c)}; }),
            truth(i, c));
    for (std::size_t i = 0; i < b.k; ++i)
      for (std::uint32_t c = 0; c < components; ++c)
        at(b.preySlot(i), c) = prey[i * components + c];
  }

 private:
  // An edge has one slope and brings one vertex; a triangle three and two, a tetrahedron four and
  // three.
  [[nodiscard]] std::uint64_t slopesOf(std::uint64_t records, std::uint64_t vertices) const {
    return withSlopes_ ? records + 2 * (std::max(vertices, records) - records) : 0;
  }
  void addSlope(const Link& link, const std::array<double, 3>& step);

  template <class At>
  [[nodiscard]] std::int64_t predicted(const Birth& b, std::size_t i, bool hasMissing,
                                       const At& at) const {
    const std::int64_t fused = at(b.slot);
    const Slope& slope = slopes_[b.firstSlope + (b.k == 2 ? 0 : i)];
    if (hasMissing && fused == kMissing) return 0;
    const std::int64_t change = slope.change(
        [&](VertexId v) { return hasMissing && at(v) == kMissing ? 0 : at(v) - fused; });
    const std::int64_t steps =
        b.k == 2 ? b.step + (i == 0 ? 0 : 1 << Birth::kStepBits) : 1 << Birth::kStepBits;
    constexpr int kBits = Slope::kWeightBits + Birth::kStepBits;
    return std::clamp(fused + ((change * steps + (std::int64_t{1} << (kBits - 1))) >> kBits),
                      -kFurthest, kFurthest);
  }
  // A steep field over a long step predicts far beyond any value. The bound is the largest
  // difference that a value block can code.
  static constexpr std::int64_t kFurthest = kMaxDracoMagnitude / 2;

  bool withSlopes_;
  std::vector<Birth> births_;
  std::vector<Slope> slopes_;
  std::vector<std::uint32_t> levelStarts_;
  std::uint32_t level_ = 0;                    // of the last birth
  std::vector<std::array<double, 3>> turned_;  // of the link in hand
};

}  // namespace qtet
