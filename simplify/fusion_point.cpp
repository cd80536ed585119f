#include "simplify/fusion_point.h"

#include <algorithm>
#include <cmath>

namespace qtet {
namespace {

// How far (in radii of the prey) a quadric's minimum may lie from the prey's barycentre before it counts as ill-conditioned.
constexpr double kReach = 1.5;
// A star shaped better than this asks no more of its new cells (1 = regular, 0 = flat).
constexpr double kGoodShape = 0.3;
// Flat cells that were flat before cost no more than this shape does.
constexpr double kFlat = 1e-6;

// A free point takes twice the bits of one that follows from its prey; it has to be worth them.
constexpr double kFreeDearness = 2;

LatticePoint rounded(const Vector3& p) {
  LatticePoint out{};
  for (std::size_t a = 0; a < 3; ++a) out[a] = static_cast<std::int32_t>(std::floor(p[a] + 0.5));
  return out;
}

}  // namespace

// The prey vertices that decide: those on the boundary where there are any, else those between regions, else all.
FusionPointFinder::Deciding FusionPointFinder::deciding(const Prey& prey) const {
  Deciding out;
  std::size_t boundary = 0, surface = 0;
  for (const VertexId v : prey.vertices()) boundary += mesh_.onBoundary(v), surface += mesh_.onSurface(v);
  out.boundary = boundary > 0;
  for (std::size_t i = 0; i < prey.k; ++i)
    if (surface == 0 || (boundary > 0 ? mesh_.onBoundary(prey.vertex[i]) : mesh_.onSurface(prey.vertex[i])))
      out.vertex[out.count++] = prey.vertex[i];
  for (std::size_t i = 0; i < out.count; ++i) out.centre = out.centre + (mesh_.position(out.vertex[i]) - mesh_.position(prey.vertex[0]));
  out.centre = (1.0 / static_cast<double>(out.count)) * out.centre;
  return out;
}

FusionPointFinder::Ideal FusionPointFinder::idealOf(const Prey& prey, const Deciding& deciding, const PreyQuadric& of) const {
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

FusionPointFinder::Ideal FusionPointFinder::ideal(const Prey& prey) const { return idealOf(prey, deciding(prey), cost_.of(prey)); }

void FusionPointFinder::offer(const LatticePoint& p, double dearness) {
  for (const Choice& c : choices_)
    if (c.point == p) return;
  choices_.push_back({p, quadric_.at(toVector(p) - origin_), dearness});
}

// What takes few bits comes first, so that a free point which falls on one of them is that one.
void FusionPointFinder::offerChoices(const Prey& prey, const FusionTest& test) {
  choices_.clear();
  const PreyQuadric of = cost_.of(prey);
  quadric_ = of.quadric;
  origin_ = mesh_.position(prey.vertex[0]);
  const Deciding deciding = this->deciding(prey);
  const auto offerInside = [&](const LatticePoint& p) {
    if (!deciding.boundary || test.insideEnvelope(p)) offer(p);
  };
  for (std::size_t i = 0; i < deciding.count; ++i) offerInside(mesh_.point(deciding.vertex[i]));
  if (options_.rule == PlacementRule::kVertex) return;
  if (deciding.count == prey.k) {
    std::array<LatticePoint, 4> at{};
    for (std::size_t i = 0; i < prey.k; ++i) at[i] = mesh_.point(prey.vertex[i]);
    offerInside(middle(std::span(at).first(prey.k)));
    if (prey.k == 2) {
      offerInside(quarter(at[0], at[1]));
      offerInside(quarter(at[1], at[0]));
    }
  }
  offerFree(prey, deciding, of, test);
}

void FusionPointFinder::offerFree(const Prey& prey, const Deciding& deciding, const PreyQuadric& of, const FusionTest& test) {
  const Vector3 middle = origin_ + deciding.centre;
  const Vector3 best = origin_ + idealOf(prey, deciding, of).offset;
  for (const Vector3& p : {best, 0.5 * (best + middle), middle}) {
    LatticePoint inside = rounded(p);
    if (!deciding.boundary || test.projectInside(p, inside)) offer(inside, options_.rule == PlacementRule::kAuto ? kFreeDearness : 1);
  }
}

std::optional<FusionPoint> FusionPointFinder::find(const Prey& prey, const FusionTest& test) {
  offerChoices(prey, test);
  const auto compared = [](const Choice& c) { return c.dearness * c.cost; };
  std::sort(choices_.begin(), choices_.end(), [&](const Choice& a, const Choice& b) {
    return compared(a) != compared(b) ? compared(a) < compared(b) : a.point < b.point;
  });
  std::optional<FusionPoint> found;
  double least = 0;  // as compared, shape included
  const double wanted = std::min(kGoodShape, test.oldShape());
  for (const Choice& choice : choices_) {
    if (found && compared(choice) >= least) break;
    const double shape = test.shapeAt(choice.point);
    if (shape < 0) continue;
    const double factor = shape < wanted ? 1 + options_.shapeWeight * (wanted / std::max(shape, kFlat) - 1) : 1;
    if (found && compared(choice) * factor >= least) continue;
    least = compared(choice) * factor;
    found = FusionPoint{choice.point, choice.cost * factor, 0};
  }
  if (found) found->outside = test.outsideAt(found->point);
  return found;
}

}  // namespace qtet
