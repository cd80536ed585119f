#include "simplify/legality/original_surface.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "simplify/legality/lattice_rounding.h"

namespace qtet {
namespace {

/// A surface so near the middle of a cube, over its length, is as good as one through it.
constexpr double kNear = 0.25;
/// The cosine to a pseudonormal that is too small to tell a side, in doubles.
constexpr double kNoSide = 1e-9;

Vector3 unit(const Vector3& v) {
  const double length = std::sqrt(dot(v, v));
  return length > 0 ? 1 / length * v : Vector3{};
}

// The angle, by halving until the series of the arc tangent is short: the same on every machine,
// unlike acos.
double angleBetween(const Vector3& a, const Vector3& b) {
  constexpr double kShort = 0.1;
  const Vector3 u = unit(a), v = unit(b), apart = u - v, together = u + v;
  double tangent = std::sqrt(dot(apart, apart) / std::max(dot(together, together), kNoSide));
  double halvings = 2;
  for (; tangent > kShort; halvings *= 2) tangent /= 1 + std::sqrt(1 + tangent * tangent);
  const double t = tangent * tangent;
  return halvings * tangent * (1 - t * (1.0 / 3 - t * (1.0 / 5 - t / 7)));
}

double radiusOf(const OriginalSurface::Corners& corners, const Vector3& middle) {
  double squared = 0;
  for (const Vector3& c : corners) squared = std::max(squared, dot(c - middle, c - middle));
  return std::sqrt(squared);
}

// The distance to a convex set is convex: no point between the corners is further.
bool isNear(const OriginalSurface::Corners& corners, const std::array<Vector3, 3>& triangle,
            double distance) {
  return distance > 0 && std::ranges::all_of(corners, [&](const Vector3& c) {
           return nearestOnTriangle(c, triangle).squared <= distance * distance;
         });
}

// Its halves, cut across the longest edge; of equal edges the first.
std::array<OriginalSurface::Corners, 2> halves(const OriginalSurface::Corners& corners) {
  std::size_t a = 0, b = 1;
  double longest = -1;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const Vector3 edge = corners[j] - corners[i];
      if (const double squared = dot(edge, edge); squared > longest)
        longest = squared, a = i, b = j;
    }
  std::array<OriginalSurface::Corners, 2> out{corners, corners};
  out[0][a] = out[1][b] = 0.5 * (corners[a] + corners[b]);
  return out;
}

}  // namespace

OriginalSurface::Tolerances::Tolerances(const OriginalSurface& surface, double everywhere)
    : Tolerances(std::vector(surface.tree().builtOver(), floatBelow(everywhere))) {}

OriginalSurface::Tolerances::Tolerances(std::vector<float> each) : own(std::move(each)) {
  if (own.empty()) return;
  const auto [low, high] = std::ranges::minmax_element(own);
  least = *low, most = *high;
  assert(least >= 0);
}

OriginalSurface::OriginalSurface(const FusionMesh& mesh, CellId firstSeam) {
  std::vector<VertexId> vertices;
  collect(mesh, firstSeam, vertices);
  findNeighbours();
  assert(vertices.size() == points_.size() && neighbours_.size() == triangles_.size());
  std::vector<std::uint32_t> ids(triangles_.size());
  std::iota(ids.begin(), ids.end(), 0u);
  tree_ = std::make_unique<TriangleTree>(points_, triangles_, std::move(ids));
  findVertexNormals();
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (mesh.singular(vertices[i])) vertexNormals_[i] = {};
}

// Each triangle is its first vertex's. `vertices`: of the mesh, by point.
void OriginalSurface::collect(const FusionMesh& mesh, CellId firstSeam,
                              std::vector<VertexId>& vertices) {
  std::vector<VertexId> own(mesh.vertexSlots(), kGhost);
  const auto numberOf = [&](VertexId v) {
    if (own[v] == kGhost) {
      own[v] = static_cast<VertexId>(points_.size());
      points_.push_back(mesh.point(v));
      vertices.push_back(v);
    }
    return own[v];
  };
  for (VertexId v = 0; v < mesh.vertexSlots(); ++v)
    for (const CellId c : mesh.boundaryStar(v)) {
      const auto& t = mesh.cell(c);
      if (v != std::min({t[0], t[1], t[2]})) continue;
      triangles_.push_back({numberOf(t[0]), numberOf(t[1]), numberOf(t[2]), kGhost});
      if (firstSeam != kNoSeam) isSeam_.push_back(c >= firstSeam);
    }
}

void OriginalSurface::findNeighbours() {
  struct Side {
    VertexId low, high;
    std::uint32_t triangle, number;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const VertexId a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, i});
    }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.low, s.high, s.triangle); });
  neighbours_.assign(triangles_.size(), {kNobody, kNobody, kNobody});
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
      ++end;
    if (end - i != 2) continue;
    const Side &one = sides[i], &other = sides[i + 1];
    neighbours_[one.triangle][one.number] = other.triangle;
    neighbours_[other.triangle][other.number] = one.triangle;
  }
}

