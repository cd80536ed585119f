#include "simplify/cost/boundary_weight.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "codec/mesh/boundary.h"
#include "simplify/cost/expected_error.h"
#include "simplify/mesh/cell_corners.h"
#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

// The factor on the fields' change over the distance that the boundary is off by, squared. The
// other one is on the boundary's expected error beside the fields'. With four times as much, fields
// are 4 to 14 % further off at equal cells. The envelope's tolerance keeps the volume (HISTORY.md).
constexpr double kWorth = 1.5;
constexpr double kBalance = 0.25;
// More puts the shape before the fields, which is a user's choice. Less would give the shape away
// where fields are so smooth that they hardly need cells.
constexpr double kMaxWeight = 200;
constexpr double kMinWeight = 0.05;

// The steepness of the fields in the cost: the sum of their squared gradients in a cell of positive
// volume.
class Steepness {
 public:
  Steepness(const LatticeMesh& mesh, std::span<const CostPart> parts)
      : mesh_(mesh), parts_(parts) {}

  [[nodiscard]] double in(const Tetrahedron& t) const {
    const Vector3 p = toVector(mesh_.points[t[0]]);
    const Vector3 e1 = toVector(mesh_.points[t[1]]) - p, e2 = toVector(mesh_.points[t[2]]) - p,
                  e3 = toVector(mesh_.points[t[3]]) - p;
    const Vector3 c23 = cross(e2, e3), c31 = cross(e3, e1), c12 = cross(e1, e2);
    const double inverse = 1 / dot(e1, c23);
    double sum = 0;
    for (const CostPart& part : parts_) {
      const std::size_t n = mesh_.fields[part.field].components;
      for (std::size_t c = 0; c < n; ++c) {
        const auto rise = [&](std::size_t corner) {
          return inverse * part.scale *
                 (mesh_.values[part.field][t[corner] * n + c] -
                  mesh_.values[part.field][t[0] * n + c]);
        };
        const Vector3 g = rise(1) * c23 + rise(2) * c31 + rise(3) * c12;
        sum += dot(g, g);
      }
    }
    return sum;
  }

 private:
  const LatticeMesh& mesh_;
  std::span<const CostPart> parts_;
};

double volumeOf(const LatticeMesh& mesh, const Tetrahedron& t) {
  const Vector3 p = toVector(mesh.points[t[0]]);
  return dot(toVector(mesh.points[t[1]]) - p,
             cross(toVector(mesh.points[t[2]]) - p, toVector(mesh.points[t[3]]) - p)) /
         6;
}

double areaOf(const LatticeMesh& mesh, const Triangle& t) {
  const Vector3 p = toVector(mesh.points[t[0]]);
  const Vector3 n = cross(toVector(mesh.points[t[1]]) - p, toVector(mesh.points[t[2]]) - p);
  return 0.5 * std::sqrt(dot(n, n));
}

bool isFaceOf(const Tetrahedron& t, const Triangle& face) {
  // seldom goes on in vain
  if (cornersThatAre(t, face[0]) == 0 || cornersThatAre(t, face[1]) == 0) return false;
  for (int i = 0; i < 4; ++i)
    if (cellFace(t, i) == face) return true;
  return false;
}

}  // namespace

double diagonalOf(const LatticeMesh& mesh) {
  LatticePoint low = mesh.points.empty() ? LatticePoint{} : mesh.points[0], high = low;
  for (const LatticePoint& p : mesh.points)
    for (std::size_t a = 0; a < 3; ++a)
      low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const Vector3 d = toVector(high) - toVector(low);
  return std::max(1.0, std::sqrt(dot(d, d)));
}

double balancedBoundaryWeight(const LatticeMesh& mesh, std::span<const CostPart> parts,
                              std::span<const double> fieldErrors) {
  assert(parts.size() == fieldErrors.size());
  BoundarySums sums;
  sums.add(mesh, parts);
  return balancedBoundaryWeight(sums, diagonalOf(mesh), expectedBoundaryError(mesh), fieldErrors);
}

void BoundarySums::add(const LatticeMesh& mesh, std::span<const CostPart> parts) {
  const Steepness steepness(mesh, parts);
  auto face = mesh.boundary.begin();  // the next: they come in the order of the cells
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const double own = volumeOf(mesh, t);
    if (own > 0) volume += own;
    for (; face != mesh.boundary.end() && isFaceOf(t, *face); ++face) {
      if (!(own > 0)) continue;
      const double a = areaOf(mesh, *face);
      area += a;
      steep += a * steepness.in(t);
    }
  }
}

double balancedBoundaryWeight(const BoundarySums& sums, double diagonal, double boundaryError,
                              std::span<const double> fieldErrors) {
  if (!(sums.area > 0)) return kMaxWeight;
  // Means over area and volume: boundary area / diagonal against volume is how the two terms of the
  // cost are summed.
  const double scale = diagonal * sums.volume / sums.area;
  const double worth = kWorth * scale * (sums.steep / sums.area);
  const double fields = std::max(0.0, std::accumulate(fieldErrors.begin(), fieldErrors.end(), 0.0));
  const double balance = boundaryError > 0 ? kBalance * scale * fields / boundaryError : kMaxWeight;
  return std::clamp(std::min(worth, std::sqrt(worth * balance)), kMinWeight, kMaxWeight);
}

}  // namespace qtet
