#include "simplify/fusion_test.h"

#include <algorithm>
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
constexpr double kExactReach = 65536;
constexpr double kRounding = 0x1p-47;

// Shape = 6 sqrt(2) V / l^3, l the root mean square edge. With v = 6 V and s = the sum of the squared edges its square is 432 v^2 / s^3.
constexpr double kShapeSquared = 432;

constexpr std::size_t kNoGhost = 4;

double shapeSquared(double volume6, double squares) { return kShapeSquared * volume6 * volume6 / (squares * squares * squares); }

}  // namespace

FusionTest::FusionTest(const FusionMesh& mesh, const FusionLimits& limits)
    : mesh_(mesh), limits_(limits), full_(std::make_unique<FullLinkTest>()), regions_(std::make_unique<RegionTest>()) {}
FusionTest::~FusionTest() = default;

bool FusionTest::gather(const Prey& prey) {
  std::size_t size = 0;
  for (const VertexId v : prey.vertices()) mesh_.prefetchStar(v), size += mesh_.star(v).size();
  if (size > kMostStarCells) return false;
  prey_ = prey;
  star_.affected.clear(), star_.deleted.clear(), star_.labels.clear(), star_.link.clear();
  places_.clear(), sides_.clear(), turned_.clear(), ring_.clear(), goingCells_.clear(), ghosts_.clear(), bases_.clear(), faces_.clear();
  vertices_.clear();
  const auto intern = [&](VertexId v) {
    const std::uint32_t local = vertices_.intern(v);
    if (local == sides_.size()) {
      sides_.push_back(0);
      if (v != kGhost) mesh_.prefetchPoint(v);
    }
    return local;
  };
  for (const VertexId v : prey.vertices()) (void)intern(v);
  for (std::uint32_t i = 0; i < prey.k; ++i)
    for (const CellId c : mesh_.star(prey.vertex[i])) {
      const auto& cell = mesh_.cell(c);
      std::array<std::uint32_t, 4> local{};
      std::uint32_t lowest = prey.k;
      std::size_t at = 0;
      int shared = 0;
      int singular = 0;
      for (std::size_t j = 0; j < 4; ++j) {
        local[j] = intern(cell[j]);
        if (local[j] < prey.k) {
          ++shared, at = j;
          lowest = std::min(lowest, local[j]);
        }
      }
      if (lowest < i) continue;  // met before
      if (shared > 1) {
        for (std::size_t j = 0; j < 4; ++j) singular += cell[j] != kGhost && local[j] >= prey.k && mesh_.singular(cell[j]);
        if (singular > 1) return false;  // an edge that is not a manifold's could be fused away unseen
        star_.deleted.push_back(c);
      } else {
        star_.affected.push_back(c);
        star_.labels.push_back(static_cast<std::uint8_t>(i));
      }
      addCell(c, local, shared, at);
    }
  if (star_.affected.size() > kMostStarCells / 2) return false;
  star_.link.assign(vertices_.ids().begin() + prey.k, vertices_.ids().end());
  measure();
  return true;
}

void FusionTest::addCell(CellId c, const std::array<std::uint32_t, 4>& local, int shared, std::size_t at) {
  const auto& cell = mesh_.cell(c);
  std::uint8_t side = 0;
  for (const std::uint32_t v : local)
    if (v < prey_.k) side |= static_cast<std::uint8_t>(1u << v);
  std::array<std::uint32_t, 4> others{};
  std::size_t n = 0;
  std::size_t ghost = kNoGhost;
  for (std::size_t j = 0; j < 4; ++j) {
    if (cell[j] == kGhost) ghost = j;
    if (local[j] < prey_.k) continue;
    sides_[local[j]] |= side;
    others[n++] = local[j];
  }
  if (shared == 1)
    turned_.push_back(withLast(local, at));
  else if (prey_.k == 2)
    ring_.push_back({others[0], others[1]});
  if (ghost != kNoGhost)
    ghosts_.push_back({withLast(local, ghost), c, shared == 1});
  else if (shared > 1)
    goingCells_.push_back(local);
}

