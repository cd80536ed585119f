#include "simplify/fusion_test.h"

#include <algorithm>
#include <cmath>

#include "codec/growing_mesh.h"
#include "codec/predicates.h"

namespace qtet {
namespace {

// Cells of a star beyond which a fusion is not tried: a hub of a graded mesh would make every later fusion near it expensive.
constexpr std::size_t kMaxStarCells = 400;
// A new cell's shape may fall to a fifth of the worst of its star, or to this, whichever is lower (1 = regular, 0 = flat).
constexpr double kShapeFloor = 0.02;
constexpr double kShapeLoss = 0.2;
// Steps of the projection into the envelope; the last ones keep a distance that rounding to the lattice cannot use up.
constexpr int kProjections = 8;
constexpr int kExactProjections = 4;
constexpr double kRoundingReach = 0.87;  // sqrt(3) / 2 lattice steps

Vector3 toDouble(const LatticePoint& p) { return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}; }

// 6 sqrt(2) V / l^3 with l the root mean square edge: 1 for the regular tetrahedron, below 0 for an inverted one.
double shapeOf(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const Vector3 ab = b - a;
  const Vector3 ac = c - a;
  const Vector3 ad = d - a;
  const Vector3 bc = c - b;
  const Vector3 bd = d - b;
  const Vector3 cd = d - c;
  const double squared = (dot(ab, ab) + dot(ac, ac) + dot(ad, ad) + dot(bc, bc) + dot(bd, bd) + dot(cd, cd)) / 6;
  return squared > 0 ? 1.4142135623730951 * dot(cross(ab, ac), ad) / (squared * std::sqrt(squared)) : 0;
}

}  // namespace

int FusionTest::preyIndex(VertexId v) const {
  for (int i = 0; i < prey_.k; ++i)
    if (prey_.vertex[static_cast<std::size_t>(i)] == v) return i;
  return -1;
}

bool FusionTest::gather(const Prey& prey) {
  prey_ = prey;
  affected_.clear(), deleted_.clear(), labels_.clear(), turned_.clear(), boundaryFaces_.clear(), others_.clear();
  ++stamp_;
  if (vertexStamp_.size() < mesh_.vertexSlots()) vertexStamp_.resize(mesh_.vertexSlots() * 2, 0);
  bool ghost = false;
  std::size_t size = 0;
  for (const VertexId v : prey.vertices()) size += mesh_.star(v).size();
  if (size > 2 * kMaxStarCells) return false;
  for (const VertexId v : prey.vertices())
    for (const CellId c : mesh_.star(v)) {
      if (cellStamp_.size() <= c) cellStamp_.resize(std::max<std::size_t>(c + 1, cellStamp_.size() * 2), 0);
      if (std::exchange(cellStamp_[c], stamp_) == stamp_) continue;
      const auto& cell = mesh_.cell(c);
      int shared = 0;
      std::size_t at = 0;
      int singular = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const VertexId w = cell[i];
        if (preyIndex(w) >= 0) {
          ++shared, at = i;
        } else if (w == kGhost) {
          ghost = true;
          const auto face = withLast(cell, i);
          boundaryFaces_.push_back({face[0], face[1], face[2]});
        } else {
          singular += mesh_.singular(w);
          if (std::exchange(vertexStamp_[w], stamp_) != stamp_) others_.push_back(w);
        }
      }
      if (shared == 1) {
        affected_.push_back(c);
        labels_.push_back(static_cast<std::uint8_t>(preyIndex(cell[at])));
        turned_.push_back(withLast(cell, at));
      } else {
        if (singular > 1) return false;  // an edge that is not a manifold's could be fused away unseen
        deleted_.push_back(c);
      }
    }
  if (ghost) others_.push_back(kGhost);
  if (affected_.size() > kMaxStarCells) return false;
  measureShape();
  return true;
}

void FusionTest::measureShape() {
  double worst = 1;
  const auto look = [&](const std::array<VertexId, 4>& c) {
    if (std::ranges::find(c, kGhost) == c.end())
      worst = std::min(worst, shapeOf(mesh_.position(c[0]), mesh_.position(c[1]), mesh_.position(c[2]), mesh_.position(c[3])));
  };
  for (const auto& c : turned_) look(c);
  for (const CellId c : deleted_) look(mesh_.cell(c));
  shapeFloor_ = std::min(kShapeFloor, kShapeLoss * worst);
}

