#include "simplify/read/read_mesh.h"

#include <algorithm>

#include "proto/field_key.h"
#include "simplify/clean/mend_faces.h"
#include "simplify/read/listed_files.h"
#include "simplify/read/options/grid_parts.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/options/select_fields.h"
#include "simplify/read/parts/own_points.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/parts/weld_points.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/read_steps.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/unused_points.h"

namespace qtet {
namespace {

/// Everything that a reader must read: also what the threshold looks at.
ReadOptions withThresholdField(ReadOptions options) {
  if (options.threshold && options.fields) options.fields->push_back(options.threshold->field);
  return options;
}

Result<CellMesh> joined(Result<std::vector<TimedCells>> steps, const std::filesystem::path& path,
                        const ReadOptions& options, ReadReport& report) {
  if (!steps) return std::unexpected(steps.error());
  if (steps->size() == 1 && !(options.namesTime && !steps->front().time.empty()))
    return std::move(steps->front().cells);
  return joinSteps(std::move(*steps), path, options.fields, report, options.moves);
}

Result<CellMesh> readWhole(const std::filesystem::path& path, const ReadOptions& options,
                           ReadReport& report);

bool isCompressed(const std::filesystem::path& path) { return path.extension() == ".gz"; }

Result<CellMesh> readCompressed(const std::filesystem::path& path, const ReadOptions& options,
                                ReadReport& report) {
  const MeshFormat format = formatOf(
      options.format.empty() ? path.stem() : std::filesystem::path("mesh." + options.format));
  if (!traitsOf(format).standsAlone)
    return fail(ErrorCode::kBadInput,
                path.string() +
                    " is compressed, which is read of .vtu, .vts, .vtr, .vti, .vtk, .inp, .msh, "
                    ".mesh, .meshb, .su2 and .unv alone; inflate it with gunzip");
  if (Status checked = checkMeshFile(path, MeshFormat::kOther); !checked)
    return std::unexpected(checked.error());
  Result<CellMesh> out = CellMesh{};
  std::string inner;
  const Status done = inflated(path, [&](const std::filesystem::path& file) -> Status {
    inner = file.string();
    out = readWhole(file, options, report);
    return out ? Status{} : Status(std::unexpected(out.error()));
  });
  if (!done) return std::unexpected(done.error());
  for (std::string& note : report.notes) note = withName(note, inner, path.string());
  return out;
}

/// A series of numbered files, as one that a file lists.
Result<CellMesh> readListed(const std::filesystem::path& path, const ReadOptions& options,
                            ReadReport& report) {
  if (!options.listed.note.empty()) report.notes.push_back(options.listed.note);
  return joined(readSteps(path, MeshFormat::kSeries, options, report), path, options, report);
}

/// Reads with the blocks apart that `given` names, else where their values differ.
Result<CellMesh> readWhole(const std::filesystem::path& path, const ReadOptions& given,
                           ReadReport& report) {
  if (isFoamCase(path))
    return joined(readSteps(path / "", MeshFormat::kOpenFoam, given, report), path, given, report);
  const Result<ReadOptions> withFiles = withListedFiles(path, given);
  if (!withFiles) return std::unexpected(withFiles.error());
  const ReadOptions& options = *withFiles;
  if (!options.listed.files.empty()) return readListed(path, options, report);
  if (isCompressed(path) && !options.plot3d) return readCompressed(path, options, report);
  const std::filesystem::path named =
      options.format.empty() ? path : std::filesystem::path("mesh." + options.format);
  const MeshFormat format =
      options.plot3d ? MeshFormat::kPlot3d : formatOfContent(path, formatOf(named));
  if (Status checked = checkMeshFile(path, format); !checked)
    return std::unexpected(checked.error());
  if (path.extension() == ".qtet")
    return fail(ErrorCode::kBadInput,
                path.string() +
                    " is a log, which holds a mesh that is simplified already: qtet info tells of "
                    "it, qtet convert gives the mesh back");
  return joined(readSteps(path, format, options, report), path, options, report);
}

/// The blocks that differ at the file's first step in some field, whatever is asked for. So all
/// readings of a file make one mesh of it. `found` is what a reading of `asked` says of them.
BlockPairs apartBlocksOf(const std::filesystem::path& path, const ReadOptions& asked,
                         const ReadReport& found) {
  const bool hasFirst = asked.time == "first" || found.times.size() < 2;
  if (!asked.fields && hasFirst) return found.differingBlocks;
  ReadOptions first = asked;
  first.fields.reset();
  first.time = "first";
  ReadReport out;
  // A first step that cannot be read says nothing of the others.
  return readWhole(path, first, out) ? out.differingBlocks : found.differingBlocks;
}

Result<CellMesh> readFile(const std::filesystem::path& path, const ReadOptions& asked,
                          ReadReport& report) {
  const ReadReport before = report;
  Result<CellMesh> out = readWhole(path, asked, report);
  // Steps that fit together only after the decision are refused before.
  if (!report.blocksMeet || asked.apartBlocks) return out;
  ReadOptions decided = asked;
  decided.apartBlocks = apartBlocksOf(path, asked, report);
  if (!decided.apartBlocks->empty() || !report.differingBlocks.empty()) {
    out = {};
    report = before;
    out = readWhole(path, decided, report);
  }
  report.apartBlocks = decided.apartBlocks;
  return out;
}

/// "of its 12 cells, 8 hexahedron and 4 wedge were split"
void noteSplit(const SplitReport& split, std::vector<std::string>& notes) {
  if (split.onlyTetrahedra()) return;
  std::string kinds;
  for (std::size_t type = 0; type < split.cells.size(); ++type) {
    if (split.cells[type] == 0 || type == kTetrahedronCell) continue;
    kinds += (kinds.empty() ? "" : ", ") + cellTypeName(static_cast<std::uint8_t>(type)) + " " +
             std::to_string(split.cells[type]);
  }
  notes.push_back("cells split into tetrahedra: " + kinds);
  if (split.centrePoints > 0)
    notes.push_back(
        "points added at cells' centres, where no split through their own vertices fits: " +
        std::to_string(split.centrePoints));
  if (split.insideOut > 0)
    notes.push_back("cells stored inside out, turned: " + std::to_string(split.insideOut));
  if (split.collapsed > 0)
    notes.push_back("cells that name so few different vertices that nothing is left of them: " +
                    std::to_string(split.collapsed));
}

/// --original-ids asks for them beside the fields that are named.
void meanOriginalIds(const std::vector<MeshField>& fields, FieldNames& names,
                     std::vector<std::string>& notes) {
  const std::string key = "cell:" + std::string(kOriginalCellField);
  if (fieldsOfKey(fields, key).empty())
    notes.emplace_back(
        "`originalIds`: no cell was split, so that each tetrahedron is one of the file's; "
        "`keepOrder` keeps their numbering");
  else if (names)
    names->push_back(key);
}

void mend(TetMesh& mesh, ReadReport& report) {
  const MendReport mended = mendCrossedFaces(mesh);
  report.mendedFaces = mended.mended;
  if (mended.mended > 0)
    report.notes.push_back(
        "quadrilaterals whose two sides were cut along different diagonals, now along one: " +
        std::to_string(mended.mended));
  if (mended.left > 0)
    report.notes.push_back(
        "quadrilaterals that stay open, because no other cut of either side leaves its cells "
        "positive: " +
        std::to_string(mended.left));
}

/// The ids that joined the pieces are numbers of the file's own points. Nobody looks at them.
void leaveOutIds(CellMesh& cells, std::vector<std::string>& notes) {
  std::string left;
  std::erase_if(cells.fields, [&](const MeshField& field) {
    const std::string_view name = field.name.withoutTime();
    if (isCellField(field) || std::ranges::find(kGlobalIdNames, name) == std::end(kGlobalIdNames))
      return false;
    left = name;
    cells.otherFields.push_back(field.name);
    return true;
  });
  if (!left.empty())
    notes.push_back("point field " + left +
                    " joined the pieces and is left out; `fields` reads it, too");
}

OwnJoin ownJoinOf(const ReadOptions& options) {
  if (!options.joinPieces || options.joinsOwnPoints == false) return OwnJoin::kNever;
  if (options.joinsOwnPoints == true) return OwnJoin::kAlways;
  return options.namesTime ? OwnJoin::kStep : OwnJoin::kByValues;
}

/// Joins cells that have points of their own, or warns that they stay apart.
void joinApartCells(CellMesh& cells, const ReadOptions& options, ReadReport& report) {
  const OwnJoin how = ownJoinOf(options);
  const OwnPoints own = joinOwnPoints(cells, how);
  if (own.patches == 0) return;
  report.joinedPoints += own.joined;
  report.ownPointsJoined = !own.isTorn();
  const std::string sets = "its " + std::to_string(own.patches) +
                           " cells or patches of cells have points of their own, of which " +
                           std::to_string(own.coincident) + " lie at the place of another";
  if (!own.isTorn()) {
    report.notes.push_back(sets + ": " + std::to_string(own.joined) +
                           " were joined; `weld` none would keep them apart");
    if (own.differing > 0)
      report.notes.push_back(
          std::to_string(own.differing) +
          " of these points have other values, by more than a thousandth of a field's range, and " +
          (how == OwnJoin::kByValues ? "stay apart; `weld` 0 joins them"
                                     : "took those of the earlier cell"));
    return;
  }
  report.warnings.push_back(
      sets +
      (own.differing > 0 && options.joinPieces
           ? ", but " + std::to_string(own.differing) +
                 " have other values there: a discontinuous field"
           : "") +
      ". Cells that hang together nowhere can hardly be simplified, and take many times the bytes; "
      "`weld` 0 joins the points, with the values of the earlier cell");
}

}  // namespace

Result<CellMesh> readStoredCells(const std::filesystem::path& path, const ReadOptions& options,
                                 ReadReport& report) {
  return readFile(path, options, report);
}

Result<CellMesh> readCells(const std::filesystem::path& path, const ReadOptions& options,
                           ReadReport& report) {
  Result<CellMesh> cells = readFile(path, withThresholdField(options), report);
  if (!cells) return cells;
  addLabelFields(withThresholdField(options).fields, *cells, report);
  nameFields(cells->fields, report.notes);
  if (report.joinedByIds && !options.fields) leaveOutIds(*cells, report.notes);
  if (report.ignoredCells > 0 && cells->cells() > 0)
    report.notes.push_back(std::to_string(report.ignoredCells) +
                           " points, lines and faces among the cells were ignored");
  dropUnusedPoints(*cells, report.notes);
  if (Status checked = checkCellMesh(*cells, path); !checked)
    return std::unexpected(checked.error());
  if (!options.keepsNumbers)
    leaveOutNumbers(withThresholdField(options).fields, *cells, report.notes);
  if (!options.weld) joinApartCells(*cells, options, report);
  if (Status done = leaveOutWideIntegers(withThresholdField(options).fields, path, cells->fields,
                                         report.notes);
      !done)
    return std::unexpected(done.error());
  if (options.threshold) {
    if (Status done = applyThreshold(*options.threshold, path, *cells); !done)
      return std::unexpected(done.error());
  }
  if (options.weld) {
    report.weldedPoints = weldPoints(*cells, *options.weld, report.motion);
    report.notes.push_back("points joined with an earlier one (`weld`): " +
                           std::to_string(report.weldedPoints));
  }
  return cells;
}

Result<TetMesh> tetrahedraOf(CellMesh&& cells, const std::filesystem::path& path,
                             const ReadOptions& options, ReadReport& report) {
  const std::vector<std::string> otherFields = std::move(cells.otherFields);
  FieldNames names = options.fields;
  const bool isNamed = names && std::ranges::any_of(*names, [](const std::string& name) {
                         return isCalled("cell", kOriginalCellField, name);
                       });
  Result<TetMesh> mesh =
      splitCells(std::move(cells), {options.curved, options.originalIds || isNamed}, report.split);
  if (!mesh) return fail(mesh.error().code, path.string() + ": " + mesh.error().message);
  noteSplit(report.split, report.notes);
  if (options.weld || report.joinedPoints > 0) mend(*mesh, report);
  if (options.originalIds) meanOriginalIds(mesh->fields, names, report.notes);
  if (Status selected = selectFields(names, path, otherFields, mesh->fields); !selected)
    return std::unexpected(selected.error());
  return mesh;
}

Result<ReadMesh> readMesh(const std::filesystem::path& path, const ReadOptions& options) {
  ReadMesh out;
  Result<CellMesh> cells = readCells(path, options, out.report);
  if (!cells) return std::unexpected(cells.error());
  Result<TetMesh> mesh = tetrahedraOf(std::move(*cells), path, options, out.report);
  if (!mesh) return std::unexpected(mesh.error());
  out.mesh = std::move(*mesh);
  return out;
}

Result<ReadMesh> readMesh(const std::filesystem::path& path, const FieldNames& fields) {
  ReadOptions options;
  options.fields = fields;
  return readMesh(path, options);
}

}  // namespace qtet
