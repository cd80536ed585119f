#include "simplify/read/steps/moving_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "codec/coding/float_rounding.h"
#include "proto/field_name.h"

namespace qtet {
namespace {

bool isSameNumber(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool hasField(const CellMesh& mesh, std::string_view name) {
  const auto isCalledSo = [&](const FieldName& own) {
    return own == name || own.withoutTime() == name;
  };
  return std::ranges::any_of(mesh.fields, isCalledSo, &MeshField::name) ||
         std::ranges::any_of(mesh.otherFields, isCalledSo);
}

/// By point: whether a cell uses it.
std::vector<bool> usedPoints(const CellMesh& mesh) {
  std::vector<bool> out(mesh.points.size());
  for (std::size_t i = 0; i < mesh.cells(); ++i)
    forEachId(mesh.types[i], mesh.cell(i), [&](VertexId v) {
      if (v < out.size()) out[v] = true;
    });
  return out;
}

}  // namespace

bool areSamePoints(std::span<const Position> a, std::span<const Position> b) {
  return std::ranges::equal(a, b, [](const Position& p, const Position& q) {
    return isSameNumber(p[0], q[0]) && isSameNumber(p[1], q[1]) && isSameNumber(p[2], q[2]);
  });
}

std::string displacementName(const CellMesh& step) {
  std::string name(kDisplacement);
  for (int again = 1; hasField(step, name); ++again)
    name = std::string(kMotionField) + (again == 1 ? "" : "-" + std::to_string(again));
  return name;
}

std::string displacementType(const CellMesh& rest, const CellMesh& step) {
  return rest.pointType == "float32" && step.pointType == "float32" ? "float32" : "float64";
}

Result<MeshField> displacementOf(const CellMesh& rest, std::span<const Position> points,
                                 const std::string& type) {
  assert(type == "float32" || type == "float64");
  if (points.size() != rest.points.size())
    return fail(ErrorCode::kBadInput, std::to_string(points.size()) + " points, not " +
                                          std::to_string(rest.points.size()));
  const bool isNarrow = type == "float32";
  MeshField out{"", 3, type, {}};
  out.values.reserve(3 * points.size());
  std::vector<bool> used;  // made for the first point whose displacement is not finite
  for (std::size_t v = 0; v < points.size(); ++v) {
    Position moved{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double by = points[v][c] - rest.points[v][c];
      moved[c] = isNarrow ? roundedToFloat(by) : by;
    }
    if (!std::ranges::all_of(moved, [](double x) { return std::isfinite(x); })) {
      if (used.empty()) used = usedPoints(rest);
      if (used[v])
        return fail(ErrorCode::kBadInput,
                    "point " + std::to_string(v) +
                        " has a coordinate that is NaN or infinite, or moves too far");
      moved = {};
    }
    out.values.insert(out.values.end(), moved.begin(), moved.end());
  }
  return out;
}

double largestDisplacement(const MeshField& field) {
  assert(field.components == 3);
  double most = 0;
  for (std::size_t i = 0; i + 3 <= field.values.size(); i += 3)
    most = std::max(most, std::hypot(field.values[i], field.values[i + 1], field.values[i + 2]));
  return most;
}

}  // namespace qtet
