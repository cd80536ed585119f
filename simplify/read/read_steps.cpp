#include "simplify/read/read_steps.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "proto/field_list.h"
#include "proto/number_text.h"
#include "simplify/read/ensight/read_ensight.h"
#include "simplify/read/foam/read_foam.h"
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
#include "simplify/read/vtk/run_vtk.h"
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
  if (!file->isGrid()) return runVtk(path, MeshFormat::kVtkHdf, options, report);
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

/// Text in which VTK's readers do not pass a byte order mark.
bool isVtkText(MeshFormat format) {
  return format == MeshFormat::kLegacyVtk || format == MeshFormat::kAvsUcd ||
         format == MeshFormat::kFluent;
}

/// A reader that damage can break, in a process of its own.
Result<std::vector<TimedCells>> readByVtk(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report) {
  Result<std::vector<TimedCells>> out = std::vector<TimedCells>{};
  const auto read = [&](const std::filesystem::path& file) -> Status {
    const std::size_t before = report.notes.size();
    out = readApart(file, options, report,
                    [&](ReadReport& found) { return runVtk(file, format, options, found); });
    for (std::string& note : std::span(report.notes).subspan(before))
      note = withName(note, file.string(), path.string());
    return out ? Status{} : Status(std::unexpected(out.error()));
  };
  const Status done = isVtkText(format) && isMarked(path) ? unmarked(path, read) : read(path);
  if (!done) return std::unexpected(done.error());
  return out;
}

/// Reads a .vtu file without VTK, unless it holds several steps, which no program writes any more.
Result<std::vector<TimedCells>> readUnstructured(const std::filesystem::path& path,
                                                 const ReadOptions& options, ReadReport& report) {
  const Result<VtuFile> file = VtuFile::open(path, options.patience);
  if (!file) return std::unexpected(file.error());
  const Result<VtuDocument> document = readVtuDocument(*file);
  if (!document) return std::unexpected(document.error());
  if (document->hasTimeSteps) return readByVtk(path, MeshFormat::kVtu, options, report);
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
  Result<CellMesh> cells = readVtu(*file, *document, options.fields, step);
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
  if (format == MeshFormat::kVtu) return readUnstructured(path, options, report);
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

}  // namespace

Result<std::vector<TimedCells>> readSteps(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options, ReadReport& report) {
  return readAt(path, format, options, report, 0);
}

}  // namespace qtet
