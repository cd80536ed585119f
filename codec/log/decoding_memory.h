// Predicts from a log's front how much memory decoding takes. A program that decodes a stranger's
// log asks before the first block.
#pragma once

#include <cstdint>

namespace qtet {

struct LogIndex;

/// An upper bound of the bytes that a refiner and the block in hand hold while the whole log is
/// decoded, with every field. decodeVerified() and a viewer of the finest level need this beside
/// the log itself. Logs that qtet wrote take at least half of it (measured). A log forged to
/// scatter its stars may take up to three times as much. A log whose blocks bring more than its
/// table says ends in an error, and not in more memory.
[[nodiscard]] std::uint64_t decodingBytes(const LogIndex& index);

}  // namespace qtet
