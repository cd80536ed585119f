#include "simplify/fusion_test.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "codec/growing_mesh.h"
#include "codec/predicates.h"
#include "simplify/full_link_test.h"
#include "simplify/measure_geometry.h"
#include "simplify/region_test.h"

namespace qtet {
namespace {

// A new cell's shape may fall to a fifth of the worst of its star, or to the floor, whichever is lower.
constexpr double kShapeLoss = 0.2;
// Steps of the projection into the envelope; the last ones keep a distance that rounding to the lattice cannot use up.
constexpr int kProjections = 8;
constexpr int kExactProjections = 4;
constexpr double kRoundingReach = 0.87;  // sqrt(3) / 2 lattice steps

// In a star whose coordinates stay below 2^16 every volume below is an integer under 2^53, exact in doubles; where they reach r, |error| < 2^5 r^3 2^-52.
constexpr int kExactBits = 16;
constexpr double kExactReach = 1 << kExactBits;
constexpr double kRounding = 0x1p-47;

// Shape = 6 sqrt(2) V / l^3, l the root mean square edge. With v = 6 V and s = the sum of the squared edges its square is 432 v^2 / s^3.
constexpr double kShapeSquared = 432;

template <class T>
T shapeSquared(const T& volume6, const T& squares) {
  return kShapeSquared * volume6 * volume6 / (squares * squares * squares);
}

}  // namespace

FusionTest::FusionTest(const FusionMesh& mesh, const FusionLimits& limits)
    : mesh_(mesh), limits_(limits), full_(std::make_unique<FullLinkTest>()), regions_(std::make_unique<RegionTest>()) {}
FusionTest::~FusionTest() = default;

bool FusionTest::gatherBoundary(const Prey& prey) {
  std::size_t size = 0;
  for (const VertexId v : prey.vertices()) size += mesh_.star(v).size();
  if (size > kMostStarCells) return false;
  prey_ = prey;
  origin_ = mesh_.position(prey.vertex[0]);
  faceCount_ = 0;
  faceReach_ = 0;
  flipped_.fill(kNoCell);
  prey.k == 2 ? addFaces<2>() : prey.k == 3 ? addFaces<3>() : addFaces<4>();
  return true;
}

// The boundary triangles of each prey vertex that no earlier one has.
template <std::uint32_t k>
void FusionTest::addFaces() {
  for (std::uint32_t i = 0; i < k; ++i) {
    const VertexId v = prey_.vertex[i];
    const Vector3 from = mesh_.position(v) - origin_;
    for (const CellId c : mesh_.boundaryStar(v)) {
      const auto& cell = mesh_.cell(c);
      std::uint32_t side = 0;
      for (std::uint32_t j = 0; j < k; ++j) {
        const VertexId w = prey_.vertex[j];
        side |= (std::uint32_t{cell[0] == w} | std::uint32_t{cell[1] == w} | std::uint32_t{cell[2] == w}) << j;
      }
      const std::uint32_t own = 1u << i;
      if ((side & (own - 1)) == 0) addFace({c, side == own, static_cast<std::uint8_t>((cell[1] == v) + 2 * (cell[2] == v))}, from);
    }
  }
}

bool FusionTest::gatherRest() {
  for (const VertexId v : prey_.vertices()) mesh_.prefetchStar(v);
  star_.affected.clear(), star_.deleted.clear(), star_.labels.clear(), star_.link.clear();
  ring_.clear(), goingCells_.clear();
  baseCount_ = 0;
  vertices_.clear();
  for (const VertexId v : prey_.vertices()) (void)vertices_.intern(v);
  if (prey_.k == 2 ? !addStars<2>() : prey_.k == 3 ? !addStars<3>() : !addStars<4>()) return false;
  if (star_.affected.size() > kMostStarCells / 2) return false;
  star_.link.assign(vertices_.ids().begin() + prey_.k, vertices_.ids().end());
  measure();
  return true;
}

template <std::uint32_t k>
bool FusionTest::addStars() {
  for (std::uint32_t i = 0; i < k; ++i)
    for (const CellId c : mesh_.star(prey_.vertex[i]))
      if (!addCell<k>(c, i)) return false;
  return true;
}

// A cell of the star of prey vertex `from`, unless an earlier one's star had it. False: it rules the fusion out.
template <std::uint32_t k>
inline bool FusionTest::addCell(CellId c, std::uint32_t from) {
  const auto& cell = mesh_.cell(c);
  const auto is = [&](std::size_t corner, VertexId v) { return static_cast<std::uint32_t>(cell[corner] == v); };
  std::uint32_t side = 0;
  for (std::uint32_t i = 0; i < k; ++i) {
    const VertexId v = prey_.vertex[i];
    side |= (is(0, v) | is(1, v) | is(2, v) | is(3, v)) << i;
  }
  const std::uint32_t own = 1u << from;
  if ((side & (own - 1)) != 0) return true;
  if (side != own) return addGoing(c, side);
  const VertexId v = prey_.vertex[from];
  const auto turned = withLast(cell, is(1, v) + 2 * is(2, v) + 3 * is(3, v));
  auto& local = turned_[star_.affected.size()];
  for (std::size_t j = 0; j < 3; ++j) {
    local[j] = intern(turned[j]);
    sides_[local[j]] |= static_cast<std::uint8_t>(own);
  }
  local[3] = from;
  star_.affected.push_back(c);
  star_.labels.push_back(static_cast<std::uint8_t>(from));
  return true;
}

// One that goes: more than one of its vertices is prey.
bool FusionTest::addGoing(CellId c, std::uint32_t side) {
  const auto& cell = mesh_.cell(c);
  std::array<std::uint32_t, 4> local{}, others{};
  std::size_t n = 0, singular = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    const auto prey = prey_.vertices();
    const auto at = static_cast<std::size_t>(std::ranges::find(prey, cell[j]) - prey.begin());
    local[j] = static_cast<std::uint32_t>(at);
    if (at < prey.size()) continue;
    local[j] = others[n++] = intern(cell[j]);
    sides_[local[j]] |= static_cast<std::uint8_t>(side);
    singular += cell[j] != kGhost && mesh_.singular(cell[j]);
  }
  star_.deleted.push_back(c);
  if (prey_.k == 2) ring_.push_back({others[0], others[1]});
  if (!mesh_.isGhost(c)) goingCells_.push_back(local);
  return singular <= 1;  // else an edge that is not a manifold's could be fused away unseen
}

