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

class LevelFusions {
 public:
  /// `boundary`: null where no fusion goes outside. REQUIRES: all outlive this.
  LevelFusions(FusionState& state, LiveBoundary* boundary) : state_(state), boundary_(boundary) {}

  void begin(std::uint32_t level);
  /// No fusion with one of these in its link goes outside from now on. `isSeam`: by vertex of the
  /// mesh as it is; outlives this.
  void keepOff(std::span<const std::uint8_t> isSeam) { isSeam_ = isSeam; }
  /// The fusion would make the boundary meet itself, or could meet that of another part.
  [[nodiscard]] bool isMet(const Proposal& proposal) const {
    assert(!proposal.where.goesOutside || boundary_);
    return proposal.where.goesOutside && (isAtSeam(proposal) || boundary_->isMetBy(proposal));
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
    return std::ranges::any_of(proposal.star.link,
                               [this](VertexId v) { return v < isSeam_.size() && isSeam_[v]; });
  }

  FusionState& state_;
  LiveBoundary* boundary_;
  std::span<const std::uint8_t> isSeam_;
  std::uint32_t level_ = 0;
  std::vector<std::uint8_t> wentOutside_;
  std::vector<VertexId> fused_;
  std::vector<VertexId> links_;  // of fused_, back to back
  std::vector<std::size_t> linkEnds_;
};

}  // namespace qtet
