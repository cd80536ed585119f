#include "simplify/legality/fusion_check.h"

#include <cassert>

#include "simplify/legality/edge_link_check.h"

namespace qtet {

FusionCheck::FusionCheck(const FusionMesh& mesh, const FusionLimits& limits)
    : mesh_(mesh),
      limits_(limits),
      envelope_(mesh, limits.normalCosine),
      flips_(mesh),
      star_(mesh),
      shapes_(mesh, star_, limits.shapeFloor),
      moved_(mesh, star_, limits_.displacements) {}

bool FusionCheck::gatherBoundary(const Prey& prey) {
  assert(prey.k >= 2 && prey.k <= 4);
  if (starCellsOf(mesh_, prey) > kMaxStarCells) return false;
  prey_ = prey;
  envelope_.gather(prey);
  flips_.forget();
  return true;
}

bool FusionCheck::gatherRest() {
  assert(prey_.k >= 2 && prey_.k <= 4);
  if (!star_.gather(prey_)) return false;
  shapes_.measure();
  moved_.forget();
  return true;
}

double FusionCheck::shapeAt(const LatticePoint& p, double least) const {
  assert(isGathered());
  const double shape = shapes_.at(p, least);
  return shape >= 0 && envelope_.turnsTooFar(p) ? -1 : shape;
}

bool FusionCheck::keepsTopology() {
  assert(isGathered());
  const bool isSmallEdge = prey_.k == 2 && star_.ring().size() <= kMaxRing;
  if (isSmallEdge ? !edgeKeepsTopology(star_) : !link_.passes(mesh_, prey_, star_.star()))
    return false;
  return !mesh_.hasRegions() || regions_.passes(mesh_, prey_, star_.star());
}

}  // namespace qtet
