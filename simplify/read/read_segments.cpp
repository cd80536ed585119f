#include "simplify/read/read_segments.h"

#include <optional>
#include <utility>

#include "proto/number_text.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/steps/step_order.h"

namespace qtet {
namespace {

/// One step of the file without its fields. `report` is on this step alone.
Result<CellMesh> readStep(const std::filesystem::path& path, const ReadOptions& options,
                          const std::string& time, ReadReport& report) {
  ReadOptions one = options;
  one.time = time;
  one.fields.emplace();
  report = {};
  return readStoredCells(path, one, report);
}

}  // namespace

Result<std::vector<std::vector<double>>> segmentTimes(const std::filesystem::path& path,
                                                      const ReadOptions& options,
                                                      const std::function<void(double)>& progress,
                                                      std::vector<std::string>& notes) {
  std::vector<std::vector<double>> out;
  ReadReport report;
  Result<CellMesh> first = readStep(path, options, "first", report);
  if (!first) return std::unexpected(first.error());
  const std::vector<double> times = std::move(report.times);
  if (times.empty()) return out;
  ReadOptions decided = options;
  if (!decided.apartBlocks) decided.apartBlocks = report.apartBlocks;
  const auto steps = chosenSteps(times, options.time, path, notes);
  if (!steps) return std::unexpected(steps.error());
  CellMesh rest;  // of the run; joinSteps compares its steps with the first, too
  std::optional<StepOrder> order;
  for (const std::size_t step : *steps) {
    Result<CellMesh> mesh = step == 0 ? std::exchange(first, CellMesh())
                                      : readStep(path, decided, shortestText(times[step]), report);
    if (!mesh) return std::unexpected(mesh.error());
    if (!order || (!haveSameCells(rest, *mesh) && !order->restore(*mesh))) {
      out.emplace_back();
      rest = std::move(*mesh);
      order.emplace(rest);
    }
    out.back().push_back(times[step]);
    progress(static_cast<double>(step + 1) / static_cast<double>(steps->back() + 1));
  }
  return out;
}

}  // namespace qtet
