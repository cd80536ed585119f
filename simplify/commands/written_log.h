// Writes a log that comes in pieces, and says what was written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "proto/byte_sink.h"

namespace qtet {

struct WrittenLog {
  std::string digest;  ///< SHA-256, lower-case hexadecimal
  std::uint64_t bytes = 0;
};

/// Errors: writeFileAtomically's, the log's.
[[nodiscard]] Result<WrittenLog> writeLog(const std::filesystem::path& path, const ByteSource& log);

}  // namespace qtet
