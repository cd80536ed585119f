#include "simplify/cost/expected_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "codec/mesh/boundary.h"
#include "simplify/mesh/split_mix64.h"
#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

// Faces that speak for all: their mean is known to a few per cent.
constexpr std::size_t kFaces = 100'000;
// The same of the edges of a boundary that comes in pieces: they take 100 MB at most.
constexpr std::size_t kEdges = 500'000;
// The cosine of 40 degrees: an edge of the boundary that is sharper is a crease.
constexpr double kCrease = 0.766;
// The variance of what rounding to integers changes, in steps.
constexpr double kRounding = 1.0 / 12;

/// A simplex of N vertices less, on one side of what it shares with another. Sides are sorted, so
/// that two of one simplex lie side by side.
template <std::size_t N>
struct Side {
  std::array<VertexId, N> shared;
  VertexId opposite;
  std::uint32_t owner;  // of the opposite vertex: the cell or triangle

  friend auto operator<=>(const Side&, const Side&) = default;
};

/// Calls visit(first, second) for all that exactly two sides share.
template <std::size_t N, class Visit>
void forEachPair(std::vector<Side<N>>& sides, const Visit& visit) {
  std::ranges::sort(sides);
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    for (end = i + 1; end < sides.size() && sides[end].shared == sides[i].shared;) ++end;
    if (end == i + 2) visit(sides[i], sides[i + 1]);
  }
}

class Mean {
 public:
  void add(double value, double weight) { sum_ += weight * value, weight_ += weight; }
  [[nodiscard]] double value() const { return weight_ > 0 ? sum_ / weight_ : 0; }

 private:
  double sum_ = 0, weight_ = 0;
};

/// A number of the vertices' places, whatever the order of its vertices.
std::uint64_t numberOf(const LatticeMesh& mesh, std::span<const VertexId> face) {
  std::uint64_t number = 0;
  for (const VertexId v : face) {
    std::uint64_t place = 0;
    for (const std::int32_t x : mesh.points[v])
      place = SplitMix64(place ^ static_cast<std::uint32_t>(x)).next();
    number += place;
  }
  return number;
}

std::vector<Side<3>> sidesOfFaces(const LatticeMesh& mesh, std::uint64_t step) {
  std::vector<Side<3>> sides;
  for (std::uint32_t c = 0; c < mesh.tetrahedra.size(); ++c) {
    for (int corner = 0; corner < 4; ++corner) {
      Triangle face = cellFace(mesh.tetrahedra[c], corner);
      if (!isSampledFace(mesh, face, step)) continue;
      std::ranges::sort(face);
      sides.push_back({face, mesh.tetrahedra[c][static_cast<std::size_t>(corner)], c});
    }
  }
  return sides;
}

/// The weights of a cell's corners in its linear fields at p, and six times the cell's volume;
/// nothing for a cell without positive volume.
struct LinearCell {
  std::array<double, 4> share{};
  double volume6 = 0;
};
std::optional<LinearCell> linearCell(const LatticeMesh& mesh, const Tetrahedron& t,
                                     const LatticePoint& at) {
  const Vector3 p = toVector(mesh.points[t[0]]), d = toVector(at) - p;
  const Vector3 e1 = toVector(mesh.points[t[1]]) - p, e2 = toVector(mesh.points[t[2]]) - p,
                e3 = toVector(mesh.points[t[3]]) - p;
  LinearCell out;
  out.volume6 = dot(e1, cross(e2, e3));
  if (!(out.volume6 > 0)) return std::nullopt;
  out.share[1] = dot(d, cross(e2, e3)) / out.volume6;
  out.share[2] = dot(d, cross(e3, e1)) / out.volume6;
  out.share[3] = dot(d, cross(e1, e2)) / out.volume6;
  out.share[0] = 1 - out.share[1] - out.share[2] - out.share[3];
  return out;
}

/// The squares of what the cell's linear field misses at v, without what rounding makes of them,
/// summed over the components.
double missedAt(const LatticeMesh& mesh, const CostPart& part, const Tetrahedron& t,
                const std::array<double, 4>& share, VertexId v) {
  double sum = 0, rounded = 1;
  for (const double s : share) rounded += s * s;
  const std::size_t n = mesh.fields[part.field].components;
  const auto& values = mesh.values[part.field];
  for (std::size_t c = 0; c < n; ++c) {
    double missed = -values[v * n + c];
    for (std::size_t i = 0; i < 4; ++i) missed += share[i] * values[t[i] * n + c];
    sum += missed * missed - kRounding * rounded;
  }
  return part.scale * part.scale * sum;
}

