#include "simplify/fuse/boundary_envelope.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "codec/mesh/predicates.h"
#include "simplify/fuse/lattice_rounding.h"
#include "simplify/mesh/measure_geometry.h"

namespace qtet {
namespace {

// Steps of the projection into the envelope; the last ones keep a distance that rounding to the
// lattice cannot use up.
constexpr int kProjections = 8;
constexpr int kExactProjections = 4;
constexpr double kRoundingReach = 0.87;  // sqrt(3) / 2 lattice steps

bool isOnLattice(const LatticePoint& p, int bits) {
  const auto end = std::int64_t{1} << bits;
  return std::ranges::all_of(p, [&](std::int32_t x) { return x >= 0 && x < end; });
}

}  // namespace

void BoundaryEnvelope::gather(const Prey& prey) {
  origin_ = mesh_.position(prey.vertex[0]);
  faces_.clear();
  reach_ = 0;
  prey.k == 2 ? addFaces<2>(prey) : prey.k == 3 ? addFaces<3>(prey) : addFaces<4>(prey);
}

// The boundary triangles of each prey vertex that no earlier one has.
template <std::uint32_t k>
void BoundaryEnvelope::addFaces(const Prey& prey) {
  for (std::uint32_t i = 0; i < k; ++i) {
    const VertexId v = prey.vertex[i];
    const Vector3 from = mesh_.position(v) - origin_;
    for (const CellId c : mesh_.boundaryStar(v)) {
      const std::uint32_t side = sideOf<k>(mesh_, prey, c), own = 1u << i;
      if ((side & (own - 1)) == 0)
        addFace({c, side == own,
                 static_cast<std::uint8_t>(onlyCorner(cornersThatAre(mesh_.cell(c), v)))},
                from);
    }
  }
}

// `from`: one of its corners, relative to the first prey vertex. Where doubles are exact each gives
// the same plane.
inline void BoundaryEnvelope::addFace(const Face& face, const Vector3& from) {
  const BoundaryPlane& plane = mesh_.plane(face.ghost);
  double height = dot(plane.normal, from);
  if (mesh_.latticeBits() > kExactBits) {
    const auto cornerAt = [&](std::size_t i) {
      return mesh_.position(mesh_.cell(face.ghost)[i]) - origin_;
    };
    for (std::size_t i = 0; i < 3; ++i)
      for (const double x : cornerAt(i)) reach_ = std::max(reach_, std::abs(x));
    height = dot(plane.normal, cornerAt(0));
  }
  Planes& planes = planes_[faces_.size() / 2];
  const bool isFirst = faces_.size() % 2 == 0;
  faces_.add(face);
  if (isFirst) {
    planes = {both(plane.normal, {}), Pair{height, std::numeric_limits<double>::infinity()},
              Pair{plane.inverseLength, 0}};
  } else {
    for (std::size_t k = 0; k < 3; ++k) planes.normal[k][1] = plane.normal[k];
    planes.height[1] = height;
    planes.inverseLength[1] = plane.inverseLength;
  }
}

bool BoundaryEnvelope::turnsTooFar(const Face& face, const LatticePoint& p) const {
  const auto& cell = mesh_.cell(face.ghost);
  const Vector3& old = mesh_.plane(face.ghost).normal;
  const Vector3 from = mesh_.position(cell[(face.moving + 1) % 3]);
  const Vector3 normal =
      cross(mesh_.position(cell[(face.moving + 2) % 3]) - from, toVector(p) - from);
  const double along = dot(normal, old), squared = dot(old, old), least = normalCosine_;
  return squared > 0 &&
         (along <= 0 || along * along <= least * least * dot(normal, normal) * squared);
}

bool BoundaryEnvelope::turnsTooFar(const LatticePoint& p) const {
  return normalCosine_ >= 0 && std::ranges::any_of(faces_.all(), [&](const Face& face) {
           return face.stays && turnsTooFar(face, p);
         });
}

double BoundaryEnvelope::rounding(const Vector3& d) const {
  return roundingAt(d, reach_, mesh_.latticeBits());
}

// `side`: how high p lies above the face's plane, times the normal's length, within `error`.
inline bool BoundaryEnvelope::isOutside(const Face& face, double side, const LatticePoint& p,
                                        double error) const {
  const auto& t = mesh_.cell(face.ghost);
  const bool isSure = std::abs(side) > error || error == 0;
  const bool beyond =
      isSure ? side > 0
             : orientation(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), p) > 0;
  return beyond && (tolerance_ == 0 || distance(face, p) + mesh_.outside(face.ghost) > tolerance_);
}

// From p to the triangle. The convex hull of both is all that the solid gains there, and no point
// of it is further away.
double BoundaryEnvelope::distance(const Face& face, const LatticePoint& p) const {
  const auto& t = mesh_.cell(face.ghost);
  const Vector3 place = toVector(p);
  return std::sqrt(
      nearestOnTriangle({}, {mesh_.position(t[0]) - place, mesh_.position(t[1]) - place,
                             mesh_.position(t[2]) - place})
          .squared);
}

float BoundaryEnvelope::outsideAt(const LatticePoint& p) const {
  if (tolerance_ == 0) return 0;
  const Vector3 d = toVector(p) - origin_;
  double most = 0;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const Pair side = dot(planes_[i / 2].normal, both(d, d)) - planes_[i / 2].height;
    const bool beyond = side[i % 2] > -rounding(d);
    most = std::max(most, mesh_.outside(faces_[i].ghost) + (beyond ? distance(faces_[i], p) : 0));
  }
  const auto bound = static_cast<float>(most);
  return bound < most ? std::nextafter(bound, std::numeric_limits<float>::infinity()) : bound;
}

