#include "simplify/read/steps/step_reports.h"

#include <span>
#include <utility>

#include "simplify/read/steps/join_blocks.h"

namespace qtet {
namespace {

/// "0, 0.5", at most some of them.
std::string timesIn(std::span<const TimedCells> steps) {
  constexpr std::size_t kShown = 6;
  std::string out;
  for (const TimedCells& step : steps.first(std::min(kShown, steps.size())))
    out += (out.empty() ? "" : ", ") + (step.time.empty() ? "none" : step.time);
  return out + (steps.size() > kShown ? " and so on" : "");
}

}  // namespace

void addNew(std::vector<std::string>& from, std::vector<std::string>& to) {
  for (std::string& text : from)
    if (std::ranges::find(to, text) == to.end()) to.push_back(std::move(text));
}

void addBlocks(ReadReport&& part, ReadReport& report) {
  report.blocksMeet = report.blocksMeet || part.blocksMeet;
  report.differingBlocks.merge(part.differingBlocks);
}

void addStep(ReadReport&& step, bool isFirst, ReadReport& report) {
  report.pieces = step.pieces;
  report.joinedPoints = step.joinedPoints;
  report.joinedByIds = step.joinedByIds;
  if (isFirst) {
    report.ignoredCells += step.ignoredCells;
    report.ignoredFields.insert(report.ignoredFields.end(), step.ignoredFields.begin(),
                                step.ignoredFields.end());
  }
  addNew(step.notes, report.notes);
  addBlocks(std::move(step), report);
}

void addPiece(ReadReport&& piece, ReadReport& report) {
  report.ignoredCells += piece.ignoredCells;
  report.times = std::move(piece.times);
  addNew(piece.ignoredFields, report.ignoredFields);
  addNew(piece.notes, report.notes);
  addBlocks(std::move(piece), report);
}

Result<std::vector<TimedCells>> joinedPieces(std::vector<std::vector<TimedCells>> pieces,
                                             const std::filesystem::path& path,
                                             const ReadOptions& options, ReadReport& report) {
  const auto timesDiffer = [&](const std::vector<TimedCells>& piece) {
    return !std::ranges::equal(piece, pieces.front(), {}, &TimedCells::time, &TimedCells::time);
  };
  if (const auto other = std::ranges::find_if(pieces, timesDiffer); other != pieces.end())
    return fail(ErrorCode::kBadInput,
                path.string() + ": its pieces have different time steps, " +
                    timesIn(pieces.front()) + " in piece 0 and " + timesIn(*other) + " in piece " +
                    std::to_string(other - pieces.begin()) +
                    "; name one that all have with `time`, or write the missing ones");
  std::vector<TimedCells> out;
  for (std::size_t s = 0; s < pieces.front().size(); ++s) {
    std::vector<CellMesh> blocks;
    for (std::vector<TimedCells>& piece : pieces) blocks.push_back(std::move(piece[s].cells));
    ReadReport step;
    CellMesh cells = joinBlocks(std::move(blocks), options, step);
    addStep(std::move(step), s == 0, report);
    out.push_back({pieces.front()[s].time, std::move(cells)});
  }
  return out;
}

}  // namespace qtet
