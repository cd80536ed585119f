#include "tests/bench/parts/direct_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "simplify/measure/measure_samples.h"
#include "simplify/mesh/triangle_tree.h"

namespace qtet::bench {
namespace {

constexpr std::uint64_t kSeed = 20261121;  // none that simplify/ measures with

/// A mesh's boundary as ghost cells, with a search tree.
class Surface {
 public:
  explicit Surface(const LatticeMesh& mesh) : points_(mesh.points), ids_(mesh.boundary.size()) {
    for (const Triangle& t : mesh.boundary) cells_.push_back({t[0], t[1], t[2], kGhost});
    std::iota(ids_.begin(), ids_.end(), 0u);
    tree_.emplace(points_, cells_, ids_);
  }
  [[nodiscard]] NearestTriangle nearest(const Vector3& p) const {
    NearestTriangle best;
    tree_->nearest(p, best);
    return best;
  }
  [[nodiscard]] double meanDistanceTo(const Surface& other, std::size_t samples) const {
    double sum = 0;
    const std::vector<ErrorSample> places = samplesOnSurface(points_, cells_, ids_, samples, kSeed);
    for (const ErrorSample& place : places) sum += std::sqrt(other.nearest(place.at).point.squared);
    return sum / static_cast<double>(std::max<std::size_t>(places.size(), 1));
  }
  [[nodiscard]] const Tetrahedron& cell(std::uint32_t triangle) const { return cells_[triangle]; }

 private:
  std::span<const LatticePoint> points_;
  std::vector<Tetrahedron> cells_;
  std::vector<std::uint32_t> ids_;
  std::optional<TriangleTree> tree_;
};

double diagonal(const LatticeMesh& mesh) {
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::ranges::minmax(mesh.points, {}, [axis](const LatticePoint& p) { return p[axis]; });
    squared += std::pow(high[axis] - low[axis], 2);
  }
  return std::sqrt(squared);
}

double sixVolumes(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const auto minus = [&](const Vector3& p) {
    return Vector3{p[0] - a[0], p[1] - a[1], p[2] - a[2]};
  };
  const Vector3 u = minus(b), v = minus(c), w = minus(d);
  return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

Vector3 at(const LatticeMesh& mesh, VertexId v) {
  const LatticePoint& p = mesh.points[v];
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// Sum of weight times value over a cell's vertices; a ghost has no weight.
template <std::size_t N>
double valueIn(const LatticeMesh& mesh, const Tetrahedron& cell,
               const std::array<double, N>& weights) {
  double out = 0;
  for (std::size_t i = 0; i < N; ++i) out += weights[i] * mesh.values[0][cell[i]];
  return out;
}

/// The value at p in the first cell that holds it; nullopt outside of all.
std::optional<double> valueInside(const LatticeMesh& mesh, const Vector3& p) {
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    const auto isBeyond = [&](std::size_t axis) {
      const auto [low, high] =
          std::ranges::minmax(cell, {}, [&](VertexId v) { return mesh.points[v][axis]; });
      return p[axis] < mesh.points[low][axis] || p[axis] > mesh.points[high][axis];
    };
    if (isBeyond(0) || isBeyond(1) || isBeyond(2)) continue;
    const Vector3 a = at(mesh, cell[0]), b = at(mesh, cell[1]), c = at(mesh, cell[2]),
                  d = at(mesh, cell[3]);
    const double whole = sixVolumes(a, b, c, d);
    const std::array<double, 4> weights{
        sixVolumes(p, b, c, d) / whole, sixVolumes(a, p, c, d) / whole,
        sixVolumes(a, b, p, d) / whole, sixVolumes(a, b, c, p) / whole};
    if (std::ranges::all_of(weights, [](double w) { return w >= -1e-9; }))
      return valueIn(mesh, cell, weights);
  }
  return std::nullopt;
}

}  // namespace

DirectError directError(const LatticeMesh& original, const LatticeMesh& level,
                        std::size_t samples) {
  const Surface boundary(original), levelBoundary(level);
  DirectError out;
  out.boundary = std::max(boundary.meanDistanceTo(levelBoundary, samples),
                          levelBoundary.meanDistanceTo(boundary, samples)) /
                 diagonal(original);

  double squares = 0;
  const std::vector<ErrorSample> places =
      samplesInVolume(original.points, original.tetrahedra, samples, kSeed);
  for (const ErrorSample& place : places) {
    std::optional<double> value = valueInside(level, place.at);
    if (!value) {
      const NearestTriangle nearest = levelBoundary.nearest(place.at);
      value = valueIn(level, levelBoundary.cell(nearest.triangle), nearest.point.weights);
    }
    squares +=
        std::pow(*value - valueIn(original, original.tetrahedra[place.cell], place.weights), 2);
  }
  const auto [low, high] = std::ranges::minmax(original.values[0]);
  out.field = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(places.size(), 1))) /
              (high - low);
  return out;
}

}  // namespace qtet::bench
