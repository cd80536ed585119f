// Writes a log that comes in pieces, and says what was written.
#pragma once

#include <cstdint>
#include <string>

#include "proto/byte_sink.h"
#include "simplify/words/output.h"

namespace qtet {

struct WrittenLog {
  std::string digest;  ///< SHA-256, lower-case hexadecimal
  std::uint64_t bytes = 0;
};

/// Errors: writeOutput's.
[[nodiscard]] Result<WrittenLog> writeLog(const Output& output, const ByteSource& log);

}  // namespace qtet
