#include "codec/files/file_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "codec/coding/float_rounding.h"
#include "codec/mesh/boundary.h"

namespace qtet {
namespace {

bool survivesAsFloat(const Lattice& lattice, const LatticePoint& point) {
  const std::array<double, 3> exact = lattice.position(point);
  for (std::size_t k = 0; k < 3; ++k) {
    const double stored = roundedToFloat(exact[k]);
    // An eighth of a step more than rounding needs: readers' own arithmetic is not ours.
    if (!(std::abs((stored - lattice.origin[k]) / lattice.step - point[k]) < 0.375)) return false;
  }
  return true;
}

}  // namespace

FileField fileField(const FieldInfo& info) {
  return {info.name, info.type, info.components, {}, info.range, info.labelNames};
}

std::vector<double> dequantised(const FieldInfo& info, std::span<const std::int32_t> integers) {
  std::vector<double> out;
  out.reserve(integers.size());
  for (std::size_t i = 0; i < integers.size(); ++i)
    out.push_back(info.value(i % info.components, integers[i]));
  return out;
}

LatticeFileMesh fileMesh(const LatticeMesh& mesh) {
  LatticeFileMesh out;
  out.points.reserve(mesh.points.size());
  for (const LatticePoint& p : mesh.points) out.points.push_back(mesh.lattice.position(p));
  out.mesh.points = out.points;
  out.mesh.tetrahedra = mesh.tetrahedra;
  out.mesh.doublePoints =
      !std::all_of(mesh.points.begin(), mesh.points.end(),
                   [&](const LatticePoint& p) { return survivesAsFloat(mesh.lattice, p); });
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldInfo& info = mesh.fields[f];
    const std::vector<std::int32_t>& integers = mesh.values[f];
    FileField& field = (isCellField(info) ? out.mesh.cellFields : out.mesh.pointFields)
                           .emplace_back(fileField(info));
    field.values =
        FieldNumbers(integers.size(), [&info, &integers] { return dequantised(info, integers); });
  }
  return out;
}

Status fitsFloats(std::span<const std::array<double, 3>> points, const char* format) {
  constexpr double kMax = std::numeric_limits<float>::max();
  const auto fits = [](const std::array<double, 3>& p) {
    return std::ranges::all_of(p, [](double x) { return std::abs(x) <= kMax; });
  };
  if (std::ranges::all_of(points, fits)) return {};
  return fail(ErrorCode::kBadInput,
              std::string("the mesh's coordinates are beyond what float32 holds, and a ") + format +
                  " file knows no other; take the level as .vtu");
}

FileSurface surfaceOf(const FileMesh& mesh) {
  auto [used, triangles] = compactTriangles(boundaryOf(mesh.tetrahedra), mesh.points.size());
  FileSurface out;
  out.triangles = std::move(triangles);
  for (const VertexId v : used) out.points.push_back(mesh.points[v]);
  for (const FileField& field : mesh.pointFields) {
    const FieldNumbers::Held all = field.values.get();
    std::vector<double> kept;
    kept.reserve(used.size() * field.components);
    for (const VertexId v : used)
      for (std::uint32_t c = 0; c < field.components; ++c)
        kept.push_back((*all)[std::size_t{v} * field.components + c]);
    out.fields.push_back({field.name, field.type, field.components, std::move(kept), field.range});
  }
  return out;
}

}  // namespace qtet
