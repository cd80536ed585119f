// `qtet info LOG.qtet`: what a log holds.
#pragma once

#include <cstddef>
#include <string>

#include "simplify/words/several_logs.h"

namespace qtet {

inline constexpr std::size_t kShownLevels = 20;  ///< without --all

/// The report of `qtet info` on a log. `all`: every level and field. Errors: openLog's.
[[nodiscard]] Result<LogReport> logReport(const std::string& path, bool all, bool colours);

}  // namespace qtet
