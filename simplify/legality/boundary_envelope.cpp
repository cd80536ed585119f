#include "simplify/legality/boundary_envelope.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "codec/mesh/predicates.h"
#include "simplify/legality/lattice_rounding.h"

namespace qtet {
namespace {

// Steps of the projection into the envelope; the last ones keep a distance that rounding to the
// lattice cannot use up.
constexpr int kProjections = 8;
constexpr int kExactProjections = 4;
constexpr double kRoundingReach = 0.87;  // sqrt(3) / 2 lattice steps

}  // namespace

void BoundaryEnvelope::gather(const Prey& prey) {
  assert(prey.k >= 2 && prey.k <= 4);
  assert(starCellsOf(mesh_, prey) <= kMaxStarCells);
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
  assert(mesh_.isLive(face.ghost) && face.moving < 3);
  const BoundaryPlane& plane = mesh_.plane(face.ghost);
  const double allowed = plane.inverseLength > 0 ? 0 : -std::numeric_limits<double>::infinity();
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
              Pair{plane.inverseLength, 0}, Pair{allowed, 0}};
  } else {
    for (std::size_t k = 0; k < 3; ++k) planes.normal[k][1] = plane.normal[k];
    planes.height[1] = height;
    planes.inverseLength[1] = plane.inverseLength;
    planes.allowed[1] = allowed;
  }
}

bool BoundaryEnvelope::turnsTooFar(const Face& face, const LatticePoint& p) const {
  assert(face.stays && face.moving < 3);
  const auto& cell = mesh_.cell(face.ghost);
  const Vector3& old = mesh_.plane(face.ghost).normal;
  const Vector3 from = mesh_.position(cell[(face.moving + 1) % 3]);
  const Vector3 normal =
      cross(mesh_.position(cell[(face.moving + 2) % 3]) - from, toVector(p) - from);
  const double along = dot(normal, old), squared = dot(old, old), least = normalCosine_;
  return squared > 0 &&
         (along <= 0 || along * along <= least * least * dot(normal, normal) * squared);
}

// Each triangle spans a tetrahedron with the first prey vertex. Triangles that go lose theirs. The
// others change theirs, as one of their corners comes to d.
VolumeChange BoundaryEnvelope::volumeChange() const {
  VolumeChange out{{}, 0, 0, faces_.size()};
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const Face& face = faces_[i];
    const auto& cell = mesh_.cell(face.ghost);
    const Vector3& normal = mesh_.plane(face.ghost).normal;
    out.area += 0.5 * std::sqrt(dot(normal, normal));
    out.change -= planes_[i / 2].height[i % 2] / 6;
    if (!face.stays) continue;
    const Vector3 next = mesh_.position(cell[(face.moving + 1) % 3]) - origin_,
                  last = mesh_.position(cell[(face.moving + 2) % 3]) - origin_;
    out.slope = out.slope + 1 / 6.0 * cross(next, last);
  }
  return out;
}

bool BoundaryEnvelope::turnsTooFar(const LatticePoint& p) const {
  return normalCosine_ >= 0 && std::ranges::any_of(faces_.all(), [&](const Face& face) {
           return face.stays && turnsTooFar(face, p);
         });
}

// `side`: how high the point lies above the face's plane, times the normal's length.
inline bool BoundaryEnvelope::isOutside(const Face& face, double side, const Probe& probe) const {
  const auto& t = mesh_.cell(face.ghost);
  const bool isSure = std::abs(side) > probe.error || probe.error == 0;
  return isSure ? side > 0
                : orientation(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]),
                              probe.point) > 0;
}

// The tetrahedra of p and each triangle that it is beyond are all that the solid gains.
bool BoundaryEnvelope::staysNear(const AllowedSpace& allowed, const LatticePoint& p,
                                 DistanceCells& known) const {
  assert(isOnLattice(p, mesh_.latticeBits()));
  const Probe probe = probeOf(p);
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (outsideOf(i / 2, probe)[i % 2] == 0) continue;
    const auto& t = mesh_.cell(faces_[i].ghost);
    if (!allowed.holds(
            {mesh_.position(t[0]), mesh_.position(t[1]), mesh_.position(t[2]), toVector(p)}, known))
      return false;
  }
  return true;
}

BoundaryEnvelope::Probe BoundaryEnvelope::probeOf(const LatticePoint& p) const {
  const Vector3 d = toVector(p) - origin_;
  return {p, both(d, d), roundingAt(d, reach_, mesh_.latticeBits())};
}

inline Pair BoundaryEnvelope::heightsOf(const Planes& planes, const Probe& probe) {
  return dot(planes.normal, probe.twice) - planes.height;
}

