#include "simplify/log/fused_values.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "codec/mesh/boundary.h"
#include "simplify/cost/fusion_cost.h"
#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

/// The mean of linear functions, with weights: the best value of a component at any place.
struct LinearMean {
  double weight = 0, constant = 0;
  Vector3 slope{};

  /// A function with slope g that is `value` at x.
  void add(double share, const Vector3& g, const Vector3& x, double value) {
    weight += share;
    constant += share * (value - dot(g, x));
    slope = slope + share * g;
  }
  void add(const LinearMean& other) {
    weight += other.weight;
    constant += other.constant;
    slope = slope + other.slope;
  }
  [[nodiscard]] double at(const Vector3& x) const {
    assert(weight > 0);
    return (dot(slope, x) + constant) / weight;
  }
};

class BestValues {
 public:
  BestValues(const LogHistory& log, std::span<const Tetrahedron> finest)
      : history_(log.history),
        vertices_(log.vertices),
        finest_(finest),
        boundary_(boundaryOf(finest)) {
    for (const LatticePoint& point : history_.points) points_.push_back(toVector(point));
    assert(vertices_ > 0 && vertices_ <= points_.size());
    Vector3 least = points_[0], most = least;
    for (VertexId v = 1; v < vertices_; ++v)
      for (std::size_t a = 0; a < 3; ++a)
        least[a] = std::min(least[a], points_[v][a]), most[a] = std::max(most[a], points_[v][a]);
    const Vector3 diagonal = most - least;
    layer_ = kWallLayer * std::sqrt(dot(diagonal, diagonal));
  }

  /// Component `c` of all fused vertices.
  void fill(std::vector<std::int32_t>& values, std::size_t c, std::size_t components) {
    const auto at = [&](VertexId v) -> std::int32_t& { return values[v * components + c]; };
    assert(c < components && values.size() == points_.size() * components);
    means_.assign(points_.size(), {});
    for (const Tetrahedron& cell : finest_) addCell(cell, at);
    for (const Triangle& triangle : boundary_) addTriangle(triangle, at);
    std::int32_t least = at(0), most = at(0);
    for (VertexId v = 1; v < vertices_; ++v)
      least = std::min(least, at(v)), most = std::max(most, at(v));
    for (const Fusion& fusion : history_.fusions) {
      assert(fusion.fused >= vertices_ && fusion.prey[0] < fusion.fused);
      LinearMean& mean = means_[fusion.fused];
      for (std::size_t i = 0; i < fusion.k; ++i) mean.add(means_[fusion.prey[i]]);
      at(fusion.fused) =
          mean.weight > 0
              ? static_cast<std::int32_t>(std::floor(
                    std::clamp<double>(mean.at(points_[fusion.fused]), least, most) + 0.5))
              : at(fusion.prey[0]);
    }
  }

 private:
  template <class At>
  void addCell(const Tetrahedron& cell, const At& at) {
    const Vector3 p = points_[cell[0]], e1 = points_[cell[1]] - p, e2 = points_[cell[2]] - p,
                  e3 = points_[cell[3]] - p;
    const Vector3 c23 = cross(e2, e3);
    const double volume6 = dot(e1, c23);
    if (!(volume6 > 0)) return;
    const double value = at(cell[0]);
    const Vector3 slope =
        (1 / volume6) * ((at(cell[1]) - value) * c23 + (at(cell[2]) - value) * cross(e3, e1) +
                         (at(cell[3]) - value) * cross(e1, e2));
    for (const VertexId v : cell) means_[v].add(volume6 / 6, slope, points_[v], at(v));
  }
  template <class At>
  void addTriangle(const Triangle& triangle, const At& at) {
    const Vector3 p = points_[triangle[0]], e1 = points_[triangle[1]] - p,
                  e2 = points_[triangle[2]] - p, n = cross(e1, e2);
    const double squared = dot(n, n);
    if (!(squared > 0)) return;
    const double value = at(triangle[0]);
    const Vector3 slope = (1 / squared) * ((at(triangle[1]) - value) * cross(e2, n) +
                                           (at(triangle[2]) - value) * cross(n, e1));
    const double weight = layer_ * 0.5 * std::sqrt(squared);
    for (const VertexId v : triangle) means_[v].add(weight, slope, points_[v], at(v));
  }

  const FusionHistory& history_;
  const VertexId vertices_;  // of the last level, the first ones
  std::span<const Tetrahedron> finest_;
  std::vector<Triangle> boundary_;
  std::vector<Vector3> points_;
  double layer_ = 0;               // thickness of the boundary's, in lattice steps
  std::vector<LinearMean> means_;  // by vertex, of the component in hand
};

}  // namespace

std::vector<std::int32_t> fusedValues(const LogHistory& log, std::span<const Tetrahedron> finest,
                                      std::vector<std::int32_t> values, std::uint32_t components) {
  assert(values.size() == log.vertices * std::size_t{components});
  values.resize(log.history.points.size() * components);
  BestValues best(log, finest);
  for (std::size_t c = 0; c < components; ++c) best.fill(values, c, components);
  return values;
}

}  // namespace qtet
