// Which blocks a client gets, and in which order: a pure function of the chunk table (PROTOCOL.md, "Binary frame").
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log_index.h"

namespace qtet {

/// What is to be sent. Fields are indices into the log's fields.
struct StreamRequest {
  std::vector<std::uint32_t> fields;      ///< wanted, ascending, each once
  std::uint32_t haveChunks = 0;           ///< leading chunks of the mesh that the client has
  std::vector<std::uint32_t> haveFields;  ///< the same for each entry of `fields`
};

/// Consecutive blocks of one chunk, one binary frame; or the head.
struct BlockRun {
  std::uint32_t chunk = 0;
  std::uint16_t firstPart = 0;  ///< FrameHeader::kHead: header, manifest and table
  std::uint16_t parts = 0;

  bool operator==(const BlockRun&) const = default;
};

/// The runs that a client lacks. A run takes neighbouring blocks until it would exceed `payloadBytes`, and one block at least.
/// REQUIRES: fields ascending, distinct and below the log's fields; haveFields of the same size, none above haveChunks;
/// haveChunks at most the log's chunks.
[[nodiscard]] std::vector<BlockRun> planStream(const LogIndex& index, const StreamRequest& request, std::uint32_t payloadBytes);

/// Where a run lies in the file: one contiguous piece.
struct FileSlice {
  std::uint64_t offset = 0;
  std::uint32_t size = 0;
};
[[nodiscard]] FileSlice sliceOf(const LogIndex& index, const BlockRun& run);

}  // namespace qtet
