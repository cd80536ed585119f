#include "simplify/read_mesh.h"

#include "simplify/join_blocks.h"
#include "simplify/mend_faces.h"
#include "simplify/mesh_format.h"
#include "simplify/mesh_readers.h"
#include "simplify/select_fields.h"
#include "simplify/vtk_grid.h"
#include "simplify/weld_points.h"

namespace qtet {
namespace {

/// Everything that a reader must read: also what the threshold looks at.
ReadOptions withThresholdField(ReadOptions options) {
  if (options.threshold && options.fields) options.fields->push_back(options.threshold->field);
  return options;
}

Result<CellMesh> readFile(const std::filesystem::path& path, const ReadOptions& options, ReadReport& report) {
  const MeshFormat format = options.plot3d ? MeshFormat::kPlot3d : formatOf(path);
  if (Status checked = checkMeshFile(path, format); !checked) return std::unexpected(checked.error());
  switch (format) {
    case MeshFormat::kGmsh: return readGmsh(path, report);
    case MeshFormat::kMedit: return readMedit(path, report);
    case MeshFormat::kTetgen: return readTetgen(path, report);
    case MeshFormat::kSu2: return readSu2(path, report);
    default: break;
  }
  Result<std::vector<TimedCells>> steps = readVtk(path, format, options, report);
  if (!steps) return std::unexpected(steps.error());
  if (steps->size() == 1) return std::move(steps->front().cells);
  return joinSteps(std::move(*steps), path);
}

/// "of its 12 cells, 8 hexahedron and 4 wedge were split"
void noteSplit(const SplitReport& split, std::vector<std::string>& notes) {
  if (split.onlyTetrahedra()) return;
  std::string kinds;
  for (std::size_t type = 0; type < split.cells.size(); ++type) {
    if (split.cells[type] == 0 || type == kTetrahedronCell) continue;
    kinds += (kinds.empty() ? "" : ", ") + cellTypeName(static_cast<std::uint8_t>(type)) + " " + std::to_string(split.cells[type]);
  }
  notes.push_back("cells split into tetrahedra: " + kinds);
  if (split.centrePoints > 0) notes.push_back("points added at cells' centres, where no split through their own vertices fits: " + std::to_string(split.centrePoints));
  if (split.insideOut > 0) notes.push_back("cells stored inside out, turned: " + std::to_string(split.insideOut));
  if (split.collapsed > 0) notes.push_back("cells that name so few different vertices that nothing is left of them: " + std::to_string(split.collapsed));
}

void mend(TetMesh& mesh, ReadReport& report) {
  const MendReport mended = mendCrossedFaces(mesh);
  report.mendedFaces = mended.mended;
  if (mended.mended > 0) report.notes.push_back("quadrilaterals whose two sides were cut along different diagonals, now along one: " + std::to_string(mended.mended));
  if (mended.left > 0) report.notes.push_back("quadrilaterals that stay open, because no other cut of either side leaves its cells positive: " + std::to_string(mended.left));
}

}  // namespace

Result<CellMesh> readCells(const std::filesystem::path& path, const ReadOptions& options, ReadReport& report) {
  Result<CellMesh> cells = readFile(path, withThresholdField(options), report);
  if (!cells) return cells;
  if (report.ignoredCells > 0 && cells->cells() > 0)
    report.notes.push_back(std::to_string(report.ignoredCells) + " points, lines and faces among the cells were ignored");
  if (Status checked = checkCellMesh(*cells, path); !checked) return std::unexpected(checked.error());
  if (options.threshold) {
    if (Status done = applyThreshold(*options.threshold, path, *cells); !done) return std::unexpected(done.error());
  }
  if (options.weld) {
    report.weldedPoints = weldPoints(*cells, *options.weld);
    report.notes.push_back("points joined with one that lies within " + std::to_string(*options.weld) + ": " + std::to_string(report.weldedPoints));
  }
  return cells;
}

Result<ReadMesh> readMesh(const std::filesystem::path& path, const ReadOptions& options) {
  ReadMesh out;
  Result<CellMesh> cells = readCells(path, options, out.report);
  if (!cells) return std::unexpected(cells.error());
  const std::vector<std::string> otherFields = std::move(cells->otherFields);
  Result<TetMesh> mesh = splitCells(std::move(*cells), options.curved, out.report.split);
  if (!mesh) return fail(mesh.error().code, path.string() + ": " + mesh.error().message);
  out.mesh = std::move(*mesh);
  noteSplit(out.report.split, out.report.notes);
  if (options.weld) mend(out.mesh, out.report);
  if (Status selected = selectFields(options.fields, path, otherFields, out.mesh.fields); !selected) return std::unexpected(selected.error());
  return out;
}

Result<ReadMesh> readMesh(const std::filesystem::path& path, const FieldNames& fields) {
  ReadOptions options;
  options.fields = fields;
  return readMesh(path, options);
}

}  // namespace qtet
