#include "simplify/read/vtu/read_xml_grid.h"

#include <cmath>
#include <utility>

#include "proto/number_text.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/steps/step_reports.h"
#include "simplify/read/vtu/read_vtu.h"
#include "simplify/read/vtu/vtu_label_names.h"

namespace qtet {
namespace {

/// The pieces of an unstructured grid are read as one, those of others as blocks.
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

}  // namespace

Result<std::optional<TimedCells>> readXmlGrid(const std::filesystem::path& path,
                                              const ReadOptions& options, ReadReport& report) {
  const Result<VtuFile> file = VtuFile::open(path, options.patience);
  if (!file) return std::unexpected(file.error());
  Result<VtuDocument> document = readVtuDocument(*file);
  if (!document) return std::unexpected(document.error());
  if (document->hasTimeSteps) return std::nullopt;
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
  return TimedCells{*time ? shortestText(**time) : "", std::move(*cells)};
}

}  // namespace qtet