void OriginalSurface::findVertexNormals() {
  vertexNormals_.resize(points_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto at = tree_->corners(t);
    const Vector3 normal = unitNormal(t);
    for (std::size_t i = 0; i < 3; ++i) {
      Vector3& sum = vertexNormals_[triangles_[t][i]];
      sum = sum + angleBetween(at[(i + 1) % 3] - at[i], at[(i + 2) % 3] - at[i]) * normal;
    }
  }
}

Vector3 OriginalSurface::unitNormal(std::uint32_t triangle) const {
  const auto at = tree_->corners(triangle);
  return unit(cross(at[1] - at[0], at[2] - at[0]));
}

// The angle-weighted pseudonormal of the nearest face, edge or vertex (Baerentzen & Aanaes 2005).
Vector3 OriginalSurface::normalAt(const NearestTriangle& nearest) const {
  const auto& weights = nearest.point.weights;
  const auto isOn = [&](std::size_t corner) { return weights[corner] > 0; };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
    if (isOn(i) && !isOn(next) && !isOn(last))
      return vertexNormals_[triangles_[nearest.triangle][i]];
    if (!isOn(i) || !isOn(next) || isOn(last)) continue;
    const std::uint32_t beside = neighbours_[nearest.triangle][i];
    return beside == kNobody ? Vector3{} : unitNormal(nearest.triangle) + unitNormal(beside);
  }
  return unitNormal(nearest.triangle);
}

bool OriginalSurface::isInside(const Vector3& p, const NearestTriangle& nearest) const {
  assert(nearest.triangle < triangles_.size());
  const Vector3 normal = normalAt(nearest);
  const Vector3 from = p - blend(tree_->corners(nearest.triangle), nearest.point.weights);
  const double along = dot(normal, from);
  return along < 0 && along * along > kNoSide * kNoSide * dot(normal, normal) * dot(from, from);
}

SignedDistance OriginalSurface::distanceOf(const LatticeCube& cube) const {
  const Vector3 p = cube.middle();
  const double near = kNear * cube.length();
  NearestTriangle nearest;
  tree_->nearest(p, nearest, near * near);
  assert(nearest.triangle < triangles_.size());
  const double distance = std::sqrt(nearest.point.squared);
  const bool isIn = distance > near && isInside(p, nearest);
  const double outside = (isIn ? -distance : distance) + kDistanceRounding;
  const auto rounded = static_cast<float>(outside);
  return {
      rounded < outside ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded,
      nearest.triangle};
}

// The tetrahedron is halved until each piece is near one triangle of the surface, or lies in a
// ball. Such a ball is round the middle of a cube that is near the solid or inside it. The triangle
// nearest to that middle says how near. A ball that passes the surface may leave it anywhere, so
// that the least tolerance counts. The piece that lies furthest outside comes first: where one lies
// too far, it is soon found.
bool OriginalSurface::holds(const Corners& tetrahedron, const Tolerances& tolerances,
                            DistanceCells& known, int maxCuts) const {
  assert(tolerances.own.size() == triangles_.size() && maxCuts >= 0);
  struct Piece {
    Corners corners;
    double outside;
  };
  std::vector<Piece> waiting;
  // False: it lies too far outside for sure.
  const auto look = [&](const Corners& corners) {
    const Vector3 centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    const double radius = radiusOf(corners, centre);
    // neighbours of a small piece share its cube
    const auto size =
        static_cast<std::uint32_t>(std::max(radius, 0.5 * (tolerances.most - radius)));
    const LatticeCube cube =
        LatticeCube::at(centre, static_cast<int>(std::bit_width(size | 1)) - 1);
    const SignedDistance from = known.at(cube, [&] { return distanceOf(cube); });
    const double reach = radiusOf(corners, cube.middle());
    assert(from.nearest < tolerances.own.size());
    const double tolerance = tolerances.own[from.nearest];
    if (from.outside - reach > tolerance + kDistanceRounding) return false;
    if (from.outside + reach > (from.outside < 0 ? tolerances.least : tolerance) &&
        !isNear(corners, tree_->corners(from.nearest), tolerance - kDistanceRounding)) {
      waiting.push_back({corners, from.outside});
      std::ranges::push_heap(waiting, {}, &Piece::outside);
    }
    return true;
  };
  if (!look(tetrahedron)) return false;
  for (int cuts = 0; !waiting.empty(); ++cuts) {
    if (cuts == maxCuts) return false;
    std::ranges::pop_heap(waiting, {}, &Piece::outside);
    const auto parts = halves(waiting.back().corners);
    waiting.pop_back();
    if (!look(parts[0]) || !look(parts[1])) return false;
  }
  return true;
}

}  // namespace qtet
