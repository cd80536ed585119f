#include "codec/log/chunk_table.h"

#include <gtest/gtest.h>

#include <optional>

namespace qtet {
namespace {

/// The error of two later blocks of these sizes in a chunk whose row says `bytes`.
std::optional<ErrorCode> errorOfLater(std::uint32_t first, std::uint32_t second,
                                      std::uint64_t bytes) {
  ChunkEntry written, row;
  written.blocks = {{.size = first}, {.size = second}};
  ByteWriter table;
  writeLaterBlocks(table, 2, std::span(&written, 1));
  row.laterBytes = bytes;
  ByteReader r(table.bytes());
  readLaterBlocks(r, 2, std::span(&row, 1));
  return r.failed() ? std::optional(r.error().code) : std::nullopt;
}

TEST(ChunkTable, laterBlocksHaveAsManyBytesAsTheirRowSays) {
  EXPECT_EQ(errorOfLater(100, 199, 300), ErrorCode::kBadValue);
  EXPECT_EQ(errorOfLater(100, 200, 300), std::nullopt);
  EXPECT_EQ(errorOfLater(100, 201, 300), ErrorCode::kBadValue);
}

}  // namespace
}  // namespace qtet
