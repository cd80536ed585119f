// Several steps or pieces of one result: which steps are read, and one report on all.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "proto/number_text.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// Moves the texts that are not there yet.
void addNew(std::vector<std::string>& from, std::vector<std::string>& to);

/// Adds which blocks meet, and which of them differ.
void addBlocks(ReadReport&& part, ReadReport& report);

/// Adds the report on one step more. Every step has the same mesh, so counts are those of one, and
/// earlier notes need not be repeated.
void addStep(ReadReport&& step, bool isFirst, ReadReport& report);

/// Adds the report on one piece of a result.
void addPiece(ReadReport&& piece, ReadReport& report);

/// The steps of one result's pieces, step by step in one mesh. Errors: bad-input (pieces with
/// different times). REQUIRES: one piece at least.
[[nodiscard]] Result<std::vector<TimedCells>> joinedPieces(
    std::vector<std::vector<TimedCells>> pieces, const std::filesystem::path& path,
    const ReadOptions& options, ReadReport& report);

/// Reads the steps that are meant. `readStep(number, report)` gives the mesh of one of `times`, or
/// of the file without times.
template <class ReadStep>
Result<std::vector<TimedCells>> readChosen(const std::vector<double>& times,
                                           const std::filesystem::path& path,
                                           const ReadOptions& options, ReadReport& report,
                                           const ReadStep& readStep) {
  const auto steps = chosenSteps(times, options.time, path, report.notes);
  if (!steps) return std::unexpected(steps.error());
  report.times = times;
  std::vector<TimedCells> out;
  for (std::size_t s = 0; s < std::max<std::size_t>(1, steps->size()); ++s) {
    const bool timed = !steps->empty();
    const std::size_t number = timed ? (*steps)[s] : 0;
    ReadReport step;
    Result<CellMesh> cells = readStep(number, step);
    if (!cells) return std::unexpected(cells.error());
    addStep(std::move(step), s == 0, report);
    out.push_back({timed ? shortestText(times[number]) : "", std::move(*cells)});
  }
  return out;
}

}  // namespace qtet
