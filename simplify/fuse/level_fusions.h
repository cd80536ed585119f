// The fusions of a level. No decision of a level depends on its fusions having been done.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/fuse/fusion_proposer.h"
#include "simplify/fuse/fusion_state.h"
#include "simplify/fuse/live_boundary.h"

namespace qtet {

/// A box of lattice points, its corners included.
struct LatticeBox {
  LatticePoint low, high;
};

[[nodiscard]] inline bool meet(const LatticeBox& a, const LatticeBox& b) {
  bool apart = false;
  for (std::size_t i = 0; i < 3; ++i) apart |= a.high[i] < b.low[i] || b.high[i] < a.low[i];
  return !apart;
}

/// All that lies beside a part and is not known within it. No fusion with a seam vertex in its link
/// goes outside, nor one whose star, with the fusion point, reaches one of these boxes.
struct PartSurroundings {
  std::span<const std::uint8_t> isSeam;  ///< by vertex of the part
  std::span<const LatticeBox> boxes{};   ///< that hold all other parts
};

class LevelFusions {
 public:
  /// `boundary`: null where no fusion goes outside. REQUIRES: all outlive this.
  LevelFusions(FusionState& state, LiveBoundary* boundary) : state_(state), boundary_(boundary) {}

  void begin(std::uint32_t level);
  /// From now on. `beside` outlives this.
  void keepOff(const PartSurroundings& beside) { beside_ = beside; }
  /// The fusion would make the boundary meet itself, or could meet that of another part.
  [[nodiscard]] bool isMet(const Proposal& proposal) const {
    assert(!proposal.where.goesOutside || boundary_);
    return proposal.where.goesOutside &&
           (isAtSeam(proposal) || reachesABox(proposal) || boundary_->isMetBy(proposal));
  }
  /// Does the fusion and touches its star. REQUIRES: no vertex of the prey is locked.
  void carryOut(const Proposal& proposal);

  /// By fusion of all levels: whether it went outside of the boundary as it was.
  [[nodiscard]] std::vector<std::uint8_t>& wentOutside() { return wentOutside_; }

  /// The fused vertices of the level.
  [[nodiscard]] std::span<const VertexId> fused() const { return fused_; }
  /// The link of fused()[i], in which nothing changes until the level ends.
  [[nodiscard]] std::span<const VertexId> linkOf(std::size_t i) const {
    assert(i < fused_.size() && linkEnds_.size() == fused_.size());
    const std::size_t first = i == 0 ? 0 : linkEnds_[i - 1];
    return std::span(links_).subspan(first, linkEnds_[i] - first);
  }

 private:
  [[nodiscard]] bool isAtSeam(const Proposal& proposal) const {
    return std::ranges::any_of(proposal.star.link, [this](VertexId v) {
      return v < beside_.isSeam.size() && beside_.isSeam[v];
    });
  }
  [[nodiscard]] bool reachesABox(const Proposal& proposal) const;

  FusionState& state_;
  LiveBoundary* boundary_;
  PartSurroundings beside_;
  std::uint32_t level_ = 0;
  std::vector<std::uint8_t> wentOutside_;
  std::vector<VertexId> fused_;
  std::vector<VertexId> links_;  // of fused_, back to back
  std::vector<std::size_t> linkEnds_;
};

}  // namespace qtet
