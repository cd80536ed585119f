// The rows of the chunk table, both ways (FORMAT.md, "Chunk table"): varints and checksums; what
// follows from the rows before is not stored.
#pragma once

#include "codec/log/log_index.h"

namespace qtet {

/// Least bytes of a row with `parts` blocks: before anything is allocated, a table is held against
/// it.
[[nodiscard]] constexpr std::uint64_t minRowBytes(std::uint32_t parts) {
  return 7 + std::uint64_t{parts} * 5;
}

/// The same of a closing block's row.
inline constexpr std::uint64_t kMinClosingRowBytes = 7;

/// Reads `chunks` rows into index.chunks; the first block lies at `offset`.
/// REQUIRES: index.fields, and that chunks * minRowBytes fits what remains in `r`. Errors stay
/// in `r`: truncated, bad-value, bad-codec, limit-exceeded (levels).
void readChunkRows(ByteReader& r, LogIndex& index, std::uint32_t chunks, std::uint64_t offset);

void writeChunkRows(ByteWriter& w, const LogIndex& index);

/// The rows of `count` closing blocks, which stand behind those of the chunks as their blocks do.
/// REQUIRES: the chunks' rows in `index`, and that count * kMinClosingRowBytes fits what remained
/// before them.
void readClosingRows(ByteReader& r, LogIndex& index, std::uint32_t count);

void writeClosingRows(ByteWriter& w, const LogIndex& index);

}  // namespace qtet
