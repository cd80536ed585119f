// Figures of this process, under the names that Prometheus' own clients give.
#pragma once

#include <vector>

#include "server/wire/metrics.h"

namespace qtet {

/// Processor time, memory, open files and their bound, and when the process began. Figures that the
/// system does not report are left out.
[[nodiscard]] std::vector<Metrics::Figure> processFigures();

}  // namespace qtet