// What needs positions, once all of them have been asked for.
void FusionTest::measure() {
  const Vector3 origin = mesh_.position(prey_.vertex[0]);
  reach_ = 0;
  for (const VertexId v : vertices_.ids()) {
    places_.push_back(v == kGhost ? Vector3{} : mesh_.position(v) - origin);
    for (const double x : places_.back()) reach_ = std::max(reach_, std::abs(x));
  }
  const std::uint32_t ghost = ghosts_.empty() ? ~0u : ghosts_[0].local[3];
  for (std::size_t i = 0; i < turned_.size(); ++i)
    if (turned_[i][0] != ghost && turned_[i][1] != ghost && turned_[i][2] != ghost) addBase(turned_[i], i);
  for (const GhostCell& g : ghosts_) addFace(g);
  measureShape();
}

void FusionTest::addBase(const std::array<std::uint32_t, 4>& local, std::size_t index) {
  const Vector3& a = places_[local[0]];
  const Vector3& b = places_[local[1]];
  const Vector3& c = places_[local[2]];
  const Vector3 ab = b - a, ac = c - a, bc = c - b;
  Base base;
  base.normal = cross(ab, ac);
  base.height = dot(base.normal, a);
  base.corners = a + b + c;
  base.squares = dot(ab, ab) + dot(ac, ac) + dot(bc, bc) + dot(a, a) + dot(b, b) + dot(c, c);
  base.cell = static_cast<std::uint32_t>(index);
  bases_.push_back(base);
}

void FusionTest::addFace(const GhostCell& ghost) {
  auto f = ghost.local;
  if (ghost.stays)
    while (f[2] >= prey_.k) f = {f[1], f[2], f[0], f[3]};
  Face face;
  for (std::size_t i = 0; i < 3; ++i) face.vertex[i] = vertices_.ids()[f[i]], face.corner[i] = places_[f[i]];
  face.normal = cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
  face.height = dot(face.normal, face.corner[0]);
  face.outside = mesh_.outside(ghost.cell);
  face.stays = ghost.stays;
  faces_.push_back(face);
}

void FusionTest::measureShape() {
  double worst = 1;
  for (const Base& base : bases_) {
    const Vector3& apex = places_[star_.labels[base.cell]];
    const double volume = dot(base.normal, apex) - base.height;
    const double squares = base.squares + 3 * dot(apex, apex) - 2 * dot(apex, base.corners);
    worst = std::min(worst, volume > 0 ? shapeSquared(volume, squares) : 0);
  }
  for (const auto& c : goingCells_) {
    const Vector3 ab = places_[c[1]] - places_[c[0]], ac = places_[c[2]] - places_[c[0]], ad = places_[c[3]] - places_[c[0]];
    const Vector3 bc = ac - ab, bd = ad - ab, cd = ad - ac;
    const double volume = dot(cross(ab, ac), ad);
    const double squares = dot(ab, ab) + dot(ac, ac) + dot(ad, ad) + dot(bc, bc) + dot(bd, bd) + dot(cd, cd);
    worst = std::min(worst, volume > 0 ? shapeSquared(volume, squares) : 0);
  }
  oldShape_ = std::sqrt(worst);
  const double floor = std::min(limits_.shapeFloor, kShapeLoss * oldShape_);
  floorSquared_ = floor * floor;
}

double FusionTest::shapeAt(const LatticePoint& p) const {
  const Vector3 d = toVector(p) - mesh_.position(prey_.vertex[0]);
  for (const Face& face : faces_) {
    if (!face.stays || limits_.normalCosine < 0) continue;
    const Vector3 normal = cross(face.corner[1] - face.corner[0], d - face.corner[0]);
    const double along = dot(normal, face.normal);
    if (dot(face.normal, face.normal) == 0) continue;
    const double least = limits_.normalCosine;
    if (along <= 0 || along * along <= least * least * dot(normal, normal) * dot(face.normal, face.normal)) return -1;
  }
  const double distance = 3 * dot(d, d), rounding = this->rounding(d);
  double worst = 1;
  for (const Base& base : bases_) {
    double volume = dot(base.normal, d) - base.height;
    if (volume <= rounding) {
      bool allowed = false;
      volume = exactVolume6(base, p, allowed);
      if (!allowed) return -1;
      if (volume <= 0) continue;
    }
    const double shape = shapeSquared(volume, base.squares + distance - 2 * dot(d, base.corners));
    if (shape < floorSquared_) return -1;
    worst = std::min(worst, shape);
  }
  return std::sqrt(worst);
}