inline std::uint32_t FusionTest::intern(VertexId v) {
  const std::size_t known = vertices_.ids().size();
  const std::uint32_t local = vertices_.intern(v);
  if (local == known) {
    sides_[local] = 0;
    if (v != kGhost) mesh_.prefetchPoint(v);
  }
  return local;
}

// What needs positions, once all of them have been asked for.
void FusionTest::measure() {
  const std::span<const VertexId> ids = vertices_.ids();
  for (std::size_t i = 0; i < ids.size(); ++i) places_[i] = ids[i] == kGhost ? Vector3{} : mesh_.position(ids[i]) - origin_;
  reach_ = 0;
  if (mesh_.latticeBits() > kExactBits)
    for (const Vector3& p : std::span(places_).first(ids.size()))
      for (const double x : p) reach_ = std::max(reach_, std::abs(x));
  worst_ = 1;
  suspect_ = 0;
  constexpr auto kNone = ~std::uint32_t{0};
  std::uint32_t waiting = kNone;
  for (std::uint32_t i = 0; i < star_.affected.size(); ++i) {
    if (mesh_.isGhost(star_.affected[i])) continue;
    if (waiting != kNone) addBases(waiting, i);
    waiting = waiting == kNone ? i : kNone;
  }
  if (waiting != kNone) addBases(waiting, waiting);
  for (std::size_t i = 0; i < goingCells_.size(); i += 2) measureGoing(i, std::min(i + 1, goingCells_.size() - 1));
  oldShape_ = std::sqrt(worst_);
  const double floor = std::min(limits_.shapeFloor, kShapeLoss * oldShape_);
  floorSquared_ = floor * floor;
}

// Two cells of the star as it is.
inline void FusionTest::see(const Pair& volume, const Pair& squares) {
  const Pair shape = shapeSquared(volume, squares);
  for (int lane = 0; lane < 2; ++lane) worst_ = std::min(worst_, volume[lane] > 0 ? shape[lane] : 0);
}

