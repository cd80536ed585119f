#include "codec/picture/first_warp.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/picture/first_camera.h"
#include "proto/limits.h"
#include "proto/series.h"

namespace qtet {
namespace {

constexpr std::array<std::string_view, 7> kDisplacements = {
    "displacement", "displacements", "disp", "displ", "udisp", "u_disp", "depl"};
/// The largest displacement is seen, and is one of this mesh, between these shares of the diagonal.
constexpr double kSeenShare = 0.01, kLongestShare = 1;
/// The volume of a regular tetrahedron of edge 1 is the root of 2 over this.
constexpr double kOverUnitVolume = 12;

bool isDisplacement(const ManifestField& field, std::string_view name) {
  std::string small(name);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return field.association == "point" && field.components == 3 &&
         std::ranges::find(kDisplacements, small) != kDisplacements.end();
}

/// The largest value of the field, or of its series.
double largestOf(const Manifest& manifest, std::uint32_t field) {
  double out = manifest.fields[field].range[1];
  for (const Series& series : manifest.series)
    if (std::ranges::find(series.fields, field) != series.fields.end())
      for (const std::size_t f : series.fields) out = std::max(out, manifest.fields[f].range[1]);
  return out;
}

bool isFirstMoved(const Manifest& manifest, const LatticeMesh& mesh, double largest) {
  const double cells = manifest.levels.empty() ? 0 : manifest.levels.back().tetrahedra;
  if (!(cells > 0)) return false;
  const Bounds bounds = boundsOf(mesh);
  const double step = mesh.lattice.step;
  double volume = 1, squares = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double side = step * (bounds.high[axis] - bounds.low[axis]);
    volume *= side, squares += side * side;
  }
  const double share = largest / std::sqrt(squares);
  const double edgeCubed = volume / cells * kOverUnitVolume / std::sqrt(2.0);
  return share >= kSeenShare && share <= kLongestShare && largest * largest * largest > edgeCubed;
}

}  // namespace

std::optional<std::uint32_t> displacementOf(const Manifest& manifest) {
  const std::vector<ManifestField>& fields = manifest.fields;
  const std::vector<bool> isLater = laterInstants(manifest.series, fields.size());
  std::vector<std::string_view> names(fields.size());
  for (std::size_t f = 0; f < fields.size(); ++f) names[f] = fields[f].name;
  for (const Series& series : manifest.series)
    for (const std::size_t f : series.fields) names[f] = series.name;
  for (std::uint32_t f = 0; f < fields.size(); ++f)
    if (!isLater[f] && isDisplacement(fields[f], names[f])) return f;
  return std::nullopt;
}

void moveAsFirstShown(LatticeMesh& mesh, const Manifest& manifest) {
  assert(!mesh.boundary.empty());
  const auto field = displacementOf(manifest);
  if (!field) return;
  const ManifestField& named = manifest.fields[*field];
  const auto at = std::ranges::find_if(mesh.fields, [&](const FieldInfo& info) {
    return info.name == named.name && info.association == named.association;
  });
  if (at == mesh.fields.end() || !isFirstMoved(manifest, mesh, largestOf(manifest, *field))) return;
  const auto& values = mesh.values[static_cast<std::size_t>(at - mesh.fields.begin())];
  // a log may say less of its values than they are
  const double furthest = std::ldexp(1.0, kMaxPositionBits);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    for (std::uint32_t c = 0; c < 3; ++c)
      if (const double value = at->value(c, values[3 * v + c]); !std::isnan(value))
        mesh.points[v][c] += static_cast<std::int32_t>(
            std::clamp(std::floor(value / mesh.lattice.step + 0.5), -furthest, furthest));
}

}  // namespace qtet
