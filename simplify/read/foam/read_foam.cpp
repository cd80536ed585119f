#include "simplify/read/foam/read_foam.h"

#include "simplify/read/foam/foam_fields.h"
#include "simplify/read/foam/poly_mesh.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/process/guarded_folder.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/steps/read_apart.h"
#include "simplify/read/steps/step_reports.h"
#include "simplify/read/vtk/run_vtk.h"

namespace qtet {
namespace {

/// A case of OpenFOAM in one folder. `marker` is the file that VTK opens for it.
Result<std::vector<TimedCells>> readFoamCase(const std::filesystem::path& folder,
                                             const std::filesystem::path& marker,
                                             const ReadOptions& options, ReadReport& report) {
  const auto cells = checkPolyMeshes(folder, options.patience);
  if (!cells) return std::unexpected(cells.error());
  Result<std::vector<TimedCells>> steps = readApart(
      marker, options, report,
      [&](ReadReport& found) { return runVtk(marker, MeshFormat::kOpenFoam, options, found); });
  if (!steps) return steps;
  for (const TimedCells& step : *steps)
    if (*cells && step.cells.cells() != **cells)
      return badFile(folder, "VTK found " + std::to_string(step.cells.cells()) + " of its " +
                                 std::to_string(**cells) +
                                 " cells; run checkMesh on the case, and write it again");
  return steps;
}

/// A decomposed case of OpenFOAM: each processor's folder is read as a case of its own.
Result<std::vector<TimedCells>> readProcessors(const std::vector<std::filesystem::path>& processors,
                                               const std::filesystem::path& path,
                                               const ReadOptions& options, ReadReport& report) {
  const GuardedFolder folder("foam");
  if (Status made = folder.made(); !made) return std::unexpected(made.error());
  std::vector<std::vector<TimedCells>> pieces;
  for (const std::filesystem::path& processor : processors) {
    const auto marker = caseOfProcessor(processor, folder.path() / processor.filename());
    if (!marker) return std::unexpected(marker.error());
    ReadReport ofOne;
    Result<std::vector<TimedCells>> steps = readFoamCase(processor, *marker, options, ofOne);
    const auto named = [&](const std::string& text) {
      return withName(withName(text, marker->string(), processor.string()),
                      marker->parent_path().string(), processor.string());
    };
    for (std::string& note : ofOne.notes) note = named(note);
    addPiece(std::move(ofOne), report);
    if (!steps) return fail(steps.error().code, named(steps.error().message));
    pieces.push_back(std::move(*steps));
  }
  report.notes.push_back("the case was read from the folders of its " +
                         std::to_string(processors.size()) + " processors");
  return joinedPieces(std::move(pieces), path, options, report);
}

}  // namespace

Result<std::vector<TimedCells>> readFoam(const std::filesystem::path& path,
                                         const ReadOptions& options, ReadReport& report) {
  const auto processors = processorFolders(path);
  if (!processors) return std::unexpected(processors.error());
  ReadOptions ofCells = options;
  ofCells.fields = foamFieldsToRead(options.fields);
  const std::filesystem::path folder = path.parent_path().empty() ? "." : path.parent_path();
  Result<std::vector<TimedCells>> steps = processors->empty()
                                              ? readFoamCase(folder, path, ofCells, report)
                                              : readProcessors(*processors, path, ofCells, report);
  if (!steps) return steps;
  std::vector<std::string> notes;
  for (TimedCells& step : *steps) foamFieldsAtPoints(options.fields, step.cells, notes);
  addNew(notes, report.notes);
  return steps;
}

}  // namespace qtet