bool FusionTest::keepsTopology() {
  link_.clear(mesh_.vertexSlots());
  for (const auto& t : turned_) link_.add(t[0], t[1], t[2]);
  if (!link_.close() || link_.vertices().size() != others_.size() || !link_.isSphere()) return false;
  return deletedOnLink() && patchIsDisc() && describable();
}

// Every edge of a deleted cell between two vertices that stay must be an edge of the link.
bool FusionTest::deletedOnLink() const {
  for (const CellId c : deleted_) {
    std::array<std::uint32_t, 4> stay{};
    std::size_t n = 0;
    for (const VertexId v : mesh_.cell(c))
      if (preyIndex(v) < 0) stay[n++] = link_.localOf(v);
    if (n == 2 && link_.triangleAtEdge(stay[0], stay[1]) == kNoNeighbour) return false;
  }
  return true;
}

// The boundary faces that touch the prey must form one disc: then the new fan round the fused vertex, a disc too, replaces them.
bool FusionTest::patchIsDisc() const {
  if (boundaryFaces_.empty()) return true;
  std::int64_t ring = 0;
  for (const LinkTriangle& t : link_.triangles()) ring += t.ghost;
  std::int64_t inner = 0;
  for (const VertexId v : prey_.vertices()) inner += mesh_.onBoundary(v);
  const auto faces = static_cast<std::int64_t>(boundaryFaces_.size());
  if ((3 * faces + ring) % 2 != 0) return false;
  return inner + ring - (3 * faces + ring) / 2 + faces == 1;
}

bool FusionTest::describable() {
  if (prey_.k == 2) return true;  // labels tell all: a deleted cell stands exactly where they change
  for (std::size_t i = 0; i < labels_.size(); ++i) link_.triangles()[i].label = labels_[i];
  truth_.clear();
  for (const CellId c : deleted_) {
    LocalCell local{};
    for (std::size_t i = 0; i < 4; ++i) {
      const int p = preyIndex(mesh_.cell(c)[i]);
      local[i] = p >= 0 ? kPreyBit | static_cast<LocalVertex>(p) : link_.localOf(mesh_.cell(c)[i]);
    }
    truth_.push_back(sorted(local));
  }
  std::ranges::sort(truth_);
  EchoCoder echo;
  return codeDeletedCells(echo, models_, link_, prey_.k, truth_, derived_);
}

bool FusionTest::keepsCells(const LatticePoint& p) const {
  const Vector3 position = toDouble(p);
  for (const auto& t : turned_) {
    if (t[0] == kGhost || t[1] == kGhost || t[2] == kGhost) continue;
    const LatticePoint& a = mesh_.point(t[0]);
    const LatticePoint& b = mesh_.point(t[1]);
    const LatticePoint& c = mesh_.point(t[2]);
    if (orientation(a, b, c, p) > 0) {
      if (shapeOf(toDouble(a), toDouble(b), toDouble(c), position) < shapeFloor_) return false;
      continue;
    }
    // Flat or inverted: allowed only where the input was no better.
    const Int128 old = volume6(a, b, c, mesh_.point(t[3]));
    if (old > 0 || volume6(a, b, c, p) < old) return false;
  }
  return true;
}

bool FusionTest::insideEnvelope(const LatticePoint& p) const {
  return std::ranges::all_of(boundaryFaces_, [&](const Triangle& f) {
    return orientation(mesh_.point(f[0]), mesh_.point(f[1]), mesh_.point(f[2]), p) <= 0;
  });
}

bool FusionTest::projectInside(Vector3 p, LatticePoint& inside) const {
  for (int step = 0; step <= kProjections; ++step) {
    for (std::size_t a = 0; a < 3; ++a) inside[a] = static_cast<std::int32_t>(std::floor(p[a] + 0.5));
    double farthest = -1;
    Vector3 normal{};
    for (const Triangle& f : boundaryFaces_) {
      if (orientation(mesh_.point(f[0]), mesh_.point(f[1]), mesh_.point(f[2]), inside) <= 0) continue;
      const Vector3 a = mesh_.position(f[0]);
      const Vector3 n = cross(mesh_.position(f[1]) - a, mesh_.position(f[2]) - a);
      const double length = std::sqrt(dot(n, n));
      const double outside = dot(n, p - a) / length;
      if (std::abs(outside) > farthest) farthest = std::abs(outside), normal = (outside / length) * n;
      if (step >= kExactProjections) normal = normal + (kRoundingReach / length) * n;
    }
    if (farthest < 0) return true;
    p = p - normal;
  }
  return false;
}

}  // namespace qtet
