// Plans which blocks a client gets, and in which order (STREAM.md, "Binary frame", "Order"). The
// plan is a pure function of the log's index, the client's blocks and its target.
#pragma once

#include <cstdint>
#include <vector>

namespace qtet {

class ClientBlocks;
struct LogIndex;

/// Consecutive blocks of one chunk, one binary frame; or the head.
struct BlockRun {
  std::uint32_t chunk = 0;
  std::uint16_t firstPart = 0;  ///< FrameHeader::kHead: header, manifest and table
  std::uint16_t parts = 0;

  bool operator==(const BlockRun&) const = default;
};

/// The runs that a client lacks up to chunk `lastChunk`, the head left out. In each turn
/// (field_turns.h) chunks come in the file's order: whatever has arrived is a mesh with its fields.
/// A run takes neighbouring blocks until it would exceed `payloadBytes`, and one block at least.
[[nodiscard]] std::vector<BlockRun> planStream(const LogIndex& index, const ClientBlocks& blocks,
                                               std::uint32_t lastChunk, std::uint32_t payloadBytes);

/// Where a run lies in the file: one contiguous piece.
struct FileSlice {
  std::uint64_t offset = 0;
  std::uint32_t size = 0;
};
[[nodiscard]] FileSlice sliceOf(const LogIndex& index, const BlockRun& run);

}  // namespace qtet
