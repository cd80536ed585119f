#include "simplify/read/foreign/read_foreign.h"

#include <optional>
#include <span>
#include <utility>

#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/byte_order_mark.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/steps/step_reports.h"
#include "simplify/read/vtu/read_xml_grid.h"

namespace qtet {
namespace {

using Steps = std::vector<TimedCells>;

/// The program's word for what VTK reads (vtk.py).
const char* vtkWord(MeshFormat format) {
  switch (format) {
    case MeshFormat::kVtu: return "vtu";
    case MeshFormat::kVts: return "vts";
    case MeshFormat::kVtr: return "vtr";
    case MeshFormat::kVti: return "vti";
    case MeshFormat::kLegacyVtk: return "vtk";
    case MeshFormat::kExodus: return "exodus";
    case MeshFormat::kCgns: return "cgns";
    case MeshFormat::kFluent: return "fluent";
    case MeshFormat::kVtkHdf: return "vtkhdf";
    case MeshFormat::kPlot3d: return "plot3d";
    default: return "avsucd";
  }
}

/// Whether meshio reads it as well, by the same word.
bool knowsMeshio(MeshFormat format) {
  return format == MeshFormat::kLegacyVtk || format == MeshFormat::kAvsUcd ||
         format == MeshFormat::kExodus;
}

/// The blocks of a step, as a library has written them, in one mesh.
Result<CellMesh> cellsOfBlocks(std::span<const BlockFile> parts, const ReadOptions& options,
                               ReadReport& report) {
  std::vector<CellMesh> blocks;
  ReadOptions ofPart = options;
  ofPart.time = "last";  // the step is chosen already
  for (const BlockFile& part : parts) {
    ReadReport ofOne;
    Result<std::optional<TimedCells>> step = readXmlGrid(part.path, ofPart, ofOne);
    if (!step) return std::unexpected(step.error());
    if (!*step) return badFile(part.path, "it was written with several steps");
    addPiece(std::move(ofOne), report);
    blocks.push_back(std::move((*step)->cells));
    nameBlock(part.name, static_cast<std::int32_t>(blocks.size()), blocks.back());
  }
  return joinBlocks(std::move(blocks), options, report);
}

/// Text in which a library does not pass a byte order mark. An XDMF file names files beside it, and
/// Python's parser of XML passes the mark.
bool isMarkedText(const ForeignInput& input) {
  const bool isText = input.library == ForeignLibrary::kMeshio
                          ? input.kind != "xdmf"
                          : input.kind == "vtk" || input.kind == "avsucd" || input.kind == "fluent";
  return isText && isMarked(input.path);
}

}  // namespace

Result<Steps> readForeign(const ForeignInput& input, const ReadOptions& options,
                          ReadReport& report) {
  if (isMarkedText(input)) {
    Result<Steps> out = Steps{};
    ForeignInput copy = input;
    const Status done = unmarked(input.path, [&](const std::filesystem::path& file) -> Status {
      copy.path = file;
      out = readForeign(copy, options, report);
      return out ? Status{} : Status(std::unexpected(out.error()));
    });
    for (std::string& note : report.notes)
      note = withName(note, copy.path.string(), input.path.string());
    if (!done) return std::unexpected(done.error());
    return out;
  }
  Result<ForeignFile> file = ForeignFile::open(input);
  if (!file) return std::unexpected(file.error());
  return readChosen(file->times(), input.path, options, report,
                    [&](std::size_t step, ReadReport& ofStep) -> Result<CellMesh> {
                      const auto parts = file->step(step, ofStep.notes);
                      if (!parts) return std::unexpected(parts.error());
                      Result<CellMesh> cells = cellsOfBlocks(*parts, options, ofStep);
                      for (const BlockFile& part : *parts) {
                        const std::string name = part.path.string(), own = input.path.string();
                        for (std::string& note : ofStep.notes) note = withName(note, name, own);
                        if (!cells)
                          cells.error().message = withName(cells.error().message, name, own);
                      }
                      return cells;
                    });
}

Result<Steps> readByVtk(const std::filesystem::path& path, MeshFormat format,
                        const ReadOptions& options, ReadReport& report) {
  ForeignInput input{path, ForeignLibrary::kVtk, vtkWord(format), options.plot3dSolution,
                     options.patience};
  auto out = readForeign(input, options, report);
  if (out || out.error().code != ErrorCode::kNotFound || !knowsMeshio(format)) return out;
  input.library = ForeignLibrary::kMeshio;
  auto other = readForeign(input, options, report);
  return other || other.error().code != ErrorCode::kNotFound ? std::move(other) : std::move(out);
}

}  // namespace qtet
