#include "simplify/fuse/fusion_point.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "simplify/legality/lattice_rounding.h"

namespace qtet {
namespace {

// How far (in radii of the prey) a quadric's minimum may lie from the prey's barycentre before it
// counts as ill-conditioned.
constexpr double kReach = 1.5;
// A star shaped better than this asks no more of its new cells (1 = regular, 0 = flat).
constexpr double kGoodShape = 0.3;
// Clear of what rounding does to a bound.
constexpr double kSurelyWorse = 1 - 1e-9;
// An edge of the boundary costs more than its quadric says, since the envelope leaves it less room.
// A factor of 1.5 spares nearly half of the proposals that come to nothing. With 2 the boundary
// begins to suffer: flat parts cost no more and wait too long.
constexpr double kEnvelopeFactor = 1.5;
// If this share of the proposals that got as far as their star had no legal point there, it pays to
// test for flips before.
constexpr double kOftenRefused = 0.125;
// The weight of the last proposal in that share: so the part of the mesh at hand decides.
constexpr double kLastShare = 1.0 / 64;
// Flat cells that were flat before cost no more than this shape does.
constexpr double kFlat = 1e-6;

// A free point takes twice the bits of one that follows from its prey; it has to be worth them
// (ALGORITHM.md, "Placement").
double dearnessOfFree(PlacementRule rule) { return rule == PlacementRule::kAuto ? 4 : 1; }

LatticePoint rounded(const Vector3& p) {
  LatticePoint out{};
  for (std::size_t a = 0; a < 3; ++a) out[a] = static_cast<std::int32_t>(std::floor(p[a] + 0.5));
  return out;
}

}  // namespace

// The error that the fusion adds to the mesh: how much the prey is off more than its vertices are
// now. Only that decides, since no fusion can reduce the rest.
PreyQuadric FusionPointFinder::growth(const Prey& prey) const {
  assert(prey.k >= 2 && prey.k <= 4);
  PreyQuadric out = cost_.of(prey);
  for (const VertexId v : prey.vertices()) out.quadric.c -= cost_.of(v);
  return out;
}

// The prey vertices that decide: those on the boundary where there are any, else those between
// regions, else all.
FusionPointFinder::Deciding FusionPointFinder::deciding(const Prey& prey) const {
  Deciding out;
  std::size_t boundary = 0, surface = 0;
  for (const VertexId v : prey.vertices())
    boundary += mesh_.onBoundary(v), surface += mesh_.onSurface(v);
  out.boundary = boundary > 0;
  for (std::size_t i = 0; i < prey.k; ++i) {
    const bool decides = surface == 0 || (boundary > 0 ? mesh_.onBoundary(prey.vertex[i])
                                                       : mesh_.onSurface(prey.vertex[i]));
    // written in any case: what decides is a branch that no processor foresees
    out.vertex[out.count] = prey.vertex[i];
    out.count += decides;
  }
  for (std::size_t i = 0; i < out.count; ++i)
    out.centre = out.centre + (mesh_.position(out.vertex[i]) - mesh_.position(prey.vertex[0]));
  assert(out.count > 0 && (boundary == 0 || out.count == boundary));
  out.isAll = out.count == prey.k;
  out.centre = (1.0 / static_cast<double>(out.count)) * out.centre;
  return out;
}

FusionPointFinder::Ideal FusionPointFinder::idealOf(const Prey& prey, const Deciding& deciding,
                                                    const PreyQuadric& of) const {
  assert(deciding.count > 0);
  const auto& [quadric, pull] = of;
  if (const auto minimum = quadric.minimum(deciding.centre, pull)) {
    double radius = 0;
    for (const VertexId v : prey.vertices()) {
      const Vector3 d = mesh_.position(v) - mesh_.position(prey.vertex[0]) - deciding.centre;
      radius = std::max(radius, dot(d, d));
    }
    const Vector3 off = *minimum - deciding.centre;
    if (dot(off, off) <= kReach * kReach * radius) return {*minimum, quadric.at(*minimum)};
  }
  return {deciding.centre, quadric.at(deciding.centre)};
}

FusionPointFinder::Ideal FusionPointFinder::ideal(const Prey& prey) const {
  return idealOf(prey, deciding(prey), growth(prey));
}

// Along an edge E(t) = (a t + b) t + c: what its cheap points cost, but for their rounding to the
// lattice.
Pair FusionPointFinder::keysOf(VertexId v, std::array<VertexId, 2> w) const {
  assert(v != w[0] && v != w[1]);
  auto [quadric, pull, along] = cost_.ofEdges(v, w);
  quadric.c -= cost_.of(v) + Pair{cost_.of(w[0]), cost_.of(w[1])};  // as growth() does
  const auto rankOf = [&](VertexId x) { return mesh_.onBoundary(x) ? 2 : mesh_.onSurface(x); };
  const int rank = rankOf(v);
  // Where the vertices that decide have their middle: one of them, or both of equal rank.
  Pair share, factor;
  for (int lane = 0; lane < 2; ++lane) {
    const int other = rankOf(w[static_cast<std::size_t>(lane)]);
    share[lane] = rank == other ? 0.5 : rank < other ? 1 : 0;
    factor[lane] = mesh_.onBoundary(v) && rank == other ? kEnvelopeFactor : 1;
  }
  const Pair a = dot(along, quadric.times(along)), b = 2 * dot(quadric.b, along), c = quadric.c,
             none{};
  const auto at = [&](const Pair& t) { return (a * t + b) * t + c; };
  const auto least = [](const Pair& x, const Pair& y) { return x < y ? x : y; };
  const auto both = [&](const Pair& ofBoth, const Pair& ofOne) {
    return share == 0.5 ? ofBoth : ofOne;
  };
  const Pair ends = least(c, a + b + c);
  if (options_.rule == PlacementRule::kVertex) return factor * both(ends, at(share));
  const TwoVectors centre{share * along[0], share * along[1], share * along[2]};
  const TwoVectors minimum = quadric.minimum(centre, pull), off = minimum - centre;
  const Pair radius = both(none + 0.5, none + 1) * kReach;
  const Pair ideal = dot(off, off) <= radius * radius * dot(along, along) ? quadric.at(minimum)
                                                                          : quadric.at(centre);
  const Pair cheap =
      both(least(least(ends, at(none + 0.5)), least(at(none + 0.25), at(none + 0.75))), at(share));
  return factor * (cheap > ideal && cheap <= dearnessOfFree(options_.rule) * ideal ? cheap : ideal);
}

void FusionPointFinder::offer(const LatticePoint& p, bool isOutside, double dearness) {
  assert(dearness >= 1 && isOnLattice(p, mesh_.latticeBits()));
  for (const Choice& c : choices_)
    if (((c.point[0] ^ p[0]) | (c.point[1] ^ p[1]) | (c.point[2] ^ p[2])) == 0) return;
  const double cost = quadric_.at(toVector(p) - origin_);
  choices_.push_back({p, cost, dearness * cost, isOutside});
}

// The square of slope . d + change.
void FusionPointFinder::addVolume(const FusionCheck& test, Quadric& quadric) const {
  const VolumeChange volume = test.volumeChange();
  if (!(volume.area > 0)) return;
  const double weight = cost_.volumeWeight(volume.area, volume.triangles) / volume.area;
  quadric.a.addOuter(volume.slope, weight);
  quadric.b = quadric.b + weight * volume.change * volume.slope;
  quadric.c += weight * volume.change * volume.change;
}

// Points that take few bits come first, so that a free point which falls on one of them is that
// one.
void FusionPointFinder::offerCheap(const Prey& prey, const FusionCheck& test) {
  const auto offerInside = [&](const LatticePoint& p) {
    const bool isInside = !deciding_.boundary || test.insideEnvelope(p);
    if (isInside || test.mayLeave()) offer(p, !isInside);
  };
  assert(choices_.empty());
  for (std::size_t i = 0; i < deciding_.count; ++i) offerInside(mesh_.point(deciding_.vertex[i]));
  if (options_.rule == PlacementRule::kVertex || !deciding_.isAll) return;
  std::array<LatticePoint, 4> at{};
  for (std::size_t i = 0; i < prey.k; ++i) at[i] = mesh_.point(prey.vertex[i]);
  offerInside(middle(std::span(at).first(prey.k)));
  if (prey.k == 2) {
    offerInside(quarter(at[0], at[1]));
    offerInside(quarter(at[1], at[0]));
  }
}

void FusionPointFinder::offerFree(const FusionCheck& test) {
  assert(isFreeToCome() && options_.rule != PlacementRule::kVertex);
  const Vector3 middle = origin_ + deciding_.centre;
  const Vector3 best = origin_ + ideal_;
  const double dearness = dearnessOfFree(options_.rule);
  const std::array<Vector3, 3> points{best, 0.5 * (best + middle), middle};
  // The middle of one vertex is its place, which is known to be inside.
  for (const Vector3& p : std::span(points).first(best == middle         ? 1
                                                  : deciding_.count == 1 ? 2
                                                                         : 3)) {
    const LatticePoint there = rounded(p);
    const bool isThere = isOnLattice(there, mesh_.latticeBits());
    LatticePoint inside = there;
    if (deciding_.boundary ? test.projectInside(p, inside) : isThere)
      offer(inside, false, dearness);
    if (inside != there && isThere && test.mayLeave()) offer(there, true, dearness);
  }
  minFree_ = std::numeric_limits<double>::infinity();
}

std::optional<double> FusionPointFinder::price(const Prey& prey, const FusionCheck& test) {
  assert(!mesh_.singular(prey.vertex[0]) && !mesh_.singular(prey.vertex[1]));
  prey_ = prey;
  choices_.clear();
  PreyQuadric of = growth(prey);
  origin_ = mesh_.position(prey.vertex[0]);
  deciding_ = deciding(prey);
  if (deciding_.boundary) addVolume(test, of.quadric);
  quadric_ = of.quadric;
  const Ideal ideal = idealOf(prey, deciding_, of);
  ideal_ = ideal.offset;
  minFree_ = options_.rule == PlacementRule::kVertex ? std::numeric_limits<double>::infinity()
                                                     : dearnessOfFree(options_.rule) * ideal.cost;
  offerCheap(prey, test);
  std::ranges::sort(choices_, comesFirst);
  if (isFreeToCome() && (choices_.empty() || choices_[0].compared > minFree_)) {
    offerFree(test);
    std::ranges::sort(choices_, comesFirst);
  }
  return choices_.empty() ? std::nullopt : std::optional(choices_[0].cost);
}

bool FusionPointFinder::isHopeless(const FusionCheck& test) {
  assert(deciding_.count > 0 && deciding_.count <= prey_.k);
  const bool isDrawnOut = deciding_.boundary && !deciding_.isAll;
  if (!isDrawnOut && refused_ < kOftenRefused) return false;
  std::uint32_t moving = 0;
  for (std::uint32_t i = 0; i < prey_.k; ++i)
    moving |= std::uint32_t{!isDrawnOut || !mesh_.onBoundary(prey_.vertex[i])} << i;
  const auto flips = [&](const Choice& choice) { return test.flipsAt(choice.point, moving); };
  if (!std::ranges::all_of(choices_, flips)) return false;
  bool isHopeless = true;
  if (isFreeToCome()) {
    const std::size_t cheap = choices_.size();
    offerFree(test);
    isHopeless = std::ranges::all_of(std::span(choices_).subspan(cheap), flips);
    std::ranges::sort(choices_, comesFirst);
  }
  if (isHopeless && !isDrawnOut) count(true);
  return isHopeless;
}

std::optional<FusionPoint> FusionPointFinder::choose(const FusionCheck& test) {
  assert(deciding_.count > 0 && deciding_.count <= prey_.k);
  found_.reset();
  choose(choices_, test);
  if (isFreeToCome() && (!found_ || least_ > minFree_)) {
    const std::size_t cheap = choices_.size();
    offerFree(test);
    const auto free = std::span(choices_).subspan(cheap);
    std::ranges::sort(free, comesFirst);
    choose(free, test);
  }
  assert(!found_ || isOnLattice(found_->point, mesh_.latticeBits()));
  count(!found_);
  return found_;
}

void FusionPointFinder::count(bool isRefused) {
  refused_ += kLastShare * ((isRefused ? 1 : 0) - refused_);
  assert(refused_ >= 0 && refused_ <= 1);
}

// Asked last, as the fields' values at the point take longer than all else.
bool FusionPointFinder::flipsMoved(const LatticePoint& p, const FusionCheck& test) {
  assert(test.mayMove() == !options_.displacements.empty());
  return test.mayMove() && test.flipsMoved(p, moved_.at(prey_, p));
}

void FusionPointFinder::choose(std::span<const Choice> choices, const FusionCheck& test) {
  const double wanted = std::min(kGoodShape, test.oldShape());
  for (const Choice& choice : choices) {
    if (found_ && choice.compared >= least_) break;
    // Below this shape the point would cost more than what was found.
    const bool isBeaten = found_ && choice.compared > 0 && options_.shapeWeight > 0;
    const double minShape =
        isBeaten ? wanted / (1 + (least_ / choice.compared - 1) / options_.shapeWeight) : 0;
    const double shape = test.shapeAt(choice.point, kSurelyWorse * minShape);
    if (shape < 0) continue;
    const double worse = std::max(0.0, wanted / std::max(shape, kFlat) - 1);
    const double factor = 1 + options_.shapeWeight * worse;
    assert(factor >= 1);
    if (found_ && choice.compared * factor >= least_) continue;
    if (choice.isOutside && !test.staysNear(choice.point)) continue;
    if (flipsMoved(choice.point, test)) continue;
    assert(!choice.isOutside || test.mayLeave());
    least_ = choice.compared * factor;
    found_ = FusionPoint{choice.point, choice.cost * factor, choice.isOutside};
  }
}

}  // namespace qtet
