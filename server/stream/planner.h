// Plans which blocks a client gets, and in which order (STREAM.md, "Binary frame", "Order"). The
// plan is a pure function of the log's index, the client's blocks and its target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
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
/// All runs of a request may be ten million. So they are found one by one, and none is kept.
class StreamPlan {
 public:
  /// Nothing may be asked of it.
  StreamPlan() = default;
  /// REQUIRES: the log has this chunk. `index` outlives the object.
  StreamPlan(const LogIndex& index, std::uint32_t lastChunk, std::uint32_t payloadBytes);

  /// nullopt: there is no other. REQUIRES: the same blocks each time, but for those of runs that it
  /// gave, which may have been added.
  [[nodiscard]] std::optional<BlockRun> next(const ClientBlocks& blocks);

  /// Memory that it takes beside its own size, in bytes.
  [[nodiscard]] std::size_t bytes() const { return columns_.capacity() * sizeof(columns_[0]); }

 private:
  /// Goes to the next block that is lacking, if it does not stand at one. False: there is none.
  bool seek(const ClientBlocks& blocks);

  const LogIndex* index_ = nullptr;
  std::uint32_t lastChunk_ = 0, payloadBytes_ = 0;
  // where it stands: the turn, the chunk, and the place among the turn's columns
  std::size_t turn_ = 0;
  std::uint32_t chunk_ = 0;
  std::size_t column_ = 0;
  std::vector<std::size_t> columns_;  // empty: not known yet
};

/// Bytes of the blocks of all these runs. REQUIRES: the log has this chunk.
[[nodiscard]] std::uint64_t lackingBytes(const LogIndex& index, const ClientBlocks& blocks,
                                         std::uint32_t lastChunk);

/// Where a run lies in the file: one contiguous piece.
struct FileSlice {
  std::uint64_t offset = 0;
  std::uint32_t size = 0;
};
[[nodiscard]] FileSlice sliceOf(const LogIndex& index, const BlockRun& run);

}  // namespace qtet
