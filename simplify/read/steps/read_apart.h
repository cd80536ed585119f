// Runs a reader in a process of its own, for readers that damage can break.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

using StepReader = std::function<Result<std::vector<TimedCells>>(ReadReport& report)>;

/// Runs `read` in a process of its own, and brings back its result. It may write beyond its arrays
/// without a crash, but it spoils no memory of ours. Errors: those of `read`; bad-input (it
/// crashed, has read nothing for `options.patience`, or wanted more memory than there is); io.
[[nodiscard]] Result<std::vector<TimedCells>> readApart(const std::filesystem::path& path,
                                                        const ReadOptions& options,
                                                        ReadReport& report, const StepReader& read);

}  // namespace qtet