void FusionTest::addBases(std::uint32_t i, std::uint32_t j) {
  const auto& s = turned_[i];
  const auto& t = turned_[j];
  const TwoVectors a = both(places_[s[0]], places_[t[0]]), b = both(places_[s[1]], places_[t[1]]), c = both(places_[s[2]], places_[t[2]]);
  const TwoVectors ab = b - a, ac = c - a, bc = c - b;
  Bases& bases = bases_[baseCount_++];
  bases.normal = cross(ab, ac);
  bases.height = dot(bases.normal, a);
  bases.corners = a + b + c;
  bases.squares = dot(ab, ab) + dot(ac, ac) + dot(bc, bc) + dot(a, a) + dot(b, b) + dot(c, c);
  bases.cell = {i, j};
  const TwoVectors apex = both(places_[s[3]], places_[t[3]]);
  see(dot(bases.normal, apex) - bases.height, bases.squares + 3 * dot(apex, apex) - 2 * dot(apex, bases.corners));
}

void FusionTest::measureGoing(std::size_t i, std::size_t j) {
  const auto& s = goingCells_[i];
  const auto& t = goingCells_[j];
  const TwoVectors a = both(places_[s[0]], places_[t[0]]);
  const TwoVectors ab = both(places_[s[1]], places_[t[1]]) - a, ac = both(places_[s[2]], places_[t[2]]) - a, ad = both(places_[s[3]], places_[t[3]]) - a;
  const TwoVectors bc = ac - ab, bd = ad - ab, cd = ad - ac;
  see(dot(cross(ab, ac), ad), dot(ab, ab) + dot(ac, ac) + dot(ad, ad) + dot(bc, bc) + dot(bd, bd) + dot(cd, cd));
}

// `from`: one of its corners, relative to the first prey vertex. Where doubles are exact each gives the same plane.
inline void FusionTest::addFace(const Face& face, const Vector3& from) {
  const Vector3& normal = mesh_.plane(face.ghost).normal;
  double height = dot(normal, from);
  if (mesh_.latticeBits() > kExactBits) {
    const auto cornerAt = [&](std::size_t i) { return mesh_.position(mesh_.cell(face.ghost)[i]) - origin_; };
    for (std::size_t i = 0; i < 3; ++i)
      for (const double x : cornerAt(i)) faceReach_ = std::max(faceReach_, std::abs(x));
    height = dot(normal, cornerAt(0));
  }
  faces_[faceCount_] = face;
  Planes& planes = planes_[faceCount_ / 2];
  if (faceCount_++ % 2 == 0) {
    planes = {both(normal, {}), Pair{height, std::numeric_limits<double>::infinity()}};
  } else {
    for (std::size_t k = 0; k < 3; ++k) planes.normal[k][1] = normal[k];
    planes.height[1] = height;
  }
}

// The cell of prey vertex i turns from positive to flat or inverted, further than `error`. Nothing is said of one that goes.
inline bool FusionTest::flips(std::uint32_t i, CellId c, const Vector3& place, double error) const {
  const auto& cell = mesh_.cell(c);
  for (std::uint32_t j = 0; j < prey_.k; ++j)
    if (j != i && mesh_.holds(c, prey_.vertex[j])) return false;
  const VertexId v = prey_.vertex[i];
  const auto t = withLast(cell, (cell[1] == v) + 2 * (cell[2] == v) + 3 * (cell[3] == v));
  const Vector3 corner = mesh_.position(t[0]), normal = cross(mesh_.position(t[1]) - corner, mesh_.position(t[2]) - corner);
  return dot(normal, place - corner) <= -error && dot(normal, mesh_.position(v) - corner) > error;
}

bool FusionTest::flipsAt(const LatticePoint& p, std::uint32_t moving) const {
  const Vector3 place = toVector(p);
  // Coordinates reach as far as the lattice; what is too close to call is not called.
  const double error = mesh_.latticeBits() <= kExactBits ? 0 : kRounding * std::ldexp(1.0, 3 * mesh_.latticeBits());
  for (std::uint32_t i = 0; i < prey_.k; ++i)
    if ((moving >> i & 1) != 0 && flipped_[i] != kNoCell && flips(i, flipped_[i], place, error)) return true;
  for (std::uint32_t i = 0; i < prey_.k; ++i) {
    if ((moving >> i & 1) == 0 || mesh_.point(prey_.vertex[i]) == p) continue;
    const auto cells = mesh_.innerStar(prey_.vertex[i]);
    const auto flipped = std::ranges::find_if(cells, [&](CellId c) { return flips(i, c, place, error); });
    if (flipped == cells.end()) continue;
    flipped_[i] = *flipped;
    return true;
  }
  return false;
}

