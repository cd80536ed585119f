#include "simplify/split/bezier_nodes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "codec/coding/float_rounding.h"
#include "simplify/split/higher_cells.h"

namespace qtet {
namespace {

double power(double base, int exponent) {
  assert(exponent >= 0);
  double out = 1;
  for (; exponent > 0; --exponent) out *= base;
  return out;
}

double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// n! / (a! b! ...) x^a y^b ... for exponents that sum to n: what a control point weighs at
/// barycentric coordinates.
template <std::size_t kCount>
double bernstein(const std::array<int, kCount>& exponents, const std::array<double, kCount>& at) {
  int n = 0;
  double out = 1;
  for (std::size_t k = 0; k < kCount; ++k) {
    n += exponents[k];
    out *= power(at[k], exponents[k]) / factorial(exponents[k]);
  }
  return out * factorial(n);
}

double alongALine(int degree, int control, int place) {
  assert(degree >= 1 && control >= 0 && control <= degree && place <= degree);
  const double t = place / static_cast<double>(degree);
  return bernstein<2>({degree - control, control}, {1 - t, t});
}

/// The weight of the control point at `control` in the point of the cell at `place`.
double weightAt(std::uint8_t type, const Degrees& d, const NodePlace& control,
                const NodePlace& place) {
  const double n = d[0], x = place[0] / n, y = place[1] / n, z = place[2] / n;
  if (type == kBezierTetrahedronCell)
    return bernstein<4>(
        {control[0], control[1], control[2], d[0] - control[0] - control[1] - control[2]},
        {x, y, z, 1 - x - y - z});
  const double across = alongALine(d[2], control[2], place[2]);
  if (type == kBezierWedgeCell)
    return across * bernstein<3>({control[0], control[1], d[0] - control[0] - control[1]},
                                 {x, y, 1 - x - y});
  return across * alongALine(d[0], control[0], place[0]) * alongALine(d[1], control[1], place[1]);
}

class Mover {
 public:
  explicit Mover(CellMesh& mesh)
      : mesh_(mesh), points_(mesh.points), moved_(mesh.points.size(), 0) {
    for (MeshField& field : mesh.fields) {
      if (field.name == kDegreesField && isCellField(field) && field.components == 3)
        degrees_ = &field;
      else if (field.name == kWeightsField && !isCellField(field) && field.components == 1)
        weights_ = &field;
      else if (!isCellField(field) && isFloatType(field.type))
        fields_.push_back({&field, field.values});
    }
  }

  Status run() {
    for (std::size_t i = 0; i < mesh_.cells(); ++i) {
      if (!isBezierCell(mesh_.types[i])) continue;
      if (Status done = moveNodesOf(i); !done) return done;
    }
    return {};
  }

 private:
  struct Kept {
    MeshField* field;
    std::vector<double> values;  ///< at the control points
  };

  Status moveNodesOf(std::size_t cell) {
    const std::uint8_t type = mesh_.types[cell];
    const std::span<const VertexId> ids = mesh_.cell(cell);
    const auto stated = degrees_ ? std::span<const double>(degrees_->values).subspan(3 * cell, 3)
                                 : std::span<const double>();
    const auto degrees = degreesOf(type, ids.size(), stated);
    if (!degrees)
      return fail(ErrorCode::kBadInput,
                  "cell " + std::to_string(mesh_.cellId(cell)) + " is a " + cellTypeName(type) +
                      " of " + std::to_string(ids.size()) + " nodes, which no degree has");
    const HigherCell& shape = higherCell(type, *degrees);
    assert(shape.places.size() == ids.size());
    for (std::size_t node = 0; node < ids.size(); ++node) {
      if (moved_[ids[node]]) continue;
      moved_[ids[node]] = 1;
      share_.resize(ids.size());
      double sum = 0;
      for (std::size_t k = 0; k < ids.size(); ++k) {
        const double weight = weights_ ? weights_->values[ids[k]] : 1;
        if (!(weight > 0))
          return fail(ErrorCode::kBadInput,
                      "point " + std::to_string(ids[k]) +
                          " of a rational Bezier cell has the weight " + std::to_string(weight) +
                          "; weights must be positive, export the mesh again");
        sum += share_[k] = weight * weightAt(type, *degrees, shape.places[k], shape.places[node]);
      }
      if (!(sum > 0 && std::isfinite(sum)))
        return fail(ErrorCode::kBadInput,
                    "cell " + std::to_string(mesh_.cellId(cell)) +
                        " is a rational Bezier cell whose weights are infinite or too small to "
                        "divide by; export the mesh again");
      for (double& share : share_) share /= sum;
      place(ids, ids[node]);
    }
    return {};
  }

  void place(std::span<const VertexId> ids, VertexId to) {
    assert(share_.size() == ids.size() && to < points_.size());
    for (std::size_t c = 0; c < 3; ++c)
      mesh_.points[to][c] = mean(ids, [&](VertexId v) { return points_[v][c]; });
    for (const Kept& kept : fields_) {
      const std::size_t n = kept.field->components;
      for (std::size_t c = 0; c < n; ++c) {
        const double value = mean(ids, [&](VertexId v) { return kept.values[v * n + c]; });
        kept.field->values[to * n + c] =
            kept.field->type == "float32" ? roundedToFloat(value) : value;
      }
    }
  }

  template <class Value>
  double mean(std::span<const VertexId> ids, const Value& value) const {
    double sum = 0;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      // so that a value without part in it may be NaN
      if (share_[k] > 0) sum += share_[k] * value(ids[k]);
    }
    return sum;
  }

  CellMesh& mesh_;
  std::vector<Position> points_;  ///< the control points
  std::vector<char> moved_;
  std::vector<double> share_;
  std::vector<Kept> fields_;
  const MeshField* degrees_ = nullptr;
  const MeshField* weights_ = nullptr;
};

}  // namespace

Status placeBezierNodes(CellMesh& mesh) {
  if (std::ranges::none_of(mesh.types, isBezierCell)) return {};
  return Mover(mesh).run();
}

}  // namespace qtet
