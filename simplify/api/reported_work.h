// Work in a thread of its own, while the caller's thread reports how far it has come.
#pragma once

#include <functional>
#include <stop_token>

#include "simplify/pipeline/pipeline.h"

namespace qtet {

/// Whether to go on.
using Tell = std::function<bool(Stage stage, double fraction)>;

/// simplifyToLog in another thread; `tell` is called in this one, about ten times a second, until
/// it answers false, which ends the work. An exception of either goes on to the caller, after the
/// work has ended.
[[nodiscard]] Result<PipelineOutput> simplifyAndReport(TetMesh&& mesh, PipelineOptions options,
                                                       const Tell& tell);

}  // namespace qtet
