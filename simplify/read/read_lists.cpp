#include "simplify/read/read_lists.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "proto/field_list.h"
#include "simplify/read/foreign/read_foreign.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/parts/file_series.h"
#include "simplify/read/parts/named_files.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/read_steps.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/steps/step_reports.h"

namespace qtet {
namespace {

using Steps = std::vector<TimedCells>;

/// Files that name files that name files: a series of .vtm of .pvtu has three.
constexpr int kMaxDepth = 8;

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
    if (!traitsOf(format).mayBePart)
      return badFile(path, "it names " + part.string() +
                               ", but may name VTK's files alone; convert that to .vtu first");
    if (Status checked = checkMeshFile(part, format); !checked)
      return fail(checked.error().code, path.string() + " names it: " + checked.error().message);
    ReadReport ofOne;
    Result<Steps> read = readSteps(part, format, ofPart, ofOne, depth + 1);
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
    const auto isIt = [&](const MeshField& field) { return field.name == name; };
    if (!isNoted && std::ranges::none_of(cells.fields, isIt) &&
        std::ranges::find(cells.otherFields, name) == cells.otherFields.end() &&
        std::ranges::find(report.ignoredFields, name) == report.ignoredFields.end())
      lost.push_back(name);
  }
  if (!lost.empty())
    report.notes.push_back("its summary names arrays that no piece has: " + fieldList(lost));
  return {};
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

}  // namespace

Result<Steps> readParts(const std::filesystem::path& path, MeshFormat format,
                        const ReadOptions& options, ReadReport& report, int depth) {
  if (depth == kMaxDepth)
    return badFile(path, "files that name files go deeper than " + std::to_string(kMaxDepth) +
                             "; does one name itself?");
  if (const auto steps = chosenSteps({}, options.time, path, report.notes); !steps)
    return std::unexpected(steps.error());
  const auto parts =
      traitsOf(format).namesPieces ? piecesOf(path, format) : blocksOf(path, report.notes);
  if (!parts) return std::unexpected(parts.error());
  Result<CellMesh> cells = cellsOfParts(*parts, path, options, report, depth);
  if (!cells) return std::unexpected(cells.error());
  if (traitsOf(format).namesPieces)
    if (Status noted = noteStatedArrays(path, format, *cells, report); !noted)
      return std::unexpected(noted.error());
  Steps out;
  out.push_back({"", std::move(*cells)});
  return out;
}

Result<Steps> readSeries(const std::filesystem::path& path, MeshFormat format,
                         const ReadOptions& options, ReadReport& report, int depth) {
  const auto entries = entriesOf(path, format, options.listed);
  if (!entries) return std::unexpected(entries.error());
  const auto all = stepsOfSeries(*entries, path, report.notes);
  if (!all) return std::unexpected(all.error());
  std::vector<double> times;
  for (const SeriesStep& step : *all) times.push_back(step.time);
  return readChosen(times, path, options, report, [&](std::size_t step, ReadReport& ofStep) {
    std::vector<BlockFile> parts;
    for (const std::filesystem::path& file : (*all)[step].files) parts.push_back({file, ""});
    return cellsOfParts(parts, path, options, ofStep, depth);
  });
}

Result<Steps> readExodusPieces(const std::filesystem::path& path, MeshFormat,
                               const ReadOptions& options, ReadReport& report, int) {
  const auto files = exodusPieces(path);
  if (!files) return std::unexpected(files.error());
  std::vector<Steps> pieces;
  for (const std::filesystem::path& file : *files) {
    ReadReport ofOne;
    Result<Steps> steps = readByVtk(file, MeshFormat::kExodus, options, ofOne);
    if (!steps) return steps;
    addPiece(std::move(ofOne), report);
    pieces.push_back(std::move(*steps));
  }
  return joinedPieces(std::move(pieces), path, options, report);
}

}  // namespace qtet
