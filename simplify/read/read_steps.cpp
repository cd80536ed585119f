#include "simplify/read/read_steps.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "proto/field_list.h"
#include "proto/number_text.h"
#include "simplify/read/ensight/read_ensight.h"
#include "simplify/read/foam/read_foam.h"
#include "simplify/read/foreign/foreign_file.h"
#include "simplify/read/hdf/read_vtkhdf.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/byte_order_mark.h"
#include "simplify/read/parts/file_series.h"
#include "simplify/read/parts/named_files.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/steps/read_apart.h"
#include "simplify/read/steps/step_reports.h"
#include "simplify/read/text/text_readers.h"
#include "simplify/read/vtu/read_vtu.h"
#include "simplify/read/vtu/vtu_label_names.h"
#include "simplify/read/xdmf/read_xdmf.h"

namespace qtet {
namespace {

/// Files that name files that name files: a series of .vtm of .pvtu has three.
constexpr int kMaxDepth = 8;

bool isSeries(MeshFormat format) {
  return format == MeshFormat::kPvd || format == MeshFormat::kSeries;
}

Result<std::vector<TimedCells>> readByVtk(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report);

/// The step's partitions in one mesh.
Result<CellMesh> joinedPartitions(const VtkHdfFile& file, std::size_t step,
                                  const ReadOptions& options, ReadReport& report) {
  Result<std::vector<CellMesh>> blocks = file.partitions(step, options.fields, report);
  if (!blocks) return std::unexpected(blocks.error());
  return joinBlocks(std::move(*blocks), options, report);
}

Result<std::vector<TimedCells>> readVtkHdf(const std::filesystem::path& path,
                                           const ReadOptions& options, ReadReport& report) {
  const Result<VtkHdfFile> file = VtkHdfFile::open(path);
  if (!file) return std::unexpected(file.error());
  if (!file->isGrid()) return readByVtk(path, MeshFormat::kVtkHdf, options, report);
  return readChosen(file->times(), path, options, report,
                    [&](std::size_t step, ReadReport& ofStep) {
                      return joinedPartitions(*file, step, options, ofStep);
                    });
}

Result<std::vector<TimedCells>> readXdmf(const std::filesystem::path& path,
                                         const ReadOptions& options, ReadReport& report) {
  Result<XdmfFile> file = XdmfFile::open(path);
  if (!file) return std::unexpected(file.error());
  std::ranges::copy(file->notes(), std::back_inserter(report.notes));
  return readChosen(
      file->times(), path, options, report,
      [&](std::size_t step, ReadReport& ofStep) { return file->read(step, options, ofStep); });
}

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

/// Through VTK, or where that is not installed and meshio can, through meshio.
Result<std::vector<TimedCells>> readByVtk(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report) {
  ForeignInput input{path, ForeignLibrary::kVtk, vtkWord(format), options.plot3dSolution,
                     options.patience};
  auto out = readForeign(input, options, report);
  if (out || out.error().code != ErrorCode::kNotFound || !knowsMeshio(format)) return out;
  input.library = ForeignLibrary::kMeshio;
  auto other = readForeign(input, options, report);
  return other || other.error().code != ErrorCode::kNotFound ? std::move(other) : std::move(out);
}

/// The blocks that a document's pieces are; those of an unstructured grid are read as one.
Result<CellMesh> cellsOfDocument(const VtuFile& file, VtuDocument& document,
                                 const ReadOptions& options, ReadReport& report) {
  if (document.kind == GridKind::kUnstructured || document.pieces.size() == 1)
    return readVtu(file, document, options.fields, report);
  std::vector<CellMesh> blocks;
  const std::vector<VtuPiece> pieces = std::move(document.pieces);
  for (const VtuPiece& piece : pieces) {
    document.pieces = {piece};
    Result<CellMesh> cells = readVtu(file, document, options.fields, report);
    if (!cells) return cells;
    blocks.push_back(std::move(*cells));
  }
  return joinBlocks(std::move(blocks), options, report);
}

/// Reads a file of VTK's XML without VTK, unless it holds several steps, which no program writes
/// any more.
Result<std::vector<TimedCells>> readXmlGrid(const std::filesystem::path& path, MeshFormat format,
                                            const ReadOptions& options, ReadReport& report) {
  const Result<VtuFile> file = VtuFile::open(path, options.patience);
  if (!file) return std::unexpected(file.error());
  Result<VtuDocument> document = readVtuDocument(*file);
  if (!document) return std::unexpected(document.error());
  if (document->hasTimeSteps) return readByVtk(path, format, options, report);
  auto time = readVtuTime(*file, *document);
  if (!time) return std::unexpected(time.error());
  if (*time && !std::isfinite(**time)) {
    report.notes.push_back("its TimeValue is " + shortestText(**time) +
                           ", which is no time, and was ignored");
    time->reset();
  }
  std::vector<double> times;
  if (*time) times.push_back(**time);
  if (const auto steps = chosenSteps(times, options.time, path, report.notes); !steps)
    return std::unexpected(steps.error());
  ReadReport step;
  Result<CellMesh> cells = cellsOfDocument(*file, *document, options, step);
  if (!cells) return std::unexpected(cells.error());
  if (Status named = readVtuLabelNames(*file, *document, *cells); !named)
    return std::unexpected(named.error());
  addStep(std::move(step), true, report);
  std::vector<TimedCells> out;
  out.push_back({*time ? shortestText(**time) : "", std::move(*cells)});
  return out;
}

/// Reads a legacy file without VTK, unless it holds what that alone reads.
Result<std::vector<TimedCells>> readLegacy(const std::filesystem::path& path,
                                           const ReadOptions& options, ReadReport& report) {
  ReadReport found;
  Result<std::optional<CellMesh>> cells =
      readLegacyVtk(path, options.fields, found, options.patience);
  if (!cells) return std::unexpected(cells.error());
  if (!*cells) return readByVtk(path, MeshFormat::kLegacyVtk, options, report);
  return readChosen({}, path, options, report, [&](std::size_t, ReadReport& ofStep) {
    ofStep = std::move(found);
    return Result<CellMesh>(std::move(**cells));
  });
}

/// readSteps of a file that is named by one that is named by one ..., `depth` of them.
Result<std::vector<TimedCells>> readAt(const std::filesystem::path& path, MeshFormat format,
                                       const ReadOptions& options, ReadReport& report, int depth);

/// The cells of the files that the file at `path` names as parts of one mesh. Each is read alone
/// and by a reader of its own. VTK's readers of such files believe what the summary says of types
/// and components, and write beyond their arrays where a part has others.
Result<CellMesh> cellsOfParts(std::span<const BlockFile> parts, const std::filesystem::path& path,
                              const ReadOptions& options, ReadReport& report, int depth) {
  std::vector<CellMesh> blocks;
  ReadOptions ofPart = options;
  ofPart.time = "last";  // the step is chosen already, and a part knows no times
  ofPart.listed = {};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::filesystem::path& part = parts[i].path;
    const MeshFormat format = formatOf(part);
    if (isSeries(format) || format >= MeshFormat::kGmsh)
      return badFile(path, "it names " + part.string() +
                               ", but may name VTK's files alone; convert that to .vtu first");
    if (Status checked = checkMeshFile(part, format); !checked)
      return fail(checked.error().code, path.string() + " names it: " + checked.error().message);
    ReadReport ofOne;
    Result<std::vector<TimedCells>> read = readAt(part, format, ofPart, ofOne, depth + 1);
    if (!read) return std::unexpected(read.error());
    addPiece(std::move(ofOne), report);
    blocks.push_back(std::move(read->back().cells));
    nameBlock(parts[i].name, static_cast<std::int32_t>(i + 1), blocks.back());
  }
  const bool isOne = blocks.size() == 1;
  CellMesh out = joinBlocks(std::move(blocks), options, report);
  if (isOne) report.pieces = 1;
  return out;
}

/// Says which arrays a summary names that are neither fields nor left out for a reason.
Status noteStatedArrays(const std::filesystem::path& path, MeshFormat format, const CellMesh& cells,
                        ReadReport& report) {
  const auto stated = statedArrays(path, format);
  if (!stated) return std::unexpected(stated.error());
  std::vector<std::string> lost;
  for (const std::string& name : *stated) {
    const bool isNoted = std::ranges::any_of(report.notes, [&](const std::string& note) {
      return note.find(" field " + name + " ") != std::string::npos;
    });
    if (!isNoted && std::ranges::find(cells.fields, name, &MeshField::name) == cells.fields.end() &&
        std::ranges::find(cells.otherFields, name) == cells.otherFields.end() &&
        std::ranges::find(report.ignoredFields, name) == report.ignoredFields.end())
      lost.push_back(name);
  }
  if (!lost.empty())
    report.notes.push_back("its summary names arrays that no piece has: " + fieldList(lost));
  return {};
}

/// A file that names the parts of one mesh.
Result<std::vector<TimedCells>> readParts(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report,
                                          int depth) {
  if (depth == kMaxDepth)
    return badFile(path, "files that name files go deeper than " + std::to_string(kMaxDepth) +
                             "; does one name itself?");
  if (const auto steps = chosenSteps({}, options.time, path, report.notes); !steps)
    return std::unexpected(steps.error());
  const auto parts = namesPieces(format) ? piecesOf(path, format) : blocksOf(path, report.notes);
  if (!parts) return std::unexpected(parts.error());
  Result<CellMesh> cells = cellsOfParts(*parts, path, options, report, depth);
  if (!cells) return std::unexpected(cells.error());
  if (namesPieces(format))
    if (Status noted = noteStatedArrays(path, format, *cells, report); !noted)
      return std::unexpected(noted.error());
  std::vector<TimedCells> out;
  out.push_back({"", std::move(*cells)});
  return out;
}

Result<std::vector<SeriesEntry>> entriesOf(const std::filesystem::path& path, MeshFormat format,
                                           const ListedFiles& listed) {
  if (listed.files.empty())
    return format == MeshFormat::kPvd ? entriesOfPvd(path) : entriesOfJson(path);
  std::vector<SeriesEntry> out;
  for (std::size_t i = 0; i < listed.files.size(); ++i)
    out.push_back({listed.times[i], static_cast<int>(i), listed.files[i]});
  return out;
}

Result<std::vector<TimedCells>> readSeries(const std::filesystem::path& path, MeshFormat format,
                                           const ReadOptions& options, ReadReport& report) {
  const auto entries = entriesOf(path, format, options.listed);
  if (!entries) return std::unexpected(entries.error());
  const auto all = stepsOfSeries(*entries, path, report.notes);
  if (!all) return std::unexpected(all.error());
  std::vector<double> times;
  for (const SeriesStep& step : *all) times.push_back(step.time);
  return readChosen(times, path, options, report, [&](std::size_t step, ReadReport& ofStep) {
    std::vector<BlockFile> parts;
    for (const std::filesystem::path& file : (*all)[step].files) parts.push_back({file, ""});
    return cellsOfParts(parts, path, options, ofStep, 0);
  });
}

Result<std::vector<TimedCells>> readExodusPieces(const std::filesystem::path& path,
                                                 const ReadOptions& options, ReadReport& report) {
  const auto files = exodusPieces(path);
  if (!files) return std::unexpected(files.error());
  std::vector<std::vector<TimedCells>> pieces;
  for (const std::filesystem::path& file : *files) {
    ReadReport ofOne;
    Result<std::vector<TimedCells>> steps = readByVtk(file, MeshFormat::kExodus, options, ofOne);
    if (!steps) return steps;
    addPiece(std::move(ofOne), report);
    pieces.push_back(std::move(*steps));
  }
  return joinedPieces(std::move(pieces), path, options, report);
}

Result<std::vector<TimedCells>> readAt(const std::filesystem::path& path, MeshFormat format,
                                       const ReadOptions& options, ReadReport& report, int depth) {
  if (isSeries(format)) return readSeries(path, format, options, report);
  if (format == MeshFormat::kVtu || format == MeshFormat::kVts || format == MeshFormat::kVtr ||
      format == MeshFormat::kVti)
    return readXmlGrid(path, format, options, report);
  if (format == MeshFormat::kLegacyVtk) return readLegacy(path, options, report);
  if (format == MeshFormat::kExodusPieces) return readExodusPieces(path, options, report);
  if (format == MeshFormat::kEnSight) return readEnSight(path, options, report);
  if (format == MeshFormat::kOpenFoam) return readFoam(path, options, report);
  if (namesPieces(format) || format == MeshFormat::kVtm)
    return readParts(path, format, options, report, depth);
  if (format == MeshFormat::kVtkHdf || format == MeshFormat::kXdmf)
    return readApart(path, options, report, [&](ReadReport& found) {
      return format == MeshFormat::kXdmf ? readXdmf(path, options, found)
                                         : readVtkHdf(path, options, found);
    });
  return readByVtk(path, format, options, report);
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

Result<std::vector<TimedCells>> readForeign(const ForeignInput& input, const ReadOptions& options,
                                            ReadReport& report) {
  if (isMarkedText(input)) {
    Result<std::vector<TimedCells>> out = std::vector<TimedCells>{};
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
                      Result<CellMesh> cells = cellsOfParts(*parts, input.path, options, ofStep, 0);
                      for (const BlockFile& part : *parts) {
                        const std::string name = part.path.string(), own = input.path.string();
                        for (std::string& note : ofStep.notes) note = withName(note, name, own);
                        if (!cells)
                          cells.error().message = withName(cells.error().message, name, own);
                      }
                      return cells;
                    });
}

Result<std::vector<TimedCells>> readSteps(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report) {
  return readAt(path, format, options, report, 0);
}

}  // namespace qtet
