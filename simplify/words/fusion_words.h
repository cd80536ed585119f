// The words of `qtet simplify` about what counts when fusing: weights, the envelope's tolerance,
// regions.
#pragma once

#include "simplify/pipeline/pipeline.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

void addFusionOptions(po::options_description& options);
/// Sets `fusion`, `fieldWeights`, `labelWeights` and `regions`. Throws UsageError.
void takeFusionOptions(const ParsedWords& parsed, PipelineOptions& out);

}  // namespace qtet