// Calls visit(face, side) for the faces that d may lie outside of, in their order; true as soon as
// it says so.
template <class Visit>
inline bool BoundaryEnvelope::anyFacing(const Vector3& d, double error, const Visit& visit) const {
  const double least = error > 0 ? -error : std::numeric_limits<double>::denorm_min();
  const TwoVectors twice = both(d, d);
  for (std::size_t i = 0; 2 * i < faces_.size(); ++i) {
    const Pair side = dot(planes_[i].normal, twice) - planes_[i].height;
    if ((side[0] >= least && visit(faces_[2 * i], side[0])) ||
        (side[1] >= least && visit(faces_[2 * i + 1], side[1])))
      return true;
  }
  return false;
}

inline bool BoundaryEnvelope::isExact() const {
  return mesh_.latticeBits() <= kExactBits && tolerance_ == 0;
}

bool BoundaryEnvelope::holds(const LatticePoint& p) const {
  const Vector3 d = toVector(p) - origin_;
  if (isExact()) return isOnLattice(p, mesh_.latticeBits()) && !isAnyFacing(d);
  const double error = rounding(d);
  return isOnLattice(p, mesh_.latticeBits()) &&
         !anyFacing(d, error,
                    [&](const Face& face, double side) { return isOutside(face, side, p, error); });
}

// The same of a plane that is passed, which is nearly always all that is asked: two faces at a
// time, without a branch.
inline bool BoundaryEnvelope::isAnyFacing(const Vector3& d) const {
  const TwoVectors twice = both(d, d);
  Pair farthest = Pair{} - 1;
  for (const Planes& planes : this->planes()) {
    const Pair side = dot(planes.normal, twice) - planes.height;
    farthest = side > farthest ? side : farthest;
  }
  return farthest[0] > 0 || farthest[1] > 0;
}

bool BoundaryEnvelope::project(Vector3 p, LatticePoint& inside) const {
  const auto end = static_cast<double>((std::int64_t{1} << mesh_.latticeBits()) - 1);
  for (int step = 0; step <= kProjections; ++step) {
    for (std::size_t a = 0; a < 3; ++a)
      inside[a] = static_cast<std::int32_t>(std::clamp(p[a] + 0.5, 0.0, end));
    Vector3 back{};
    switch (isExact() && step < kExactProjections ? wayBackExactly(p, inside, back)
                                                  : wayBack(p, inside, step, back)) {
      case WayBack::kInside: return true;
      case WayBack::kLost: return false;
      case WayBack::kOutside: p = p - back;
    }
  }
  return false;
}

// How far p, whose lattice point is `inside`, lies outside of the face that it is farthest outside
// of.
BoundaryEnvelope::WayBack BoundaryEnvelope::wayBack(const Vector3& p, const LatticePoint& inside,
                                                    int step, Vector3& back) const {
  const Vector3 d = toVector(inside) - origin_;
  const double error = rounding(d);
  double farthest = -1;
  const Vector3 past = p - toVector(inside);  // rounding's share
  const bool isLost = anyFacing(d, error, [&](const Face& face, double side) {
    if (!isOutside(face, side, inside, error)) return false;
    const auto& [normal, inverseLength] = mesh_.plane(face.ghost);
    if (!(inverseLength > 0)) return true;  // a sliver whose plane doubles do not know
    const double allowed =
        tolerance_ == 0 ? 0 : std::max(0.0, tolerance_ - mesh_.outside(face.ghost));
    const double outside = (side + dot(normal, past)) * inverseLength - allowed;
    if (std::abs(outside) > farthest)
      farthest = std::abs(outside), back = (outside * inverseLength) * normal;
    if (step >= kExactProjections) back = back + (kRoundingReach * inverseLength) * normal;
    return false;
  });
  return isLost ? WayBack::kLost : farthest < 0 ? WayBack::kInside : WayBack::kOutside;
}

// The same of the steps that keep no distance, two faces at a time, without a branch: no sliver is
// passed where doubles are exact, and of equally far faces the first one counts.
inline BoundaryEnvelope::WayBack BoundaryEnvelope::wayBackExactly(const Vector3& p,
                                                                  const LatticePoint& inside,
                                                                  Vector3& back) const {
  const Vector3 d = toVector(inside) - origin_, past = p - toVector(inside);
  const TwoVectors twice = both(d, d), twicePast = both(past, past);
  using Lanes = decltype(Pair{} > Pair{});
  constexpr Lanes kAllButSign = ~(Lanes{} + std::numeric_limits<std::int64_t>::min());
  const auto outsideOf = [&](const Planes& planes, const Pair& side) {
    return (side + dot(planes.normal, twicePast)) * planes.inverseLength;
  };
  Pair farthest = Pair{} - 1;
  Lanes at{}, where{};
  for (const Planes& planes : this->planes()) {
    const Pair side = dot(planes.normal, twice) - planes.height;
    const Pair distance =
        std::bit_cast<Pair>(std::bit_cast<Lanes>(outsideOf(planes, side)) & kAllButSign);
    const Lanes isFarther = (side > 0) & (distance > farthest);
    farthest = isFarther ? distance : farthest;
    where = isFarther ? at : where;
    at += 1;
  }
  if (farthest[0] < 0 && farthest[1] < 0) return WayBack::kInside;
  const bool isSecond =
      farthest[1] != farthest[0] ? farthest[1] > farthest[0] : where[1] < where[0];
  const Planes& planes = planes_[static_cast<std::size_t>(where[isSecond])];
  const Pair outside = outsideOf(planes, dot(planes.normal, twice) - planes.height);
  const Vector3 normal{planes.normal[0][isSecond], planes.normal[1][isSecond],
                       planes.normal[2][isSecond]};
  back = (outside[isSecond] * planes.inverseLength[isSecond]) * normal;
  return WayBack::kOutside;
}

}  // namespace qtet
