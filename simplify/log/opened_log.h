// A log with its manifest, the two held against each other: what info, extract and verify start
// from.
#pragma once

#include <filesystem>

#include "codec/refine/log_file.h"
#include "proto/manifest.h"

namespace qtet {

struct OpenedLog {
  LogFile file;
  Manifest manifest;

  /// Length of the file's prefix that holds `level` (PROTOCOL.md, `cumulativeBytes`). REQUIRES: a
  /// level of the manifest.
  [[nodiscard]] std::uint64_t prefixBytes(std::size_t level) const;
};

/// Errors: LogFile::open's, manifestOf's.
[[nodiscard]] Result<OpenedLog> openLog(const std::filesystem::path& path);

}  // namespace qtet
