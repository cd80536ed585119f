// Makes the log of a series that is too large for memory (SERIES.md, "Long series"). A sample of
// its instants chooses the fusions. Then all instants are coded in windows.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "simplify/pipeline/pipeline.h"

namespace qtet {

/// Integers of all instants together, above which a series is made in windows. So many take some
/// 300 MB where they are simplified at once.
inline constexpr std::size_t kMaxValuesAtOnce = std::size_t{16} << 20;

/// The instants by which the fusions are chosen.
inline constexpr std::size_t kSampledInstants = 8;

/// The first and the last of so many steps and others at equal distances, kSampledInstants at most.
[[nodiscard]] std::vector<std::size_t> sampledSteps(std::size_t steps);

/// Reads these steps, ascending, as one mesh whose fields are instants NAME@TIME. All steps must
/// have the same points and tetrahedra.
using InstantsReader = std::function<Result<TetMesh>(std::span<const std::size_t> steps)>;

/// As simplifyToLog, for a series of so many steps. `sample` holds the instants of sampledSteps().
/// Fields that are no instants come from it. Float instants have room: values may lie one range of
/// the sample below it, and some above. Memory holds the values of one window.
/// Statistics read all steps once more, before the first fusion. Errors: simplifyToLog's, `read`'s,
/// checkTimeStatistics's, FieldAdder's; bad-value (exact values are to be kept).
[[nodiscard]] Result<PipelineOutput> simplifySeries(TetMesh&& sample, std::size_t steps,
                                                    const InstantsReader& read,
                                                    const PipelineOptions& options);

}  // namespace qtet
