// Options that name fields, for one mesh: which field counts how much, and which one is regions.
#pragma once

#include <string>
#include <vector>

#include "simplify/cost/mesh_figures.h"
#include "simplify/pipeline/pipeline.h"

namespace qtet {

/// `options.fusion` with the fields of this mesh. A point field counts by its weight, 1 where none
/// is given; one of integers counts only where one is. Where none is given for any field, the
/// weights are balancedFieldWeights. Constant fields do not count; `notes` says which.
/// Errors: not-found (a name is no such field's), bad-input (a label that cannot be one);
/// those of `mesh`.
[[nodiscard]] Result<FusionOptions> fusionOptionsFor(const PipelineOptions& options,
                                                     const MeshFigures& mesh,
                                                     std::vector<std::string>& notes);

}  // namespace qtet
