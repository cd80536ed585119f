#include "simplify/read/parts/point_values.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

namespace qtet {
namespace {

/// The largest extent over the field's components.
double rangeOf(const MeshField& field) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double range = 0;
  for (std::size_t c = 0; c < field.components; ++c) {
    double least = kInfinity, largest = -kInfinity;
    for (std::size_t i = c; i < field.values.size(); i += field.components) {
      if (!std::isfinite(field.values[i])) continue;
      least = std::min(least, field.values[i]);
      largest = std::max(largest, field.values[i]);
    }
    range = std::max(range, largest - least);
  }
  return range;
}

}  // namespace

PointValues::PointValues(const CellMesh& mesh, std::span<const std::int32_t> blocks)
    : blocks_(blocks) {
  assert(blocks.empty() || blocks.size() == mesh.points.size());
  if (blocks.empty()) return;
  for (const MeshField& field : mesh.fields)
    if (!isCellField(field) && isFloatType(field.type) &&
        field.values.size() == mesh.points.size() * field.components)
      fields_.push_back({&field, kSameValues * rangeOf(field)});
}

bool PointValues::agree(VertexId a, VertexId b) const {
  assert(blocks_.empty() || (a < blocks_.size() && b < blocks_.size()));
  if (blocks_.empty() || blocks_[a] == blocks_[b]) return true;
  return std::ranges::all_of(fields_, [&](const Field& field) {
    const std::size_t n = field.values->components;
    for (std::size_t c = 0; c < n; ++c) {
      const double one = field.values->values[a * n + c], other = field.values->values[b * n + c];
      if (std::isfinite(one) && std::isfinite(other) && std::abs(one - other) > field.tolerance)
        return false;
    }
    return true;
  });
}

}  // namespace qtet
