// The versions of the log format that this codec reads, as text (FORMAT.md, "Versions").
#pragma once

#include <string>

#include "codec/log/log_index.h"

namespace qtet {

/// The version that it writes. Newer minor versions are read as well.
[[nodiscard]] inline std::string newestLogVersion() {
  return std::to_string(LogIndex::kVersionMajor) + "." + std::to_string(LogIndex::kVersionMinor);
}
[[nodiscard]] inline std::string oldestLogVersion() {
  return std::to_string(LogIndex::kVersionMajor) + ".0";
}

}  // namespace qtet
