// Whether a fusion keeps the mesh what it is (ALGORITHM.md, "Legality"). Topology is kept exactly
// (the link condition with the ghost vertex), no cell flips, and the solid stays inside the
// boundary envelope. Also how well shaped the new cells are. Topology, flips and the envelope
// without tolerance are exact.
#pragma once

#include <cassert>
#include <cstdint>
#include <span>

#include "simplify/legality/boundary_envelope.h"
#include "simplify/legality/flip_check.h"
#include "simplify/legality/full_link_check.h"
#include "simplify/legality/local_star.h"
#include "simplify/legality/moved_check.h"
#include "simplify/legality/region_check.h"
#include "simplify/legality/star_shapes.h"
#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

struct FusionLimits {
  /// No new cell may be shaped worse than this or than a fifth of its star's worst, whichever is
  /// lower.
  double shapeFloor = 0;
  /// Where the solid may leave the boundary envelope for; null: nowhere.
  const AllowedSpace* allowed = nullptr;
  /// Cosine of the largest angle by which a boundary triangle may turn in one fusion; negative:
  /// any.
  double normalCosine = -1;
  /// The fields of displacements at whose instants no cell may flip either (sampledDisplacements).
  std::span<const std::size_t> displacements{};
};

/// One thread's own; the mesh may be shared while nobody fuses.
class FusionCheck {
 public:
  explicit FusionCheck(const FusionMesh& mesh, const FusionLimits& limits = {});
  FusionCheck(const FusionCheck&) = delete;
  FusionCheck& operator=(const FusionCheck&) = delete;

  /// Collects the boundary triangles of the prey's star, which is all that the envelope asks for.
  /// False when the star is too large.
  [[nodiscard]] bool gatherBoundary(const Prey& prey);
  /// Collects the rest of the star. False when that already rules the fusion out. REQUIRES
  /// gatherBoundary.
  [[nodiscard]] bool gatherRest();
  /// Both.
  [[nodiscard]] bool gather(const Prey& prey) { return gatherBoundary(prey) && gatherRest(); }
  /// Keeps topology: of the solid, of its boundary, and of every component of either; and the log
  /// can describe it. REQUIRES gather.
  [[nodiscard]] bool keepsTopology();

  /// Fusion points may lie outside the envelope, where staysNear(p).
  [[nodiscard]] bool mayLeave() const { return limits_.allowed != nullptr; }
  /// p lies on the inner side of (or on) every boundary face of the star. REQUIRES gatherBoundary.
  [[nodiscard]] bool insideEnvelope(const LatticePoint& p) const { return envelope_.holds(p); }
  /// Moves p onto the planes of the boundary faces that it lies outside of, one after the other,
  /// until its lattice point is inside. REQUIRES gatherBoundary.
  [[nodiscard]] bool projectInside(const Vector3& p, LatticePoint& inside) const {
    return envelope_.project(p, inside);
  }
  /// Whether a cell of one of these prey vertices (one bit each) would flip or go flat with the
  /// prey at p, as far as doubles tell. REQUIRES gatherBoundary.
  [[nodiscard]] bool flipsAt(const LatticePoint& p, std::uint32_t moving) const {
    return flips_.flipsAt(prey_, p, moving);
  }
  /// REQUIRES gatherBoundary.
  [[nodiscard]] VolumeChange volumeChange() const { return envelope_.volumeChange(); }
  /// Whether with the prey at p the solid gains nothing that lies further outside the original one
  /// than the tolerance. REQUIRES gatherBoundary, mayLeave, p on the lattice.
  [[nodiscard]] bool staysNear(const LatticePoint& p) const {
    assert(mayLeave());
    return envelope_.staysNear(*limits_.allowed, p, known_);
  }
  /// The worst shape among the affected cells with the prey at p (1 = regular, 0 = flat). Negative
  /// where p is not legal, since a cell would flip or be squashed or a boundary triangle turn too
  /// far. Also negative where the shape is worse than `least`. REQUIRES gather, p on the lattice.
  [[nodiscard]] double shapeAt(const LatticePoint& p, double least = 0) const;
  /// Whether instants at which the mesh has moved count, too.
  [[nodiscard]] bool mayMove() const { return !limits_.displacements.empty(); }
  /// Whether a cell would flip at one of them with the prey at p (moved_check.h). REQUIRES gather.
  [[nodiscard]] bool flipsMoved(const LatticePoint& p,
                                std::span<const std::int32_t> integers) const {
    assert(isGathered() && mayMove());
    return moved_.flipsAt(p, integers);
  }
  /// The worst shape in the star as it is. REQUIRES gather.
  [[nodiscard]] double oldShape() const {
    assert(isGathered());
    return shapes_.old();
  }

  [[nodiscard]] const Star& star() const { return star_.star(); }
  /// The same for good: until the next gather there is none here.
  void takeStar(Star& star) { star_.takeStar(star); }

 private:
  /// gather was true of this prey: the star is its own.
  [[nodiscard]] bool isGathered() const {
    return star_.prey().k == prey_.k && star_.prey().vertex == prey_.vertex;
  }

  const FusionMesh& mesh_;
  FusionLimits limits_;
  Prey prey_;
  BoundaryEnvelope envelope_;
  mutable DistanceCells known_;  // about limits_.allowed
  FlipCheck flips_;
  LocalStar star_;
  StarShapes shapes_;
  mutable MovedCheck moved_;  // remembers the star's places
  FullLinkCheck link_;
  RegionCheck regions_;
};

}  // namespace qtet
