#include "simplify/legality/star_shapes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/predicates.h"
#include "simplify/legality/lattice_rounding.h"

namespace qtet {
namespace {

// A new cell's shape may fall to a fifth of the worst of its star, or to the floor, whichever is
// lower.
constexpr double kShapeLoss = 0.2;

// Shape = 6 sqrt(2) V / l^3, l the root mean square edge. If v = 6 V and s is the sum of the
// squared edges, its square is 432 v^2 / s^3.
constexpr double kShapeSquared = 432;

template <class T>
T shapeSquared(const T& volume6, const T& squares) {
  return kShapeSquared * volume6 * volume6 / (squares * squares * squares);
}

// The worse squared shape of two cells.
double worstSquared(const Pair& volume6, const Pair& squares) {
  const Pair shape = shapeSquared(volume6, squares);
  return std::min(volume6[0] > 0 ? shape[0] : 0, volume6[1] > 0 ? shape[1] : 0);
}

double worstSquared(const std::array<std::uint32_t, 4>& s, const std::array<std::uint32_t, 4>& t,
                    std::span<const Vector3> places) {
  const TwoVectors a = both(places[s[0]], places[t[0]]);
  const TwoVectors ab = both(places[s[1]], places[t[1]]) - a,
                   ac = both(places[s[2]], places[t[2]]) - a,
                   ad = both(places[s[3]], places[t[3]]) - a;
  const TwoVectors bc = ac - ab, bd = ad - ab, cd = ad - ac;
  return worstSquared(dot(cross(ab, ac), ad), dot(ab, ab) + dot(ac, ac) + dot(ad, ad) +
                                                  dot(bc, bc) + dot(bd, bd) + dot(cd, cd));
}

}  // namespace

void StarShapes::measure() {
  assert(!star_.vertices().empty());
  const std::span<const VertexId> ids = star_.vertices();
  origin_ = mesh_.position(ids[0]);
  std::array<Vector3, LocalVertices::kMax> room;
  for (std::size_t i = 0; i < ids.size(); ++i)
    room[i] = ids[i] == kGhost ? Vector3{} : mesh_.position(ids[i]) - origin_;
  const Places places = std::span(room).first(ids.size());
  reach_ = 0;
  if (mesh_.latticeBits() > kExactBits)
    for (const Vector3& p : places)
      for (const double x : p) reach_ = std::max(reach_, std::abs(x));
  double worst = 1;
  bases_.clear();
  suspect_ = 0;
  const std::span<const std::uint32_t> inner = star_.inner();
  for (std::size_t i = 0; i < inner.size(); i += 2)
    worst = std::min(worst, addBases(inner[i], inner[std::min(i + 1, inner.size() - 1)], places));
  const auto deleted = star_.innerDeleted();
  for (std::size_t i = 0; i < deleted.size(); i += 2)
    worst = std::min(
        worst, worstSquared(deleted[i], deleted[std::min(i + 1, deleted.size() - 1)], places));
  assert(worst >= 0 && worst <= 1);
  old_ = std::sqrt(worst);
}

// Returns the worse shape of the two as they are, squared.
inline double StarShapes::addBases(std::uint32_t i, std::uint32_t j, Places places) {
  assert(i < star_.turned().size() && j < star_.turned().size());
  const auto& s = star_.turned()[i];
  const auto& t = star_.turned()[j];
  const TwoVectors a = both(places[s[0]], places[t[0]]), b = both(places[s[1]], places[t[1]]),
                   c = both(places[s[2]], places[t[2]]);
  const TwoVectors ab = b - a, ac = c - a, bc = c - b;
  Bases bases;
  bases.normal = cross(ab, ac);
  bases.height = dot(bases.normal, a);
  bases.corners = a + b + c;
  bases.squares = dot(ab, ab) + dot(ac, ac) + dot(bc, bc) + dot(a, a) + dot(b, b) + dot(c, c);
  bases.cell = {i, j};
  bases_.add(bases);
  const TwoVectors apex = both(places[s[3]], places[t[3]]);
  return worstSquared(dot(bases.normal, apex) - bases.height,
                      bases.squares + 3 * dot(apex, apex) - 2 * dot(apex, bases.corners));
}

double StarShapes::at(const LatticePoint& p, double least) const {
  assert(bases_.size() == (star_.inner().size() + 1) / 2);
  assert(least >= 0 && old_ >= 0 && old_ <= 1);
  const Vector3 d = toVector(p) - origin_;
  const double distance = 3 * dot(d, d), rounding = roundingAt(d, reach_, mesh_.latticeBits());
  const TwoVectors twice = both(d, d);
  const double floor = std::min(floor_, kShapeLoss * old_);
  const double floorSquared = std::max(floor * floor, least * least);
  double worst = 1;
  for (std::size_t n = 0; n < bases_.size(); ++n) {
    const std::size_t i = n == 0 ? suspect_ : n == suspect_ ? 0 : n;
    assert(i < bases_.size());
    const Bases& bases = bases_[i];
    Pair volume = dot(bases.normal, twice) - bases.height;
    Pair squares = bases.squares + distance - 2 * dot(twice, bases.corners);
    for (int lane = 0; lane < 2; ++lane) {
      if (volume[lane] > rounding) continue;
      bool allowed = false;
      volume[lane] = exactVolume6(bases.cell[static_cast<std::size_t>(lane)], p, allowed);
      if (!allowed) {
        suspect_ = i;
        return -1;
      }
      // flat, as it was: its shape does not count
      if (volume[lane] <= 0) volume[lane] = squares[lane] = 1;
    }
    const Pair shape = shapeSquared(volume, squares);
    worst = std::min(worst, std::min(shape[0], shape[1]));
    if (worst < floorSquared) {
      suspect_ = i;
      return -1;
    }
  }
  return std::sqrt(worst);
}

/// The exact volume, for what is too close to call in doubles, flat or inverted. The latter two are
/// allowed only where the cell was no better.
double StarShapes::exactVolume6(std::uint32_t affected, const LatticePoint& p,
                                bool& allowed) const {
  const Star& star = star_.star();
  assert(affected < star.affected.size() && star.labels[affected] < star_.prey().k);
  const auto& cell = mesh_.cell(star.affected[affected]);
  const VertexId apex = star_.prey().vertex[star.labels[affected]];
  const auto t = withLast(cell, onlyCorner(cornersThatAre(cell, apex)));
  const Int128 volume = volume6(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), p);
  allowed = volume > 0;
  if (!allowed) {
    const Int128 old =
        volume6(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
    allowed = old <= 0 && volume >= old;
  }
  return static_cast<double>(volume);
}

}  // namespace qtet
