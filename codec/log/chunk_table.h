// The rows of the chunk table, both ways (FORMAT.md, "Chunk table"): varints and checksums; what
// follows from the rows before is not stored.
#pragma once

#include <span>
#include <vector>

#include "codec/log/chunk_entry.h"
#include "codec/log/closing_block.h"
#include "proto/bytes.h"

namespace qtet {

/// The blocks of which a row tells.
struct RowParts {
  std::uint32_t count = kFirstFieldPart;
  bool endsWithLater = false;  ///< the bytes of all blocks of later fields follow
};

/// Least bytes of a row: before anything is allocated, a table is held against it.
[[nodiscard]] constexpr std::uint64_t minRowBytes(RowParts parts) {
  return 7 + std::uint64_t{parts.count} * 5 + (parts.endsWithLater ? 2 : 0);
}

/// The same of a closing block's row.
inline constexpr std::uint64_t kMinClosingRowBytes = 7;

/// `chunks` rows; the first block lies at `offset`. REQUIRES: that chunks * minRowBytes fits what
/// remains in `r`. Errors stay in `r`: truncated, bad-value, bad-codec, limit-exceeded (levels).
[[nodiscard]] std::vector<ChunkEntry> readChunkRows(ByteReader& r, std::uint32_t chunks,
                                                    RowParts parts, std::uint64_t offset);

void writeChunkRows(ByteWriter& w, std::span<const ChunkEntry> chunks, RowParts parts);

/// Sizes and checksums of `count` blocks of later fields in each chunk, behind those that are
/// known. Errors stay in `r`: truncated, bad-value (other bytes than the chunk's row says).
/// REQUIRES: that 5 * count * chunks bytes remain in `r`.
void readLaterBlocks(ByteReader& r, std::uint32_t count, std::span<ChunkEntry> chunks);

/// The inverse, of the chunks' last `count` blocks.
void writeLaterBlocks(ByteWriter& w, std::uint32_t count, std::span<const ChunkEntry> chunks);

/// The rows of `count` closing blocks, which stand behind those of the chunks as their blocks do;
/// the first block lies at `offset`. REQUIRES: that count * kMinClosingRowBytes fitted what
/// remained before the chunks' rows.
[[nodiscard]] std::vector<ClosingBlock> readClosingRows(ByteReader& r, std::uint32_t count,
                                                        std::uint64_t offset);

void writeClosingRows(ByteWriter& w, std::span<const ClosingBlock> blocks);

}  // namespace qtet
