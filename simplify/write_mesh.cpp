#include "simplify/write_mesh.h"

#include <algorithm>
#include <cassert>

#include "codec/boundary_drc.h"
#include "codec/boundary_glb.h"
#include "codec/float_rounding.h"
#include "codec/mesh_file.h"
#include "codec/vtu_writer.h"
#include "simplify/clean_mesh.h"
#include "simplify/quantise.h"

namespace qtet {
namespace {

/// Of positions and fields where a format needs a lattice and the mesh has none.
constexpr int kExportBits = 16;

bool onLattice(const std::filesystem::path& output) { return output.extension() == ".glb" || output.extension() == ".drc"; }

Result<Bytes> latticeFileBytes(const LatticeMesh& mesh, const std::filesystem::path& output) {
  return output.extension() == ".glb" ? boundaryGlb(mesh) : boundaryDrc(mesh);
}

Result<Bytes> floatFileBytes(const FileMesh& mesh, const std::filesystem::path& output) {
  const std::string kind = output.extension();
  if (kind == ".vtu") return vtuBytes(mesh);
  if (kind == ".vtk") return legacyVtkBytes(mesh);
  if (kind == ".msh") return gmshBytes(mesh);
  if (kind == ".stl") return stlBytes(surfaceOf(mesh));
  if (kind == ".ply") return plyBytes(surfaceOf(mesh), mesh.doublePoints);
  if (kind == ".obj") return objBytes(surfaceOf(mesh));
  if (kind == ".usda") return usdaBytes(mesh);
  assert(kind == ".npz");
  return npzBytes(mesh);
}

}  // namespace

FileMesh fileMesh(const TetMesh& mesh) {
  const auto isFloat = [](double x) { return roundedToFloat(x) == x; };
  FileMesh out{mesh.points, mesh.tetrahedra, true};
  out.doublePoints = mesh.pointType == "float64" || !std::all_of(mesh.points.begin(), mesh.points.end(),
                                  [&](const Position& p) { return isFloat(p[0]) && isFloat(p[1]) && isFloat(p[2]); });
  for (const MeshField& field : mesh.fields)
    (isCellField(field) ? out.cellFields : out.pointFields).push_back({field.name, field.type, field.components, field.values});
  return out;
}

Bytes vtuBytes(const TetMesh& mesh) { return vtuBytes(fileMesh(mesh)); }

Result<Bytes> meshFileBytes(const TetMesh& mesh, const std::filesystem::path& output) {
  if (!onLattice(output)) return floatFileBytes(fileMesh(mesh), output);
  TetMesh cleaned = mesh;
  if (const Result<CleanReport> report = cleanMesh(cleaned); !report) return std::unexpected(report.error());
  QuantiseOptions options;
  options.positionBits = options.fieldBits = kExportBits;
  const Result<QuantisedMesh> quantised = quantise(cleaned, options);
  return quantised ? latticeFileBytes(quantised->mesh, output) : std::unexpected(quantised.error());
}

Result<Bytes> meshFileBytes(const LatticeMesh& mesh, const std::filesystem::path& output) {
  return onLattice(output) ? latticeFileBytes(mesh, output) : floatFileBytes(fileMesh(mesh).mesh, output);
}

}  // namespace qtet