// Which of the two faces of planes_[i] the point lies outside of. Without a branch where a point
// lies outside if and only if doubles say so.
inline BoundaryEnvelope::Lanes BoundaryEnvelope::outsideOf(std::size_t i,
                                                           const Probe& probe) const {
  assert(i < planes().size());
  const Pair side = heightsOf(planes_[i], probe);
  if (mesh_.latticeBits() <= kExactBits) return side > 0;
  Lanes out = probe.error > 0 ? side >= -probe.error : side > 0;
  for (std::size_t lane = 0; lane < 2; ++lane)
    if (out[lane] != 0 && !isOutside(faces_[2 * i + lane], side[lane], probe)) out[lane] = 0;
  return out;
}

bool BoundaryEnvelope::holds(const LatticePoint& p) const {
  if (!isOnLattice(p, mesh_.latticeBits())) return false;
  const Probe probe = probeOf(p);
  Lanes isOutside{};
  for (std::size_t i = 0; i < planes().size(); ++i) isOutside |= outsideOf(i, probe);
  return (isOutside[0] | isOutside[1]) == 0;
}

bool BoundaryEnvelope::project(Vector3 p, LatticePoint& inside) const {
  const auto end = static_cast<double>((std::int64_t{1} << mesh_.latticeBits()) - 1);
  for (int step = 0; step <= kProjections; ++step) {
    for (std::size_t a = 0; a < 3; ++a)
      inside[a] = static_cast<std::int32_t>(std::clamp(p[a] + 0.5, 0.0, end));
    const Probe probe = probeOf(inside);
    const Vector3 past = p - toVector(inside);  // rounding's share
    const std::optional<std::size_t> face = farthestFace(probe, past);
    if (!face) return true;
    if (std::isinf(planes_[*face / 2].allowed[*face % 2])) return false;
    p = p - wayBack(*face, probe, past, step >= kExactProjections);
  }
  return false;
}

// How far two faces are from the point that lies `past` the probe, within their planes' rounding.
inline Pair BoundaryEnvelope::beyond(const Planes& planes, const Probe& probe,
                                     const TwoVectors& past) {
  return (heightsOf(planes, probe) + dot(planes.normal, past)) * planes.inverseLength -
         planes.allowed;
}

// The face that the point lies farthest outside of; of equally far faces the first one. Two faces
// at a time, without a branch where doubles are exact.
inline std::optional<std::size_t> BoundaryEnvelope::farthestFace(const Probe& probe,
                                                                 const Vector3& past) const {
  constexpr Lanes kAllButSign = ~(Lanes{} + std::numeric_limits<std::int64_t>::min());
  const TwoVectors twicePast = both(past, past);
  Pair farthest = Pair{} - 1;
  Lanes at{}, where{};
  for (std::size_t i = 0; i < planes().size(); ++i, at += 1) {
    const Pair distance = std::bit_cast<Pair>(
        std::bit_cast<Lanes>(beyond(planes_[i], probe, twicePast)) & kAllButSign);
    const Lanes isFarther = outsideOf(i, probe) & (distance > farthest);
    farthest = isFarther ? distance : farthest;
    where = isFarther ? at : where;
  }
  if (farthest[0] < 0 && farthest[1] < 0) return std::nullopt;
  const bool isSecond =
      farthest[1] != farthest[0] ? farthest[1] > farthest[0] : where[1] < where[0];
  const std::size_t face = 2 * static_cast<std::size_t>(where[isSecond]) + isSecond;
  assert(face < faces_.size());
  return face;
}

// Leads from the point back onto the plane of this face. To keep a distance, it also leads away
// from it and from every later face that the point lies outside of.
Vector3 BoundaryEnvelope::wayBack(std::size_t face, const Probe& probe, const Vector3& past,
                                  bool keepsDistance) const {
  const auto normalOf = [&](std::size_t i) -> Vector3 {
    const TwoVectors& normal = planes_[i / 2].normal;
    return {normal[0][i % 2], normal[1][i % 2], normal[2][i % 2]};
  };
  assert(face < faces_.size() && std::isfinite(planes_[face / 2].allowed[face % 2]));
  const Planes& planes = planes_[face / 2];
  const double outside = beyond(planes, probe, both(past, past))[face % 2];
  Vector3 back = (outside * planes.inverseLength[face % 2]) * normalOf(face);
  for (std::size_t i = face; keepsDistance && i < faces_.size(); ++i)
    if (outsideOf(i / 2, probe)[i % 2] != 0)
      back = back + (kRoundingReach * planes_[i / 2].inverseLength[i % 2]) * normalOf(i);
  return back;
}

}  // namespace qtet
