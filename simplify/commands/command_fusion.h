// The words of `qtet simplify` about what counts when fusing: weights, the envelope's tolerance,
// regions.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "simplify/clean/quantise.h"
#include "simplify/commands/command_line.h"
#include "simplify/fuse/qtetfusion.h"

namespace qtet {

/// Options with fields still by name.
struct FusionRequest {
  FusionOptions options;
  std::vector<std::pair<std::string, double>> fieldWeights;
  std::optional<std::string> regions;
};

void addFusionOptions(boost::program_options::options_description& options);
/// Throws UsageError.
[[nodiscard]] FusionRequest fusionRequestOf(const ParsedWords& parsed);

/// The options for this mesh. A point field counts by its weight, 1 where none is given; one of
/// integers counts only where one is. Those that are constant or hold values that are no numbers do
/// not count; `notes` says which and why. Errors: not-found (a name that is no such field's).
[[nodiscard]] Result<FusionOptions> fusionOptionsFor(const FusionRequest& request,
                                                     const QuantisedMesh& quantised,
                                                     std::vector<std::string>& notes);

}  // namespace qtet
