#include "simplify/fuse/fusion_check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/predicates.h"
#include "simplify/fuse/full_link_check.h"
#include "simplify/fuse/region_check.h"
#include "simplify/mesh/measure_geometry.h"

namespace qtet {
namespace {

// A new cell's shape may fall to a fifth of the worst of its star, or to the floor, whichever is
// lower.
constexpr double kShapeLoss = 0.2;
// Steps of the projection into the envelope; the last ones keep a distance that rounding to the
// lattice cannot use up.
constexpr int kProjections = 8;
constexpr int kExactProjections = 4;
constexpr double kRoundingReach = 0.87;  // sqrt(3) / 2 lattice steps

// In a star whose coordinates stay below 2^16 every volume below is an integer under 2^53, exact in
// doubles; where they reach r, |error| < 2^5 r^3 2^-52.
constexpr int kExactBits = 16;
constexpr double kExactReach = 1 << kExactBits;
constexpr double kRounding = 0x1p-47;

// Shape = 6 sqrt(2) V / l^3, l the root mean square edge. With v = 6 V and s = the sum of the
// squared edges its square is 432 v^2 / s^3.
constexpr double kShapeSquared = 432;

template <class T>
T shapeSquared(const T& volume6, const T& squares) {
  return kShapeSquared * volume6 * volume6 / (squares * squares * squares);
}

}  // namespace

FusionCheck::FusionCheck(const FusionMesh& mesh, const FusionLimits& limits)
    : mesh_(mesh),
      limits_(limits),
      full_(std::make_unique<FullLinkCheck>()),
      regions_(std::make_unique<RegionCheck>()) {}
FusionCheck::~FusionCheck() = default;

bool FusionCheck::gatherBoundary(const Prey& prey) {
  std::size_t size = 0;
  for (const VertexId v : prey.vertices()) size += mesh_.star(v).size();
  if (size > kMaxStarCells) return false;
  prey_ = prey;
  origin_ = mesh_.position(prey.vertex[0]);
  faceCount_ = 0;
  faceReach_ = 0;
  flipped_.fill(kNoCell);
  prey.k == 2 ? addFaces<2>() : prey.k == 3 ? addFaces<3>() : addFaces<4>();
  return true;
}

// Which of the prey's vertices cell `c` has.
template <std::uint32_t k>
inline std::uint32_t FusionCheck::sideOf(CellId c) const {
  std::uint32_t side = 0;
  for (std::uint32_t i = 0; i < k; ++i) side |= std::uint32_t{mesh_.holds(c, prey_.vertex[i])} << i;
  return side;
}

// The boundary triangles of each prey vertex that no earlier one has.
template <std::uint32_t k>
void FusionCheck::addFaces() {
  for (std::uint32_t i = 0; i < k; ++i) {
    const VertexId v = prey_.vertex[i];
    const Vector3 from = mesh_.position(v) - origin_;
    for (const CellId c : mesh_.boundaryStar(v)) {
      const std::uint32_t side = sideOf<k>(c), own = 1u << i;
      if ((side & (own - 1)) == 0)
        addFace({c, side == own,
                 static_cast<std::uint8_t>(onlyCorner(cornersThatAre(mesh_.cell(c), v)))},
                from);
    }
  }
}

bool FusionCheck::gatherRest() {
  for (const VertexId v : prey_.vertices()) mesh_.prefetchStar(v);
  star_.affected.clear(), star_.deleted.clear(), star_.labels.clear(), star_.link.clear();
  baseCount_ = innerCount_ = goingCount_ = 0;
  vertices_.clear();
  for (const VertexId v : prey_.vertices()) (void)vertices_.intern(v);
  if (prey_.k == 2 ? !addStars<2>() : prey_.k == 3 ? !addStars<3>() : !addStars<4>()) return false;
  if (star_.affected.size() > kMaxStarCells / 2) return false;
  star_.link.assign(vertices_.ids().begin() + prey_.k, vertices_.ids().end());
  measure();
  return true;
}

// The cells of each prey vertex' star, unless an earlier one's had it. False: one of them rules the
// fusion out.
template <std::uint32_t k>
bool FusionCheck::addStars() {
  for (std::uint32_t i = 0; i < k; ++i) {
    const std::uint32_t own = 1u << i;
    const std::size_t before = star_.affected.size(), known = vertices_.ids().size();
    if (k == 2 && i == 1) firstVertices_ = known, firstAffected_ = before;
    std::size_t staying = 0, going = 0;
    // parted first, since a processor cannot foresee which it is
    for (const CellId c : mesh_.star(prey_.vertex[i])) {
      const std::uint32_t side = sideOf<k>(c);
      staying_[staying] = going_[going] = c;
      staying += side == own;
      going += unsigned{side > own} & unsigned{(side & (own - 1)) == 0};
    }
    star_.affected.insert(star_.affected.end(), staying_.begin(),
                          staying_.begin() + static_cast<std::ptrdiff_t>(staying));
    star_.labels.resize(before + staying, static_cast<std::uint8_t>(i));
    std::size_t ghosts = 0;  // come first in every star
    while (ghosts < staying && mesh_.isGhost(staying_[ghosts])) ++ghosts;
    for (std::size_t at = before + ghosts; at < before + staying; ++at)
      innerCells_[innerCount_++] = static_cast<std::uint32_t>(at);
    addStaying(before, i);
    if (!addGoing<k>(going)) return false;
    for (const VertexId v : vertices_.ids().subspan(known))
      if (v != kGhost) mesh_.prefetchPoint(v);
  }
  return true;
}

// The affected cells of prey vertex `from`, which begin at `before`.
inline void FusionCheck::addStaying(std::size_t before, std::uint32_t from) {
  const VertexId v = prey_.vertex[from];
  LocalVertices::Adding adding(vertices_);
  auto* local = &turned_[before];
  for (const CellId c : std::span(star_.affected).subspan(before)) {
    const auto& cell = mesh_.cell(c);
    const auto turned = withLast(cell, onlyCorner(cornersThatAre(cell, v)));
    const std::uint32_t x = adding.intern(turned[0]), y = adding.intern(turned[1]),
                        z = adding.intern(turned[2]);
    *local++ = {x, y, z, from};
  }
}

// Those that go, in going_: more than one of their vertices is prey.
template <std::uint32_t k>
inline bool FusionCheck::addGoing(std::size_t going) {
  std::size_t mostSingular = 0;
  LocalVertices::Adding adding(vertices_);
  for (std::size_t at = 0; at < going; ++at) {
    const auto& cell = mesh_.cell(going_[at]);
    // by corner, and one place for prey vertices that the cell does not have
    std::array<std::uint32_t, 5> local{};
    unsigned prey = 0;
    for (std::uint32_t i = 0; i < k; ++i) {
      const unsigned corner = cornersThatAre(cell, prey_.vertex[i]);
      local[corner == 0 ? 4 : onlyCorner(corner)] = i;
      prey |= corner;
    }
    const OtherCorners& others = kOtherCorners[prey];
    std::array<std::uint32_t, 2> other{};
    std::size_t singular = 0;
    for (std::size_t i = 0; i < (k == 2 ? 2 : others.count); ++i) {
      const std::size_t j = others.corner[i];
      local[j] = other[i] = adding.intern(cell[j]);
      singular += cell[j] != kGhost && mesh_.singular(cell[j]);
    }
    mostSingular = std::max(mostSingular, singular);
    if (k == 2) ring_[at] = other;
    goingCells_[goingCount_] = {local[0], local[1], local[2], local[3]};
    goingCount_ += !mesh_.isGhost(going_[at]);
  }
  star_.deleted.insert(star_.deleted.end(), going_.begin(),
                       going_.begin() + static_cast<std::ptrdiff_t>(going));
  return mostSingular <= 1;  // else an edge that is not a manifold's could be fused away unseen
}

// What needs positions, once all of them have been asked for.
void FusionCheck::measure() {
  const std::span<const VertexId> ids = vertices_.ids();
  for (std::size_t i = 0; i < ids.size(); ++i)
    places_[i] = ids[i] == kGhost ? Vector3{} : mesh_.position(ids[i]) - origin_;
  reach_ = 0;
  if (mesh_.latticeBits() > kExactBits)
    for (const Vector3& p : std::span(places_).first(ids.size()))
      for (const double x : p) reach_ = std::max(reach_, std::abs(x));
  worst_ = 1;
  suspect_ = 0;
  for (std::size_t i = 0; i < innerCount_; i += 2)
    addBases(innerCells_[i], innerCells_[std::min(i + 1, innerCount_ - 1)]);
  for (std::size_t i = 0; i < goingCount_; i += 2)
    measureGoing(i, std::min(i + 1, goingCount_ - 1));
  oldShape_ = std::sqrt(worst_);
  const double floor = std::min(limits_.shapeFloor, kShapeLoss * oldShape_);
  floorSquared_ = floor * floor;
}

// Two cells of the star as it is.
inline void FusionCheck::see(const Pair& volume, const Pair& squares) {
  const Pair shape = shapeSquared(volume, squares);
  for (int lane = 0; lane < 2; ++lane)
    worst_ = std::min(worst_, volume[lane] > 0 ? shape[lane] : 0);
}

void FusionCheck::addBases(std::uint32_t i, std::uint32_t j) {
  const auto& s = turned_[i];
  const auto& t = turned_[j];
  const TwoVectors a = both(places_[s[0]], places_[t[0]]), b = both(places_[s[1]], places_[t[1]]),
                   c = both(places_[s[2]], places_[t[2]]);
  const TwoVectors ab = b - a, ac = c - a, bc = c - b;
  Bases& bases = bases_[baseCount_++];
  bases.normal = cross(ab, ac);
  bases.height = dot(bases.normal, a);
  bases.corners = a + b + c;
  bases.squares = dot(ab, ab) + dot(ac, ac) + dot(bc, bc) + dot(a, a) + dot(b, b) + dot(c, c);
  bases.cell = {i, j};
  const TwoVectors apex = both(places_[s[3]], places_[t[3]]);
  see(dot(bases.normal, apex) - bases.height,
      bases.squares + 3 * dot(apex, apex) - 2 * dot(apex, bases.corners));
}

void FusionCheck::measureGoing(std::size_t i, std::size_t j) {
  const auto& s = goingCells_[i];
  const auto& t = goingCells_[j];
  const TwoVectors a = both(places_[s[0]], places_[t[0]]);
  const TwoVectors ab = both(places_[s[1]], places_[t[1]]) - a,
                   ac = both(places_[s[2]], places_[t[2]]) - a,
                   ad = both(places_[s[3]], places_[t[3]]) - a;
  const TwoVectors bc = ac - ab, bd = ad - ab, cd = ad - ac;
  see(dot(cross(ab, ac), ad),
      dot(ab, ab) + dot(ac, ac) + dot(ad, ad) + dot(bc, bc) + dot(bd, bd) + dot(cd, cd));
}

// `from`: one of its corners, relative to the first prey vertex. Where doubles are exact each gives
// the same plane.
inline void FusionCheck::addFace(const Face& face, const Vector3& from) {
  const BoundaryPlane& plane = mesh_.plane(face.ghost);
  double height = dot(plane.normal, from);
  if (mesh_.latticeBits() > kExactBits) {
    const auto cornerAt = [&](std::size_t i) {
      return mesh_.position(mesh_.cell(face.ghost)[i]) - origin_;
    };
    for (std::size_t i = 0; i < 3; ++i)
      for (const double x : cornerAt(i)) faceReach_ = std::max(faceReach_, std::abs(x));
    height = dot(plane.normal, cornerAt(0));
  }
  faces_[faceCount_] = face;
  Planes& planes = planes_[faceCount_ / 2];
  if (faceCount_++ % 2 == 0) {
    planes = {both(plane.normal, {}), Pair{height, std::numeric_limits<double>::infinity()},
              Pair{plane.inverseLength, 0}};
  } else {
    for (std::size_t k = 0; k < 3; ++k) planes.normal[k][1] = plane.normal[k];
    planes.height[1] = height;
    planes.inverseLength[1] = plane.inverseLength;
  }
}

// The cell of prey vertex i turns from positive to flat or inverted, further than `error`. Nothing
// is said of one that goes.
inline bool FusionCheck::flips(std::uint32_t i, CellId c, const Vector3& place,
                               double error) const {
  const auto& cell = mesh_.cell(c);
  for (std::uint32_t j = 0; j < prey_.k; ++j)
    if (j != i && mesh_.holds(c, prey_.vertex[j])) return false;
  const VertexId v = prey_.vertex[i];
  const auto t = withLast(cell, (cell[1] == v) + 2 * (cell[2] == v) + 3 * (cell[3] == v));
  const Vector3 corner = mesh_.position(t[0]),
                normal = cross(mesh_.position(t[1]) - corner, mesh_.position(t[2]) - corner);
  return dot(normal, place - corner) <= -error && dot(normal, mesh_.position(v) - corner) > error;
}

bool FusionCheck::flipsAt(const LatticePoint& p, std::uint32_t moving) const {
  const Vector3 place = toVector(p);
  // Coordinates reach as far as the lattice; what is too close to call is not called.
  const double error =
      mesh_.latticeBits() <= kExactBits ? 0 : kRounding * std::ldexp(1.0, 3 * mesh_.latticeBits());
  for (std::uint32_t i = 0; i < prey_.k; ++i)
    if ((moving >> i & 1) != 0 && flipped_[i] != kNoCell && flips(i, flipped_[i], place, error))
      return true;
  for (std::uint32_t i = 0; i < prey_.k; ++i) {
    if ((moving >> i & 1) == 0 || mesh_.point(prey_.vertex[i]) == p) continue;
    const auto cells = mesh_.innerStar(prey_.vertex[i]);
    const auto flipped =
        std::ranges::find_if(cells, [&](CellId c) { return flips(i, c, place, error); });
    if (flipped == cells.end()) continue;
    flipped_[i] = *flipped;
    return true;
  }
  return false;
}

double FusionCheck::shapeAt(const LatticePoint& p, double least) const {
  const Vector3 d = toVector(p) - origin_;
  const double distance = 3 * dot(d, d), rounding = this->rounding(d, reach_);
  const TwoVectors twice = both(d, d);
  const double floorSquared = std::max(floorSquared_, least * least);
  double worst = 1;
  for (std::size_t n = 0; n < baseCount_; ++n) {
    const std::size_t i = n == 0 ? suspect_ : n == suspect_ ? 0 : n;
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
  if (limits_.normalCosine >= 0)
    for (const Face& face : faces())
      if (face.stays && turnsTooFar(face, p)) return -1;
  return std::sqrt(worst);
}

bool FusionCheck::turnsTooFar(const Face& face, const LatticePoint& p) const {
  const auto& cell = mesh_.cell(face.ghost);
  const Vector3& old = mesh_.plane(face.ghost).normal;
  const Vector3 from = mesh_.position(cell[(face.moving + 1) % 3]);
  const Vector3 normal =
      cross(mesh_.position(cell[(face.moving + 2) % 3]) - from, toVector(p) - from);
  const double along = dot(normal, old), squared = dot(old, old), least = limits_.normalCosine;
  return squared > 0 &&
         (along <= 0 || along * along <= least * least * dot(normal, normal) * squared);
}

/// What volumes with an apex at d over triangles of this reach may be off by.
double FusionCheck::rounding(const Vector3& d, double placesReach) const {
  if (mesh_.latticeBits() <= kExactBits) return 0;
  const double reach = std::max({placesReach, std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  return reach < kExactReach ? 0 : kRounding * reach * reach * reach;
}

bool FusionCheck::onLattice(const LatticePoint& p) const {
  const auto end = std::int64_t{1} << mesh_.latticeBits();
  return std::ranges::all_of(p, [&](std::int32_t x) { return x >= 0 && x < end; });
}

/// For what is too close to call in doubles, flat or inverted. The latter two are allowed only
/// where the cell was no better.
double FusionCheck::exactVolume6(std::uint32_t affected, const LatticePoint& p,
                                 bool& allowed) const {
  const auto& cell = mesh_.cell(star_.affected[affected]);
  const VertexId apex = prey_.vertex[star_.labels[affected]];
  const auto t =
      withLast(cell, static_cast<std::size_t>(std::ranges::find(cell, apex) - cell.begin()));
  const Int128 volume = volume6(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), p);
  allowed = volume > 0;
  if (!allowed) {
    const Int128 old =
        volume6(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
    allowed = old <= 0 && volume >= old;
  }
  return static_cast<double>(volume);
}

// `side`: how high p lies above the face's plane, times the normal's length, within `error`.
inline bool FusionCheck::isOutside(const Face& face, double side, const LatticePoint& p,
                                   double error) const {
  const auto& t = mesh_.cell(face.ghost);
  const bool isSure = std::abs(side) > error || error == 0;
  const bool beyond =
      isSure ? side > 0
             : orientation(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), p) > 0;
  return beyond && (limits_.envelopeTolerance == 0 ||
                    distance(face, p) + mesh_.outside(face.ghost) > limits_.envelopeTolerance);
}

// From p to the triangle. The convex hull of both is all that the solid gains there, and no point
// of it is further away.
double FusionCheck::distance(const Face& face, const LatticePoint& p) const {
  const auto& t = mesh_.cell(face.ghost);
  const Vector3 place = toVector(p);
  return std::sqrt(
      nearestOnTriangle({}, {mesh_.position(t[0]) - place, mesh_.position(t[1]) - place,
                             mesh_.position(t[2]) - place})
          .squared);
}

float FusionCheck::outsideAt(const LatticePoint& p) const {
  if (limits_.envelopeTolerance == 0) return 0;
  const Vector3 d = toVector(p) - origin_;
  double most = 0;
  for (std::size_t i = 0; i < faceCount_; ++i) {
    const Pair side = dot(planes_[i / 2].normal, both(d, d)) - planes_[i / 2].height;
    const bool beyond = side[i % 2] > -rounding(d, faceReach_);
    most = std::max(most, mesh_.outside(faces_[i].ghost) + (beyond ? distance(faces_[i], p) : 0));
  }
  const auto bound = static_cast<float>(most);
  return bound < most ? std::nextafter(bound, std::numeric_limits<float>::infinity()) : bound;
}

// Calls visit(face, side) for the faces that d may lie outside of, in their order; true as soon as
// it says so.
template <class Visit>
inline bool FusionCheck::anyFacing(const Vector3& d, double error, const Visit& visit) const {
  const double least = error > 0 ? -error : std::numeric_limits<double>::denorm_min();
  const TwoVectors twice = both(d, d);
  for (std::size_t i = 0; 2 * i < faceCount_; ++i) {
    const Pair side = dot(planes_[i].normal, twice) - planes_[i].height;
    if ((side[0] >= least && visit(faces_[2 * i], side[0])) ||
        (side[1] >= least && visit(faces_[2 * i + 1], side[1])))
      return true;
  }
  return false;
}

inline bool FusionCheck::isEnvelopeExact() const {
  return mesh_.latticeBits() <= kExactBits && limits_.envelopeTolerance == 0;
}

bool FusionCheck::insideEnvelope(const LatticePoint& p) const {
  const Vector3 d = toVector(p) - origin_;
  if (isEnvelopeExact()) return onLattice(p) && !isAnyFacing(d);
  const double error = rounding(d, faceReach_);
  return onLattice(p) && !anyFacing(d, error, [&](const Face& face, double side) {
           return isOutside(face, side, p, error);
         });
}

// The same of a plane that is passed, which is nearly always all that is asked: two faces at a
// time, without a branch.
inline bool FusionCheck::isAnyFacing(const Vector3& d) const {
  const TwoVectors twice = both(d, d);
  Pair farthest = Pair{} - 1;
  for (const Planes& planes : std::span(planes_).first((faceCount_ + 1) / 2)) {
    const Pair side = dot(planes.normal, twice) - planes.height;
    farthest = side > farthest ? side : farthest;
  }
  return farthest[0] > 0 || farthest[1] > 0;
}

bool FusionCheck::projectInside(Vector3 p, LatticePoint& inside) const {
  const auto end = static_cast<double>((std::int64_t{1} << mesh_.latticeBits()) - 1);
  for (int step = 0; step <= kProjections; ++step) {
    for (std::size_t a = 0; a < 3; ++a)
      inside[a] = static_cast<std::int32_t>(std::clamp(p[a] + 0.5, 0.0, end));
    Vector3 back{};
    switch (isEnvelopeExact() && step < kExactProjections ? wayBackExactly(p, inside, back)
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
FusionCheck::WayBack FusionCheck::wayBack(const Vector3& p, const LatticePoint& inside, int step,
                                          Vector3& back) const {
  const Vector3 d = toVector(inside) - origin_;
  const double error = rounding(d, faceReach_);
  double farthest = -1;
  const Vector3 past = p - toVector(inside);  // rounding's share
  const bool isLost = anyFacing(d, error, [&](const Face& face, double side) {
    if (!isOutside(face, side, inside, error)) return false;
    const auto& [normal, inverseLength] = mesh_.plane(face.ghost);
    if (!(inverseLength > 0)) return true;  // a sliver whose plane doubles do not know
    const double allowed =
        limits_.envelopeTolerance == 0
            ? 0
            : std::max(0.0, limits_.envelopeTolerance - mesh_.outside(face.ghost));
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
inline FusionCheck::WayBack FusionCheck::wayBackExactly(const Vector3& p,
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
  for (const Planes& planes : std::span(planes_).first((faceCount_ + 1) / 2)) {
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

bool FusionCheck::keepsTopology() {
  if (prey_.k == 2 ? !edgeKeepsTopology() : !full_->passes(mesh_, prey_, star_)) return false;
  return !mesh_.hasRegions() || regions_->passes(mesh_, prey_, star_);
}

// The link condition of Dey, Edelsbrunner, Guha and Nekhayev in the complex completed by the ghost:
// the links of the two vertices meet in the edge's link and nowhere else. That link is one cycle,
// since neither vertex is singular.
bool FusionCheck::edgeKeepsTopology() {
  const std::span<RingVertex> vertices = std::span(ringVertices_).first(vertices_.ids().size());
  std::ranges::fill(vertices, RingVertex{});
  for (std::size_t i = firstAffected_; i < star_.affected.size(); ++i)
    for (std::size_t j = 0; j < 3; ++j) vertices[turned_[i][j]].own = 1;
  for (const auto& [x, y] : ring()) vertices[x].own = vertices[y].own = 1;
  std::size_t common = 0;
  for (RingVertex& v : vertices.first(firstVertices_)) {
    const Mask isCommon = v.own;
    v.own = isCommon << (common % kMaxRing);
    common += isCommon;
  }
  for (RingVertex& v : vertices.subspan(firstVertices_)) v.own = 0;
  if (common != ring().size()) return false;
  if (common > kMaxRing) return full_->passes(mesh_, prey_, star_);
  for (const auto& [x, y] : ring()) {
    vertices[x].joined |= vertices[y].own;
    vertices[y].joined |= vertices[x].own;
  }
  const auto hasTwo = [](Mask mask) {
    const Mask allButOne = mask & (mask - 1);
    return allButOne != 0 && (allButOne & (allButOne - 1)) == 0;
  };
  for (const auto& [x, y] : ring())
    if (!hasTwo(vertices[x].joined) || !hasTwo(vertices[y].joined)) return false;
  return !hasCommonChord() && !(common == 3 && hasCommonTriangle());
}

// An edge between two vertices of the ring that is in both links but not in the ring. Each link is
// closed, so that it has every edge in both directions.
bool FusionCheck::hasCommonChord() {
  for (std::size_t i = 0; i < star_.affected.size(); ++i) {
    const auto& t = turned_[i];
    for (std::size_t e = 0; e < 3; ++e) {
      RingVertex& from = ringVertices_[t[e]];
      from.chords[t[3]] |= ringVertices_[t[(e + 1) % 3]].own & ~from.joined;
    }
  }
  Mask inBoth = 0;
  for (const RingVertex& v : std::span(ringVertices_).first(vertices_.ids().size()))
    inBoth |= v.chords[0] & v.chords[1];
  return inBoth != 0;
}

// A triangle that fills a ring of three in both.
bool FusionCheck::hasCommonTriangle() const {
  unsigned filled = 0;
  for (std::size_t i = 0; i < star_.affected.size(); ++i) {
    const auto& t = turned_[i];
    const Mask corners =
        ringVertices_[t[0]].own | ringVertices_[t[1]].own | ringVertices_[t[2]].own;
    filled |= unsigned{corners == 7} << t[3];
  }
  return filled == 3;
}

}  // namespace qtet
