// Whole files of VTK's XML that hold one step: its time, its pieces, the names of its labels.
#pragma once

#include <filesystem>
#include <optional>

#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// The step, if `options.time` means it, with the fields that the options mean. nullopt: the file
/// holds several steps, which no program writes any more, and VTK has to read it. Errors: those of
/// readVtuDocument, readVtu and chosenSteps.
[[nodiscard]] Result<std::optional<TimedCells>> readXmlGrid(const std::filesystem::path& path,
                                                            const ReadOptions& options,
                                                            ReadReport& report);

}  // namespace qtet