/// What volumes with an apex at d may be off by.
double FusionTest::rounding(const Vector3& d) const {
  const double reach = std::max({reach_, std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  return reach < kExactReach ? 0 : kRounding * reach * reach * reach;
}

bool FusionTest::onLattice(const LatticePoint& p) const {
  const auto end = std::int64_t{1} << mesh_.latticeBits();
  return std::ranges::all_of(p, [&](std::int32_t x) { return x >= 0 && x < end; });
}

/// For what is too close to call in doubles, flat or inverted. The latter two are allowed only where the cell was no better.
double FusionTest::exactVolume6(const Base& base, const LatticePoint& p, bool& allowed) const {
  const auto& cell = mesh_.cell(star_.affected[base.cell]);
  const VertexId apex = prey_.vertex[star_.labels[base.cell]];
  const auto t = withLast(cell, static_cast<std::size_t>(std::ranges::find(cell, apex) - cell.begin()));
  const Int128 volume = volume6(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), p);
  allowed = volume > 0;
  if (!allowed) {
    const Int128 old = volume6(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
    allowed = old <= 0 && volume >= old;
  }
  return static_cast<double>(volume);
}

// `d` = p relative to the first prey vertex.
bool FusionTest::isOutside(const Face& face, const Vector3& d, const LatticePoint& p) const {
  const double side = dot(face.normal, d) - face.height;
  const double error = rounding(d);
  const bool beyond = std::abs(side) > error || error == 0
                          ? side > 0
                          : orientation(mesh_.point(face.vertex[0]), mesh_.point(face.vertex[1]), mesh_.point(face.vertex[2]), p) > 0;
  return beyond && (limits_.envelopeTolerance == 0 || distance(face, d) + face.outside > limits_.envelopeTolerance);
}

// From d to the triangle. The convex hull of both is all that the solid gains there, and no point of it is further away.
double FusionTest::distance(const Face& face, const Vector3& d) { return std::sqrt(nearestOnTriangle(d, face.corner).squared); }

float FusionTest::outsideAt(const LatticePoint& p) const {
  if (limits_.envelopeTolerance == 0) return 0;
  const Vector3 d = toVector(p) - mesh_.position(prey_.vertex[0]);
  double most = 0;
  for (const Face& face : faces_) {
    const bool beyond = dot(face.normal, d) - face.height > -rounding(d);
    most = std::max(most, face.outside + (beyond ? distance(face, d) : 0));
  }
  const auto bound = static_cast<float>(most);
  return bound < most ? std::nextafter(bound, std::numeric_limits<float>::infinity()) : bound;
}

bool FusionTest::insideEnvelope(const LatticePoint& p) const {
  const Vector3 d = toVector(p) - mesh_.position(prey_.vertex[0]);
  return onLattice(p) && std::ranges::none_of(faces_, [&](const Face& face) { return isOutside(face, d, p); });
}

bool FusionTest::projectInside(Vector3 p, LatticePoint& inside) const {
  const Vector3 origin = mesh_.position(prey_.vertex[0]);
  const double end = std::ldexp(1.0, mesh_.latticeBits()) - 1;
  for (int step = 0; step <= kProjections; ++step) {
    for (std::size_t a = 0; a < 3; ++a) inside[a] = static_cast<std::int32_t>(std::clamp(std::floor(p[a] + 0.5), 0.0, end));
    const Vector3 d = toVector(inside) - origin;
    double farthest = -1;
    Vector3 back{};
    for (const Face& face : faces_) {
      if (!isOutside(face, d, inside)) continue;
      const double length = std::sqrt(dot(face.normal, face.normal));
      if (!(length > 0)) return false;  // a sliver whose plane doubles do not know
      const double outside =
          (dot(face.normal, p - origin) - face.height) / length - std::max(0.0, limits_.envelopeTolerance - face.outside);
      if (std::abs(outside) > farthest) farthest = std::abs(outside), back = (outside / length) * face.normal;
      if (step >= kExactProjections) back = back + (kRoundingReach / length) * face.normal;
    }
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
  for (std::size_t v = 2; v < sides_.size(); ++v) common += sides_[v] == 3;
  if (common != ring_.size()) return false;
  ringNeighbours_.assign(sides_.size(), {0, 0});
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
  for (std::size_t i = 0; i < turned_.size(); ++i) {
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