struct Plane {
  Vector3 normal{};  // as long as twice the area
  double area2 = 0;
};
Plane planeOf(const LatticeMesh& mesh, const Triangle& t) {
  const Vector3 p = toVector(mesh.points[t[0]]);
  const Vector3 n = cross(toVector(mesh.points[t[1]]) - p, toVector(mesh.points[t[2]]) - p);
  return {n, std::sqrt(dot(n, n))};
}

}  // namespace

std::uint64_t faceStep(std::uint64_t cells) {
  // a face inside has two sides, so there are twice as many faces as cells
  return std::max<std::uint64_t>(1, 2 * cells / kFaces);
}

bool isSampledFace(const LatticeMesh& mesh, const Triangle& face, std::uint64_t step) {
  return step == 1 || numberOf(mesh, face) % step == 0;
}

std::vector<double> expectedFieldErrors(const LatticeMesh& mesh, std::span<const CostPart> parts) {
  return expectedFieldErrors(mesh, parts, faceStep(mesh.tetrahedra.size()));
}

std::vector<double> expectedFieldErrors(const LatticeMesh& mesh, std::span<const CostPart> parts,
                                        std::uint64_t step) {
  std::vector<Side<3>> sides = sidesOfFaces(mesh, step);
  std::vector<Mean> missed(parts.size());
  forEachPair(sides, [&](const Side<3>& a, const Side<3>& b) {
    const Tetrahedron &here = mesh.tetrahedra[a.owner], &there = mesh.tetrahedra[b.owner];
    const auto fromHere = linearCell(mesh, here, mesh.points[b.opposite]);
    const auto fromThere = linearCell(mesh, there, mesh.points[a.opposite]);
    if (!fromHere || !fromThere) return;
    const double weight = fromHere->volume6 + fromThere->volume6;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      missed[i].add(missedAt(mesh, parts[i], here, fromHere->share, b.opposite), weight);
      missed[i].add(missedAt(mesh, parts[i], there, fromThere->share, a.opposite), weight);
    }
  });
  std::vector<double> out;
  for (const Mean& mean : missed) out.push_back(mean.value());
  return out;
}

std::uint64_t edgeStep(std::uint64_t triangles) {
  return std::max<std::uint64_t>(1, 3 * triangles / (2 * kEdges));
}

bool isSampledEdge(const LatticeMesh& mesh, VertexId a, VertexId b, std::uint64_t step) {
  return step == 1 || numberOf(mesh, std::array{a, b}) % step == 0;
}

double expectedBoundaryError(const LatticeMesh& mesh) { return expectedBoundaryError(mesh, 1); }

double expectedBoundaryError(const LatticeMesh& mesh, std::uint64_t step) {
  std::vector<Side<2>> sides;
  for (std::uint32_t t = 0; t < mesh.boundary.size(); ++t) {
    const Triangle& face = mesh.boundary[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [least, most] = std::minmax(face[(i + 1) % 3], face[(i + 2) % 3]);
      if (isSampledEdge(mesh, least, most, step)) sides.push_back({{least, most}, face[i], t});
    }
  }
  Mean missed;
  forEachPair(sides, [&](const Side<2>& a, const Side<2>& b) {
    const Plane here = planeOf(mesh, mesh.boundary[a.owner]),
                there = planeOf(mesh, mesh.boundary[b.owner]);
    if (!(here.area2 > 0 && there.area2 > 0)) return;
    const double weight = here.area2 + there.area2;
    const bool isCrease = dot(here.normal, there.normal) < kCrease * here.area2 * there.area2;
    const Vector3 from = toVector(mesh.points[a.shared[0]]);
    const auto add = [&](const Plane& plane, VertexId far) {
      const double height = dot(plane.normal, toVector(mesh.points[far]) - from) / plane.area2;
      missed.add(isCrease ? 0 : height * height, weight);
    };
    add(here, b.opposite), add(there, a.opposite);
  });
  return missed.value();
}

}  // namespace qtet
