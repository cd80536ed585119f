#include "simplify/log/write_mesh.h"

#include <algorithm>

#include "codec/coding/float_rounding.h"
#include "codec/files/vtu_writer.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/quantise.h"

namespace qtet {
namespace {

/// Bits of positions and fields where a format needs a lattice and the mesh has none.
constexpr int kExportBits = 16;

}  // namespace

FileMesh fileMesh(const TetMesh& mesh) {
  const auto isFloat = [](double x) { return roundedToFloat(x) == x; };
  FileMesh out{mesh.points, mesh.tetrahedra, true};
  out.doublePoints = mesh.pointType == "float64" ||
                     !std::all_of(mesh.points.begin(), mesh.points.end(), [&](const Position& p) {
                       return isFloat(p[0]) && isFloat(p[1]) && isFloat(p[2]);
                     });
  for (const MeshField& field : mesh.fields)
    (isCellField(field) ? out.cellFields : out.pointFields)
        .push_back({field.name,
                    field.type,
                    field.components,
                    FieldNumbers(field.values.size(), [&field] { return field.values; }),
                    {},
                    field.labelNames});
  return out;
}

Bytes vtuBytes(const TetMesh& mesh) { return vtuBytes(fileMesh(mesh)); }

Result<Bytes> meshFileBytes(const TetMesh& mesh, const std::filesystem::path& output,
                            const MeshFileOptions& file) {
  const std::string ending = output.extension().string();
  if (!needsLattice(ending)) return meshFileBytes(fileMesh(mesh), ending);
  TetMesh cleaned = mesh;
  Result<CleanReport> report = cleanMesh(cleaned);
  if (!report) return std::unexpected(report.error());
  QuantiseOptions options;
  options.positionBits = options.fieldBits = kExportBits;
  const Result<QuantisedMesh> quantised =
      quantise(cleaned, options, {}, std::move(report->boundary));
  return quantised ? meshFileBytes(quantised->mesh, ending, file)
                   : std::unexpected(quantised.error());
}

}  // namespace qtet
