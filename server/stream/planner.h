// Plans which blocks a client gets, and in which order (STREAM.md, "Binary frame", "Order"). The
// plan is a pure function of the log's front, the client's blocks and its requests.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/target_choice.h"
#include "proto/stream_request.h"
#include "server/stream/log_front.h"

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

/// The runs that a client lacks, the head left out. A run takes neighbouring blocks until it would
/// exceed `payloadBytes`, and one block at least.
[[nodiscard]] std::vector<BlockRun> planStream(const LogFront& log, const ClientBlocks& blocks,
                                               const View& view, const StopAt& stop,
                                               std::uint32_t payloadBytes);

/// Where a run lies in the file: one contiguous piece.
struct FileSlice {
  std::uint64_t offset = 0;
  std::uint32_t size = 0;
};
[[nodiscard]] FileSlice sliceOf(const LogIndex& index, const BlockRun& run);

}  // namespace qtet