double FusionTest::shapeAt(const LatticePoint& p, double least) const {
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
      if (volume[lane] <= 0) volume[lane] = squares[lane] = 1;  // flat, as it was: its shape does not count
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

bool FusionTest::turnsTooFar(const Face& face, const LatticePoint& p) const {
  const auto& cell = mesh_.cell(face.ghost);
  const Vector3& old = mesh_.plane(face.ghost).normal;
  const Vector3 from = mesh_.position(cell[(face.moving + 1) % 3]);
  const Vector3 normal = cross(mesh_.position(cell[(face.moving + 2) % 3]) - from, toVector(p) - from);
  const double along = dot(normal, old), squared = dot(old, old), least = limits_.normalCosine;
  return squared > 0 && (along <= 0 || along * along <= least * least * dot(normal, normal) * squared);
}

/// What volumes with an apex at d over triangles of this reach may be off by.
double FusionTest::rounding(const Vector3& d, double placesReach) const {
  if (mesh_.latticeBits() <= kExactBits) return 0;
  const double reach = std::max({placesReach, std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  return reach < kExactReach ? 0 : kRounding * reach * reach * reach;
}

bool FusionTest::onLattice(const LatticePoint& p) const {
  const auto end = std::int64_t{1} << mesh_.latticeBits();
  return std::ranges::all_of(p, [&](std::int32_t x) { return x >= 0 && x < end; });
}

/// For what is too close to call in doubles, flat or inverted. The latter two are allowed only where the cell was no better.
double FusionTest::exactVolume6(std::uint32_t affected, const LatticePoint& p, bool& allowed) const {
  const auto& cell = mesh_.cell(star_.affected[affected]);
  const VertexId apex = prey_.vertex[star_.labels[affected]];
  const auto t = withLast(cell, static_cast<std::size_t>(std::ranges::find(cell, apex) - cell.begin()));
  const Int128 volume = volume6(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), p);
  allowed = volume > 0;
  if (!allowed) {
    const Int128 old = volume6(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
    allowed = old <= 0 && volume >= old;
  }
  return static_cast<double>(volume);
}

// `side`: how high p lies above the face's plane, times the normal's length, within `error`.
inline bool FusionTest::isOutside(const Face& face, double side, const LatticePoint& p, double error) const {
  const auto& t = mesh_.cell(face.ghost);
  const bool isSure = std::abs(side) > error || error == 0;
  const bool beyond = isSure ? side > 0 : orientation(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), p) > 0;
  return beyond && (limits_.envelopeTolerance == 0 || distance(face, p) + mesh_.outside(face.ghost) > limits_.envelopeTolerance);
}

// From p to the triangle. The convex hull of both is all that the solid gains there, and no point of it is further away.
double FusionTest::distance(const Face& face, const LatticePoint& p) const {
  const auto& t = mesh_.cell(face.ghost);
  const Vector3 place = toVector(p);
  return std::sqrt(nearestOnTriangle({}, {mesh_.position(t[0]) - place, mesh_.position(t[1]) - place, mesh_.position(t[2]) - place}).squared);
}

float FusionTest::outsideAt(const LatticePoint& p) const {
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

// Calls visit(face, side) for the faces that d may lie outside of, in their order; true as soon as it says so.
template <class Visit>
inline bool FusionTest::anyFacing(const Vector3& d, double error, const Visit& visit) const {
  const double least = error > 0 ? -error : std::numeric_limits<double>::denorm_min();
  const TwoVectors twice = both(d, d);
  for (std::size_t i = 0; 2 * i < faceCount_; ++i) {
    const Pair side = dot(planes_[i].normal, twice) - planes_[i].height;
    if ((side[0] >= least && visit(faces_[2 * i], side[0])) || (side[1] >= least && visit(faces_[2 * i + 1], side[1]))) return true;
  }
  return false;
}

bool FusionTest::insideEnvelope(const LatticePoint& p) const {
  const Vector3 d = toVector(p) - origin_;
  const double error = rounding(d, faceReach_);
  return onLattice(p) && !anyFacing(d, error, [&](const Face& face, double side) { return isOutside(face, side, p, error); });
}

bool FusionTest::projectInside(Vector3 p, LatticePoint& inside) const {
  const auto end = static_cast<double>((std::int64_t{1} << mesh_.latticeBits()) - 1);
  for (int step = 0; step <= kProjections; ++step) {
    for (std::size_t a = 0; a < 3; ++a) inside[a] = static_cast<std::int32_t>(std::clamp(p[a] + 0.5, 0.0, end));
    const Vector3 d = toVector(inside) - origin_;
    const double error = rounding(d, faceReach_);
    double farthest = -1;
    Vector3 back{};
    const Vector3 past = p - toVector(inside);  // rounding's share
    const bool isLost = anyFacing(d, error, [&](const Face& face, double side) {
      if (!isOutside(face, side, inside, error)) return false;
      const auto& [normal, inverseLength] = mesh_.plane(face.ghost);
      if (!(inverseLength > 0)) return true;  // a sliver whose plane doubles do not know
      const double allowed = limits_.envelopeTolerance == 0 ? 0 : std::max(0.0, limits_.envelopeTolerance - mesh_.outside(face.ghost));
      const double outside = (side + dot(normal, past)) * inverseLength - allowed;
      if (std::abs(outside) > farthest) farthest = std::abs(outside), back = (outside * inverseLength) * normal;
      if (step >= kExactProjections) back = back + (kRoundingReach * inverseLength) * normal;
      return false;
    });
    if (isLost) return false;
    if (farthest < 0) return true;
    p = p - back;
  }
  return false;
}

bool FusionTest::keepsTopology() {
  if (prey_.k == 2 ? !edgeKeepsTopology() : !full_->passes(mesh_, prey_, star_)) return false;
  return !mesh_.hasRegions() || regions_->passes(mesh_, prey_, star_);
}

// The link condition of Dey, Edelsbrunner, Guha and Nekhayev in the complex completed by the ghost: the links of the two vertices meet in the
// edge's link and nowhere else. That link is one cycle, since neither vertex is singular.
bool FusionTest::edgeKeepsTopology() {
  std::size_t common = 0;
  for (std::size_t v = 2; v < vertices_.ids().size(); ++v) common += sides_[v] == 3;
  if (common != ring_.size()) return false;
  std::fill_n(ringNeighbours_.begin(), vertices_.ids().size(), std::array<std::uint32_t, 2>{});
  for (const auto& [x, y] : ring_) {
    for (const auto& [at, other] : {std::pair{x, y}, std::pair{y, x}}) {
      auto& pair = ringNeighbours_[at];
      if (pair[1] != 0) return false;
      pair[pair[0] == 0 ? 0 : 1] = other;
    }
  }
  return !hasCommonChord();
}

// An edge between two vertices of the ring that is in both links but not in the ring, or a triangle that fills a ring of three in both.
bool FusionTest::hasCommonChord() {
  chords_.clear();
  unsigned filled = 0;
  for (std::size_t i = 0; i < star_.affected.size(); ++i) {
    const auto& t = turned_[i];
    const int onRing = (sides_[t[0]] == 3) + (sides_[t[1]] == 3) + (sides_[t[2]] == 3);
    if (onRing < 2) continue;
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t x = std::min(t[e], t[(e + 1) % 3]), y = std::max(t[e], t[(e + 1) % 3]);
      if (sides_[x] != 3 || sides_[y] != 3 || ringNeighbours_[x][0] == y || ringNeighbours_[x][1] == y) continue;
      if (star_.labels[i] == 0)
        chords_.push_back({x, y});
      else if (std::find(chords_.begin(), chords_.end(), std::array{x, y}) != chords_.end())
        return true;
    }
    if (onRing == 3 && ring_.size() == 3) filled |= 1u << star_.labels[i];
  }
  return filled == 3;
}

}  // namespace qtet
