// Predicts from a log's front how much memory decoding takes. A program that decodes a stranger's
// log asks before the first block.
#pragma once

#include <cstdint>
#include <span>

namespace qtet {

struct LogIndex;

/// An upper bound of the bytes that a refiner and the block in hand hold while the whole log is
/// decoded, with every field. decodeVerified() and a viewer of the finest level need this beside
/// the log itself. Logs that qtet wrote take at least half of it (measured). A log forged to
/// scatter its stars may take up to three times as much. A log whose blocks bring more than its
/// table says ends in an error, and not in more memory.
[[nodiscard]] std::uint64_t decodingBytes(const LogIndex& index);

/// Which of the decoded fields are in memory at the same time.
enum class FieldsHeld : std::uint8_t {
  kAll,
  kOneByOne,  ///< one, and those that later ones are predicted from (LevelFields)
};

/// The same while the log is decoded up to a level, with some fields, ascending, and their parents.
/// REQUIRES: such a level, such fields.
[[nodiscard]] std::uint64_t decodingBytes(const LogIndex& index, std::uint32_t level,
                                          std::span<const std::uint32_t> fields, FieldsHeld held);

}  // namespace qtet
